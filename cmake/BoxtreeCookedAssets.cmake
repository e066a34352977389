# boxtree_add_cooked_assets(TARGET target MESHES mesh... [OPTIONS option...] [OUTPUT_DIR dir])
#
# Cooks each mesh into OUTPUT_DIR/NAME.bxt [default: the current binary directory] before `target` is
# built. A depfile lists every file that a mesh refers to: touching one recooks just the meshes that
# read it. OPTIONS are passed to `boxtree cook`. The target learns the directory as the compile
# definition BOXTREE_ASSET_DIR.
function(boxtree_add_cooked_assets)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "" "TARGET;OUTPUT_DIR" "MESHES;OPTIONS")
  if(NOT ARG_TARGET OR NOT ARG_MESHES OR ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "boxtree_add_cooked_assets(TARGET target MESHES mesh... [OPTIONS option...] "
                        "[OUTPUT_DIR dir]): unexpected '${ARG_UNPARSED_ARGUMENTS}' or a part is missing")
  endif()
  if(NOT ARG_OUTPUT_DIR)
    set(ARG_OUTPUT_DIR ${CMAKE_CURRENT_BINARY_DIR})
  endif()
  file(MAKE_DIRECTORY ${ARG_OUTPUT_DIR})
  set(outputs)
  foreach(mesh IN LISTS ARG_MESHES)
    get_filename_component(mesh ${mesh} ABSOLUTE)
    get_filename_component(name ${mesh} NAME_WLE)
    set(output ${ARG_OUTPUT_DIR}/${name}.bxt)
    if(output IN_LIST outputs)
      message(FATAL_ERROR "boxtree_add_cooked_assets: two meshes would be cooked into ${output}")
    endif()
    add_custom_command(
      OUTPUT ${output}
      COMMAND boxtree::cli cook ${mesh} -o ${output} --depfile ${output}.d --quiet ${ARG_OPTIONS}
      MAIN_DEPENDENCY ${mesh}
      DEPENDS boxtree::cli
      DEPFILE ${output}.d
      COMMENT "Cooking ${name}.bxt"
      VERBATIM)
    list(APPEND outputs ${output})
  endforeach()
  add_custom_target(${ARG_TARGET}_assets DEPENDS ${outputs})
  add_dependencies(${ARG_TARGET} ${ARG_TARGET}_assets)
  target_compile_definitions(${ARG_TARGET} PRIVATE BOXTREE_ASSET_DIR="${ARG_OUTPUT_DIR}")
endfunction()
