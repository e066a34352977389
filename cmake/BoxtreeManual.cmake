# Man pages and completions, in the folder BOXTREE_MANUAL_DIR of the target boxtree_cli: the program prints
# them, of what its commands declare, whenever it is linked. When cross compiling, BOXTREE_TOOL prints them,
# a `boxtree` of the machine that builds and of the same version, or an emulator runs the program; without
# either there are none. Pages are compressed as Debian wants them, where gzip is; man reads both.
set(boxtree_manual_tool $<TARGET_FILE:boxtree_cli>)
if(CMAKE_CROSSCOMPILING)
  set(boxtree_manual_tool ${BOXTREE_TOOL})
  if(NOT BOXTREE_TOOL AND CMAKE_CROSSCOMPILING_EMULATOR)
    set(boxtree_manual_tool ${CMAKE_CROSSCOMPILING_EMULATOR} $<TARGET_FILE:boxtree_cli>)
  endif()
endif()
if(NOT boxtree_manual_tool)
  message(STATUS "boxtree: no man pages and completions without BOXTREE_TOOL, a boxtree of this machine")
  return()
endif()

find_program(BOXTREE_GZIP gzip)
set(boxtree_compress_pages)
if(BOXTREE_GZIP)
  set(boxtree_compress_pages COMMAND ${BOXTREE_GZIP} -9nr ${PROJECT_BINARY_DIR}/manual/man1)
endif()

set(boxtree_manual_dir ${PROJECT_BINARY_DIR}/manual)
file(MAKE_DIRECTORY ${boxtree_manual_dir}/man1 ${boxtree_manual_dir}/bash ${boxtree_manual_dir}/zsh
                    ${boxtree_manual_dir}/fish)
add_custom_command(TARGET boxtree_cli POST_BUILD
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${boxtree_manual_dir}/man1
  COMMAND ${CMAKE_COMMAND} -E make_directory ${boxtree_manual_dir}/man1
  COMMAND ${boxtree_manual_tool} help --man-pages ${boxtree_manual_dir}/man1
  ${boxtree_compress_pages}
  COMMAND ${boxtree_manual_tool} completion bash > ${boxtree_manual_dir}/bash/boxtree
  COMMAND ${boxtree_manual_tool} completion zsh > ${boxtree_manual_dir}/zsh/_boxtree
  COMMAND ${boxtree_manual_tool} completion fish > ${boxtree_manual_dir}/fish/boxtree.fish
  VERBATIM)
set_target_properties(boxtree_cli PROPERTIES BOXTREE_MANUAL_DIR ${boxtree_manual_dir})
