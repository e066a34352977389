# Installation, for find_package(boxtree CONFIG) and for pkg-config, in components of install rules:
# boxtree_runtime (the shared library of the C interface), boxtree_cpp_runtime (that of the C++ interface, if
# there is one), boxtree_development (headers, archives and what finds them) and boxtree_program (the command
# line, its man pages and completions).
# boxtreeConfig.cmake.in lists the components of find_package.
include(CMakePackageConfigHelpers)

set(BOXTREE_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/boxtree)
set(targets ${BOXTREE_LIBRARIES})
if(BUILD_SHARED_LIBS)
  list(REMOVE_ITEM targets runtime) # which the shared library is known as
  list(TRANSFORM targets PREPEND boxtree_shared_)
  list(APPEND targets boxtree_shared)
else()
  list(REMOVE_ITEM targets blob)
  list(TRANSFORM targets PREPEND boxtree_)
  # In a file of its own, because its targets want liblzma and zstd to be found.
  if(BOXTREE_BLOB)
    install(TARGETS boxtree_blob EXPORT boxtreeBlobTargets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT boxtree_development)
    install(EXPORT boxtreeBlobTargets NAMESPACE boxtree:: DESTINATION ${BOXTREE_CONFIG_DIR}
            COMPONENT boxtree_development)
  endif()
endif()
install(TARGETS ${targets} EXPORT boxtreeTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT boxtree_development
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT boxtree_cpp_runtime
                                                    NAMELINK_COMPONENT boxtree_development)
# In a file of its own, which needs nothing else to be found.
set(BOXTREE_HAS_C OFF)
if(TARGET boxtree_c)
  set(BOXTREE_HAS_C ON)
  install(TARGETS boxtree_c boxtree_c_static EXPORT boxtreeCTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT boxtree_development
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT boxtree_runtime
                                                      NAMELINK_COMPONENT boxtree_development)
  install(EXPORT boxtreeCTargets NAMESPACE boxtree:: DESTINATION ${BOXTREE_CONFIG_DIR}
          COMPONENT boxtree_development)
  install(FILES ${PROJECT_SOURCE_DIR}/runtime/include/boxtree_c.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
          COMPONENT boxtree_development)
endif()
install(EXPORT boxtreeTargets NAMESPACE boxtree:: DESTINATION ${BOXTREE_CONFIG_DIR}
        COMPONENT boxtree_development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/format/include/boxtree/ ${PROJECT_SOURCE_DIR}/runtime/include/boxtree/
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/boxtree COMPONENT boxtree_development)
install(FILES ${BOXTREE_INCLUDE_DIR}/boxtree/configuration.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/boxtree COMPONENT boxtree_development)
# Of an installation as a whole; packages have copies of their own (BoxtreePackages.cmake).
set(BOXTREE_DOC_DIR ${CMAKE_INSTALL_DATAROOTDIR}/doc/boxtree)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${BOXTREE_DOC_DIR} RENAME copyright
        COMPONENT boxtree_licence)
# The pages and the samples that they speak of, in the folders in which they are here, so that links hold.
file(GLOB pages ${PROJECT_SOURCE_DIR}/*.md)
install(FILES ${pages} ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${BOXTREE_DOC_DIR} COMPONENT boxtree_development)
foreach(folder docs samples)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${BOXTREE_DOC_DIR} COMPONENT boxtree_development)
endforeach()
# With the program, so that boxtree::cli is there exactly where the program is.
if(BOXTREE_BUILD_COOKER)
  install(TARGETS boxtree_cli EXPORT boxtreeCliTargets
          RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT boxtree_program)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/bazel DESTINATION ${CMAKE_INSTALL_DATADIR}/boxtree COMPONENT boxtree_program)
  install(EXPORT boxtreeCliTargets NAMESPACE boxtree:: DESTINATION ${BOXTREE_CONFIG_DIR}
          COMPONENT boxtree_program)
  get_target_property(manual boxtree_cli BOXTREE_MANUAL_DIR)
  if(manual)
    install(DIRECTORY ${manual}/man1/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT boxtree_program)
    install(FILES ${manual}/bash/boxtree COMPONENT boxtree_program
            DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions)
    # Below /usr, Debian's zsh reads the second one alone.
    foreach(folder site-functions vendor-completions)
      install(FILES ${manual}/zsh/_boxtree COMPONENT boxtree_program
              DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/zsh/${folder})
    endforeach()
    install(FILES ${manual}/fish/boxtree.fish COMPONENT boxtree_program
            DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/fish/vendor_completions.d)
  endif()
endif()

set(BOXTREE_NEEDS_HIGHWAY OFF)
if(BOXTREE_HIGHWAY AND NOT BUILD_SHARED_LIBS)
  set(BOXTREE_NEEDS_HIGHWAY ON)
endif()
# With a build folder on the PATH, find_package looks into it and its cmake/ before /usr/local. What lies
# there is of use only where it is installed, so it is in another folder; earlier versions left it in the way.
set(BOXTREE_GENERATED_CONFIG_DIR ${PROJECT_BINARY_DIR}/for_install)
file(REMOVE ${PROJECT_BINARY_DIR}/boxtreeConfig.cmake ${PROJECT_BINARY_DIR}/boxtreeConfigVersion.cmake)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/boxtreeConfig.cmake.in
                              ${BOXTREE_GENERATED_CONFIG_DIR}/boxtreeConfig.cmake
                              INSTALL_DESTINATION ${BOXTREE_CONFIG_DIR})
write_basic_package_version_file(${BOXTREE_GENERATED_CONFIG_DIR}/boxtreeConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${BOXTREE_GENERATED_CONFIG_DIR}/boxtreeConfig.cmake
              ${BOXTREE_GENERATED_CONFIG_DIR}/boxtreeConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/BoxtreeCookedAssets.cmake
        DESTINATION ${BOXTREE_CONFIG_DIR} COMPONENT boxtree_development)

# boxtree_install_pkg_config(NAME DESCRIPTION REQUIRES LIBS [LIBS_PRIVATE]): NAME.pc, which finds all from where
# it lies. LIBS_PRIVATE is what `pkg-config --static` adds.
function(boxtree_install_pkg_config name description requires libs)
  set(PC_PREFIX ${CMAKE_INSTALL_PREFIX})
  if(NOT IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
    file(RELATIVE_PATH PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
    string(REGEX REPLACE "/$" "" PC_PREFIX "\${pcfiledir}/${PC_PREFIX}")
  endif()
  set(PC_LIBDIR "\${prefix}")
  cmake_path(APPEND PC_LIBDIR ${CMAKE_INSTALL_LIBDIR})
  set(PC_INCLUDEDIR "\${prefix}")
  cmake_path(APPEND PC_INCLUDEDIR ${CMAKE_INSTALL_INCLUDEDIR})
  set(PC_NAME ${name})
  set(PC_DESCRIPTION ${description})
  set(PC_REQUIRES ${requires})
  set(PC_LIBS ${libs})
  set(PC_LIBS_PRIVATE "${ARGN}")
  set(PC_CFLAGS " -ffp-contract=off")
  if(name STREQUAL boxtree_c) # nothing of it is compiled with the program
    set(PC_CFLAGS "")
  endif()
  configure_file(${PROJECT_SOURCE_DIR}/cmake/boxtree.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
          COMPONENT boxtree_development)
endfunction()

# Archives are linked with all that they need, so nothing of it is "private". The shared library brings
# along what it needs.
set(runtime_requires "eigen3 >= 3.4")
set(runtime_libs "-lboxtree_cpp")
set(paper_libs "")
set(blob_requires "boxtree = ${PROJECT_VERSION}")
set(blob_libs "")
if(NOT BUILD_SHARED_LIBS)
  set(runtime_libs "-lboxtree_runtime -lboxtree_format")
  if(BOXTREE_HIGHWAY)
    string(APPEND runtime_requires ", libhwy >= 1.0")
  endif()
  set(paper_libs "-lboxtree_paper")
  set(blob_libs "-lboxtree_blob")
  string(APPEND blob_requires ", libzstd >= 1.5, liblzma >= 5.4")
endif()
boxtree_install_pkg_config(boxtree "Queries on collision trees in mapped files" "${runtime_requires}"
                           "${runtime_libs}")
if(BOXTREE_PAPER_CODECS)
  boxtree_install_pkg_config(boxtree-paper "The codecs of the BoxTree paper" "boxtree = ${PROJECT_VERSION}"
                             "${paper_libs}")
endif()
if(BOXTREE_BLOB)
  boxtree_install_pkg_config(boxtree-blob "Collision trees in files that are compressed whole"
                             "${blob_requires}" "${blob_libs}")
endif()

if(BOXTREE_HAS_C)
  list(TRANSFORM BOXTREE_C_STATIC_LIBRARIES PREPEND "-l" OUTPUT_VARIABLE private_libs)
  list(JOIN private_libs " " private_libs)
  boxtree_install_pkg_config(boxtree_c "Queries on collision trees in mapped files, in C" "" "-lboxtree"
                             "${private_libs}")
endif()

if(PROJECT_IS_TOP_LEVEL)
  include(${CMAKE_CURRENT_LIST_DIR}/BoxtreePackages.cmake)
endif()
