# boxtree_add_library(NAME SOURCES...) and boxtree_set_target(NAME): the settings every target of
# this project shares, in one place, so that no target can miss the ones that the bytes depend on.

# Public headers are included as <boxtree/NAME.h>, from runtime/include and, what format shares with
# applications, format/include; all others by their path in the tree, as "FOLDER/NAME.h".
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH BOXTREE_SOURCE_DIR)
set(BOXTREE_INCLUDE_DIR ${CMAKE_CURRENT_BINARY_DIR}/include)  # of the one header that is generated
include(${CMAKE_CURRENT_LIST_DIR}/BoxtreeParts.cmake)

function(boxtree_set_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # Same bytes and same answers everywhere: no fused multiply-add that the source does not need.
  # Programs that use the library compile its inline functions, too.
  target_compile_options(${target} PUBLIC
    $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang,AppleClang>:-ffp-contract=off>)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                                           -Wsign-conversion -Wno-missing-field-initializers
                                           # Programs linked with --gc-sections keep what they call.
                                           -ffunction-sections -fdata-sections)
  # g++ looks for garbage when it holds 512 MB, not 128: a tenth less time, a quarter more memory.
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=524288>)
  # Doubles are computed as doubles, not in the x87's 80 bits.
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(i.86|x86)$")
    target_compile_options(${target} PUBLIC
      $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>:-msse2> $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>:-mfpmath=sse>)
  endif()
  # g++ for Windows (12.2) takes inline functions for what its own copy of them is, so that callers keep
  # values in registers which the copy that the linker chose changes. And the square root of its C library is
  # rounded twice: without errno it is the processor's.
  if(MINGW AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE -fno-ipa-ra -fno-math-errno)
  endif()
  if(BOXTREE_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(NOT BOXTREE_SIMD)
    target_compile_options(${target} PRIVATE -fno-tree-vectorize -fno-tree-slp-vectorize)
    target_compile_definitions(${target} PRIVATE EIGEN_DONT_VECTORIZE)
  endif()
  if(BOXTREE_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${BOXTREE_SANITIZE}
                                             -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${BOXTREE_SANITIZE})
  endif()
endfunction()

# Where users of a target find the public headers.
function(boxtree_offer_headers target)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${BOXTREE_SOURCE_DIR}/format/include>
    $<BUILD_INTERFACE:${BOXTREE_SOURCE_DIR}/runtime/include>
    $<BUILD_INTERFACE:${BOXTREE_INCLUDE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endfunction()

# An archive `boxtree_NAME`. The project's own targets link these; applications link boxtree::NAME, which
# runtime/CMakeLists.txt makes of them. In a release build,
#   SMALL    what is not on the way of a query is compiled for size, and
#   COMPACT  what takes little of its time without the copies of code that -O3 makes, and so is
#   LAST     what shares templates with what decides that time, which has to be compiled for it.
# Sources that these name and the library does not have are left out. LINK says what the sources need of others,
# as target_link_libraries does, and PRECOMPILE which headers are parsed once for all of them, where CMAKE_UNITY_BUILD
# does not make them few. The target property BOXTREE_PARTS lists the targets that compile them, one for each way: g++
# compiles sources with the optimisations of the headers that are precompiled for them. Of a template that several
# sources instantiate a program has the copy of the first object in the archive, so these come in the order SMALL,
# COMPACT, others, LAST: were the others sources of the archive itself, they would be first by make.
function(boxtree_add_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SMALL;COMPACT;LAST;LINK;PRECOMPILE")
  set(arg_FAST ${arg_UNPARSED_ARGUMENTS})
  foreach(way IN ITEMS SMALL COMPACT LAST)
    set(of_way)
    foreach(source IN LISTS arg_${way})
      if(source IN_LIST arg_FAST)
        list(APPEND of_way ${source})
      endif()
    endforeach()
    set(arg_${way} ${of_way})
    list(REMOVE_ITEM arg_FAST ${of_way})
  endforeach()
  if(arg_SMALL OR arg_COMPACT OR arg_LAST)
    set(optimisation_SMALL -Os)
    set(optimisation_COMPACT -O2)
    set(optimisation_FAST)
    set(optimisation_LAST -O2)
    set(parts)
    add_library(boxtree_${name} STATIC)
    foreach(way IN ITEMS SMALL COMPACT FAST LAST)
      if(arg_${way})
        string(TOLOWER boxtree_${name}_${way} part)
        add_library(${part} OBJECT ${arg_${way}})
        target_compile_options(${part} PRIVATE $<$<CONFIG:Release>:${optimisation_${way}}>)
        target_sources(boxtree_${name} PRIVATE $<TARGET_OBJECTS:${part}>)
        list(APPEND parts ${part})
      endif()
    endforeach()
    set_target_properties(boxtree_${name} PROPERTIES LINKER_LANGUAGE CXX)
  else()
    add_library(boxtree_${name} STATIC ${arg_FAST})
    set(parts boxtree_${name})
  endif()
  set(targets ${parts} boxtree_${name})
  list(REMOVE_DUPLICATES targets)
  foreach(target IN LISTS targets)
    boxtree_offer_headers(${target})
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${BOXTREE_SOURCE_DIR}>)
    boxtree_set_target(${target})
    target_link_libraries(${target} ${arg_LINK})
    # A shared library exports what BOXTREE_API marks alone, and one that links an archive nothing of it: two plugins
    # may have different versions.
    set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  endforeach()
  if(arg_PRECOMPILE AND BOXTREE_PRECOMPILE_HEADERS AND NOT CMAKE_UNITY_BUILD)
    foreach(part IN LISTS parts)
      target_precompile_headers(${part} PRIVATE ${arg_PRECOMPILE})
    endforeach()
  endif()
  set_target_properties(boxtree_${name} PROPERTIES EXPORT_NAME ${name} BOXTREE_PARTS "${parts}")
endfunction()

# boxtree_export_only(TARGET VERSION SYMBOLS): a shared library exports SYMBOLS, as its version VERSION, and no
# others: templates of the standard library are visible whatever the compiler is told, so the linker is told.
# On Windows it is what is marked that is exported.
function(boxtree_export_only target version symbols)
  if(WIN32)
    return()
  endif()
  set(map ${CMAKE_CURRENT_BINARY_DIR}/${target}.map)
  file(CONFIGURE OUTPUT ${map} CONTENT [[
@version@ {
  global: @symbols@
  local: *;
};
]] @ONLY)
  set_property(TARGET ${target} PROPERTY LINK_DEPENDS ${map})
  target_link_options(${target} PRIVATE -Wl,--version-script=${map})
  if(NOT BOXTREE_SANITIZE) # whose functions are in the program
    target_link_options(${target} PRIVATE -Wl,-z,defs)
  endif()
endfunction()

# boxtree_precompile(TARGET HEADERS...): parses the headers of other projects once for all sources of a target. A
# source must still include what it uses; builds without it (presets scalar and asan-ubsan) fail where one does
# not. Not for targets with sources that have optimisations of their own (the runtime grew from 450 to 494 KB). Where
# CMAKE_UNITY_BUILD is on, sources are so few that parsing takes less than writing what was parsed (8 s, by GCC 12).
function(boxtree_precompile target)
  if(BOXTREE_PRECOMPILE_HEADERS AND NOT CMAKE_UNITY_BUILD)
    target_precompile_headers(${target} PRIVATE
      <algorithm> <array> <cstdint> <filesystem> <functional> <map> <memory> <optional> <span> <string>
      <string_view> <unordered_map> <utility> <variant> <vector> <Eigen/Geometry> ${ARGN})
  endif()
endfunction()

# boxtree_precompile_as(TARGET OTHER): the headers that OTHER has precompiled, which has the same compile options.
function(boxtree_precompile_as target other)
  if(BOXTREE_PRECOMPILE_HEADERS AND NOT CMAKE_UNITY_BUILD)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()

# boxtree_compile_by_folder(TARGET [FOLDERS...]): the sources of each folder as one, where BOXTREE_UNITY_BUILD is on: the
# headers that they share take most of the time. Each FOLDERS is a list of folders that are one where CMAKE_UNITY_BUILD
# is on, too (a fifth of the processor time less, for what takes longest alone: half a minute). A name in a namespace
# without a name is then the only one of the folders. Sources beside the target's CMakeLists.txt are folder ".".
function(boxtree_compile_by_folder target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${BOXTREE_UNITY_BUILD} UNITY_BUILD_MODE GROUP)
  if(NOT BOXTREE_UNITY_BUILD)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    if(folder STREQUAL "" OR IS_ABSOLUTE "${folder}")
      set(folder ".")
    endif()
    set(group "${folder}")
    if(source MATCHES "^cli/command_") # which would be twice as long as any other
      string(APPEND group /command)
    endif()
    if(CMAKE_UNITY_BUILD)
      foreach(folders IN LISTS ARGN)
        string(REPLACE " " ";" folders "${folders}")
        if(folder IN_LIST folders)
          list(JOIN folders _ group)
        endif()
      endforeach()
    endif()
    string(MAKE_C_IDENTIFIER "in_${group}" group)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()
