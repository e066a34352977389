# boxtree_add_cooked_assets(TARGET target [MESHES mesh...] [PROFILES profile...] [OPTIONS option...]
#                           [OUTPUT_DIR dir] [DEFINITION name] [CACHE dir|url])
#
# Cooks each mesh, and each profile, into OUTPUT_DIR/NAME.bxt before `target`, or what links it, is built. A
# depfile lists every file that a mesh or a profile refers to: touching one recooks just what reads it.
#
#   PROFILES    those that say themselves what to cook, by `source` or [[instance]]
#   TARGET      any target; what links an INTERFACE library gets its definition and its order of building
#   OPTIONS     passed to `boxtree cook`, with --jobs 1 unless they have --jobs; generator expressions are evaluated
#   OUTPUT_DIR  [default: the current binary directory, which a relative one is below]
#   DEFINITION  compile definition by which sources know OUTPUT_DIR [default: BOXTREE_ASSET_DIR]; INTERFACE
#               of an INTERFACE library, otherwise PRIVATE
#   CACHE       folder or URL for `boxtree cook --cache`, OFF for none; a relative folder is below the current binary
#               directory [default: the variable BOXTREE_CACHE]
#
# May be called again for the same target. Targets that want the same mesh in the same OUTPUT_DIR with
# the same OPTIONS share the file.
#
# Runs BOXTREE_TOOL, a `boxtree` of the machine that builds, if that is set; otherwise boxtree::cli. When
# cross compiling, or if there is no boxtree::cli, a `boxtree` of the PATH.

# Projects that include this may require an older CMake.
cmake_policy(VERSION 3.20...3.25)

# Sets RESULT to the program that cooks: a target or a path.
function(boxtree_find_tool result)
  if(NOT BOXTREE_TOOL)
    if(TARGET boxtree::cli AND NOT CMAKE_CROSSCOMPILING)
      set(${result} boxtree::cli PARENT_SCOPE)
      return()
    endif()
    # CMAKE_PREFIX_PATH and the root of the target machine hold programs of the target machine.
    find_program(BOXTREE_TOOL boxtree NO_PACKAGE_ROOT_PATH NO_CMAKE_PATH NO_CMAKE_ENVIRONMENT_PATH
                 NO_CMAKE_INSTALL_PREFIX NO_CMAKE_FIND_ROOT_PATH
                 DOC "The program boxtree, for the machine that builds")
  endif()
  if(NOT BOXTREE_TOOL)
    set(why "this boxtree was built without its command line")
    if(CMAKE_CROSSCOMPILING)
      set(why "programs of the target machine do not run on the machine that cross compiles")
    endif()
    message(FATAL_ERROR "boxtree_add_cooked_assets: no program to cook with: ${why}. Install boxtree on the "
                        "machine that builds, or set BOXTREE_TOOL to the path of the program boxtree there")
  endif()
  set(fault "")
  if(NOT IS_ABSOLUTE "${BOXTREE_TOOL}")
    set(fault "which is no absolute path")
  elseif(IS_DIRECTORY "${BOXTREE_TOOL}")
    set(fault "which is a folder")
  elseif(NOT EXISTS "${BOXTREE_TOOL}")
    set(fault "and no file is there")
  endif()
  if(fault)
    message(FATAL_ERROR "boxtree_add_cooked_assets: BOXTREE_TOOL is '${BOXTREE_TOOL}', ${fault}; expected the "
                        "absolute path of the program boxtree")
  endif()
  set(${result} ${BOXTREE_TOOL} PARENT_SCOPE)
endfunction()

# Tells TARGET the folder by the compile definition NAME.
function(boxtree_define_asset_dir target name dir)
  get_target_property(known ${target} BOXTREE_DEFINED_${name})
  if(known STREQUAL dir)
    return()
  elseif(known)
    message(FATAL_ERROR "boxtree_add_cooked_assets: ${name} of target ${target} is ${known} already and cannot "
                        "be ${dir}, too: add DEFINITION and another name for it, or use one OUTPUT_DIR")
  endif()
  get_target_property(type ${target} TYPE)
  set(scope PRIVATE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    set(scope INTERFACE)
  elseif(type STREQUAL "UTILITY")
    return() # compiles nothing
  endif()
  target_compile_definitions(${target} ${scope} "${name}=\"${dir}\"")
  set_target_properties(${target} PROPERTIES BOXTREE_DEFINED_${name} ${dir})
endfunction()

# Called when the current folder has been read, since a later command may make the file. A warning, since one of
# another folder may, too.
function(boxtree_expect_input input what)
  get_source_file_property(is_generated "${input}" GENERATED)
  if(NOT is_generated AND NOT EXISTS "${input}")
    message(WARNING "boxtree_add_cooked_assets: ${input} is not there, and no command of this folder makes it; "
                    "expected a ${what} file. Relative names are below ${CMAKE_CURRENT_SOURCE_DIR}")
  endif()
endfunction()

# Ends with WHY, a sentence, and how to call the function.
function(boxtree_refuse_call why)
  message(FATAL_ERROR "boxtree_add_cooked_assets: ${why} Expected boxtree_add_cooked_assets(TARGET target [MESHES mesh...] "
                      "[PROFILES profile...] [OPTIONS option...] [OUTPUT_DIR dir] [DEFINITION name] [CACHE dir|url])")
endfunction()

# Sets RESULT to the keyword that begins as WORD does, by three letters or more, or to nothing.
function(boxtree_nearest_keyword result word)
  set(nearest)
  set(most 2)
  foreach(keyword TARGET MESHES PROFILES OPTIONS OUTPUT_DIR DEFINITION CACHE)
    string(LENGTH ${keyword} length)
    while(length GREATER most)
      string(SUBSTRING ${keyword} 0 ${length} start)
      if(word MATCHES "^${start}")
        set(nearest ${keyword})
        set(most ${length})
      endif()
      math(EXPR length "${length} - 1")
    endwhile()
  endforeach()
  set(${result} ${nearest} PARENT_SCOPE)
endfunction()

# A keyword that the function does not know is a value of the list before it. An input has an ending, so a name in
# capitals is none; as the value of an option it may be meant, unless it begins as a keyword does. Nor is a keyword in
# small letters.
function(boxtree_refuse_unknown_keywords list values)
  foreach(value IN LISTS values)
    string(TOUPPER "${value}" upper)
    if(NOT value STREQUAL upper AND upper MATCHES "^(TARGET|MESHES|PROFILES|OPTIONS|OUTPUT_DIR|DEFINITION|CACHE)$")
      boxtree_refuse_call("'${value}' in ${list} is no keyword; did you mean ${upper}?")
    endif()
    if(NOT value MATCHES "^[A-Z][A-Z_]+$")
      continue()
    endif()
    boxtree_nearest_keyword(nearest ${value})
    if(nearest)
      boxtree_refuse_call("'${value}' in ${list} is no keyword; did you mean ${nearest}?")
    elseif(NOT list STREQUAL "OPTIONS")
      boxtree_refuse_call("'${value}' in ${list} is neither a keyword nor the name of a file.")
    endif()
  endforeach()
endfunction()

function(boxtree_add_cooked_assets)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "" "TARGET;OUTPUT_DIR;DEFINITION;CACHE" "MESHES;PROFILES;OPTIONS")
  foreach(list MESHES PROFILES)
    foreach(input IN LISTS ARG_${list})
      if(input MATCHES ";")
        boxtree_refuse_call("${list} has '${input}' in one piece; a list stands there without quotes.")
      endif()
    endforeach()
    boxtree_refuse_unknown_keywords(${list} "${ARG_${list}}")
  endforeach()
  foreach(keyword OUTPUT_DIR DEFINITION CACHE)
    if(keyword IN_LIST ARG_KEYWORDS_MISSING_VALUES)
      boxtree_refuse_call("${keyword} of target ${ARG_TARGET} has no value.")
    endif()
  endforeach()
  if(ARG_DEFINITION AND NOT ARG_DEFINITION MATCHES "^[A-Za-z_][A-Za-z0-9_]*$")
    boxtree_refuse_call("DEFINITION is '${ARG_DEFINITION}', which is no name of a macro.")
  endif()
  boxtree_refuse_unknown_keywords(OPTIONS "${ARG_OPTIONS}")
  if(ARG_UNPARSED_ARGUMENTS)
    list(GET ARG_UNPARSED_ARGUMENTS 0 word)
    boxtree_nearest_keyword(nearest "${word}")
    if(nearest)
      boxtree_refuse_call("'${word}' is no keyword; did you mean ${nearest}?")
    endif()
    boxtree_refuse_call("'${word}' is no keyword and stands behind none that takes it.")
  endif()
  if(NOT ARG_TARGET)
    boxtree_refuse_call("TARGET is missing.")
  endif()
  if(NOT ARG_MESHES AND NOT ARG_PROFILES)
    boxtree_refuse_call("MESHES or PROFILES of target ${ARG_TARGET} is missing or an empty list.")
  endif()
  if(NOT TARGET ${ARG_TARGET})
    message(FATAL_ERROR "boxtree_add_cooked_assets: there is no target ${ARG_TARGET}; call add_executable or add_library "
                        "for it before")
  endif()
  get_target_property(aliased ${ARG_TARGET} ALIASED_TARGET)
  if(aliased)
    set(ARG_TARGET ${aliased})
  endif()
  get_target_property(is_imported ${ARG_TARGET} IMPORTED)
  if(is_imported)
    boxtree_refuse_call("target ${ARG_TARGET} is imported, and this build makes nothing for it; name one of the project.")
  endif()
  if(NOT ARG_DEFINITION)
    set(ARG_DEFINITION BOXTREE_ASSET_DIR)
  endif()
  if(ARG_OUTPUT_DIR MATCHES "\\$<")
    message(FATAL_ERROR "boxtree_add_cooked_assets: OUTPUT_DIR is ${ARG_OUTPUT_DIR}; only OPTIONS may hold "
                        "generator expressions")
  endif()
  foreach(option IN LISTS ARG_OPTIONS)
    if(option MATCHES "^--?[a-z0-9-]+[ \t]")
      message(FATAL_ERROR "boxtree_add_cooked_assets: OPTIONS has '${option}' in one piece; expected options and "
                          "their values in pieces: without quotes, or with ; between them")
    endif()
    if(option MATCHES "^(-o|--output(=|$)|--depfile(=|$)|--write-reordered(=|$))")
      message(FATAL_ERROR "boxtree_add_cooked_assets: OPTIONS has '${option}', but the function names what it writes: "
                          "NAME.bxt and NAME.bxt.d in OUTPUT_DIR; call add_custom_command for anything else")
    endif()
    if(option MATCHES "^--cache(=|$)")
      boxtree_refuse_call("OPTIONS has '${option}'; did you mean CACHE?")
    endif()
  endforeach()
  # Builds run several cooks at once, each of which would take all processors.
  set(jobs --jobs 1)
  if(ARG_OPTIONS MATCHES "(^|;)(-j|--jobs)")
    set(jobs)
  endif()
  # Bytes do not depend on it, so that targets with and without share files.
  if(NOT DEFINED ARG_CACHE)
    set(ARG_CACHE ${BOXTREE_CACHE})
  endif()
  set(cache)
  if(ARG_CACHE MATCHES "^[A-Za-z]+://")
    set(cache --cache ${ARG_CACHE})
  elseif(ARG_CACHE)
    get_filename_component(cache "${ARG_CACHE}" ABSOLUTE BASE_DIR ${CMAKE_CURRENT_BINARY_DIR})
    set(cache --cache ${cache})
  endif()
  get_filename_component(dir "${ARG_OUTPUT_DIR}" ABSOLUTE BASE_DIR ${CMAKE_CURRENT_BINARY_DIR})
  boxtree_find_tool(tool)
  file(MAKE_DIRECTORY ${dir})

  set(outputs)
  set(shared_targets)
  get_property(call_count TARGET ${ARG_TARGET} PROPERTY BOXTREE_ASSET_CALLS)
  set(assets_target ${ARG_TARGET}_assets)
  if(call_count)
    math(EXPR call_count "${call_count} + 1")
    string(APPEND assets_target _${call_count})
  else()
    set(call_count 1)
  endif()
  foreach(input IN LISTS ARG_MESHES ARG_PROFILES)
    set(what mesh)
    set(option)
    if(input IN_LIST ARG_PROFILES)
      set(what profile)
      set(option --profile)
    endif()
    get_filename_component(input ${input} ABSOLUTE)
    get_filename_component(name ${input} NAME_WLE)
    set(output ${dir}/${name}.bxt)
    # What is cooked into it, by which options and target, all over the project.
    get_property(known_input GLOBAL PROPERTY "BOXTREE_INPUT_OF_${output}")
    get_property(known_options GLOBAL PROPERTY "BOXTREE_OPTIONS_OF_${output}")
    get_property(known_target GLOBAL PROPERTY "BOXTREE_TARGET_OF_${output}")
    if(known_input AND NOT known_input STREQUAL input)
      message(FATAL_ERROR "boxtree_add_cooked_assets: ${known_input} and ${input} would both be cooked into "
                          "${output}: give one of them another OUTPUT_DIR")
    elseif(known_input AND NOT "${known_options}" STREQUAL "${ARG_OPTIONS}")
      message(FATAL_ERROR "boxtree_add_cooked_assets: ${input} is cooked into ${output} with the options "
                          "'${known_options}' already; to cook it with '${ARG_OPTIONS}', too, give one of them "
                          "another OUTPUT_DIR")
    elseif(known_input)
      if(NOT known_target STREQUAL assets_target)
        list(APPEND shared_targets ${known_target})
      endif()
      continue()
    endif()
    set_property(GLOBAL PROPERTY "BOXTREE_INPUT_OF_${output}" "${input}")
    set_property(GLOBAL PROPERTY "BOXTREE_OPTIONS_OF_${output}" "${ARG_OPTIONS}")
    set_property(GLOBAL PROPERTY "BOXTREE_TARGET_OF_${output}" "${assets_target}")
    if(CMAKE_GENERATOR MATCHES "Ninja" AND "${input}${output}" MATCHES "[&'\"$^`*?<>|]")
      message(WARNING "boxtree_add_cooked_assets: ninja stops reading a depfile at the '${CMAKE_MATCH_0}' of\n  ${input}\nand so "
                      "cooks it again at each build; name it, or the folder, without, or use another generator")
    endif()
    # As CMake names what it builds: below the folder of the build, wherever that is.
    cmake_path(RELATIVE_PATH output BASE_DIRECTORY ${CMAKE_BINARY_DIR} OUTPUT_VARIABLE title)
    if(title MATCHES "^\\.\\.(/|$)")
      set(title ${output})
    endif()
    cmake_language(EVAL CODE "cmake_language(DEFER CALL boxtree_expect_input [[${input}]] ${what})")
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${tool} cook ${option} ${input} -o ${output} --depfile ${output}.d --quiet ${jobs} ${cache} ${ARG_OPTIONS}
      DEPENDS ${input} ${tool}
      DEPFILE ${output}.d
      COMMENT "Cooking ${title}"
      COMMAND_EXPAND_LISTS # an option that a generator expression leaves empty is none
      VERBATIM)
    list(APPEND outputs ${output})
  endforeach()
  if(outputs)
    set_target_properties(${ARG_TARGET} PROPERTIES BOXTREE_ASSET_CALLS ${call_count})
    add_custom_target(${assets_target} DEPENDS ${outputs})
    list(APPEND shared_targets ${assets_target})
  endif()
  if(shared_targets)
    list(REMOVE_DUPLICATES shared_targets)
    add_dependencies(${ARG_TARGET} ${shared_targets})
  endif()
  boxtree_define_asset_dir(${ARG_TARGET} ${ARG_DEFINITION} ${dir})
endfunction()
