# Installation: find_package(boxtree CONFIG) gives boxtree::format, boxtree::runtime and boxtree::paper,
# the program boxtree::cli, and boxtree_add_cooked_assets(); find_package(boxtree CONFIG COMPONENTS
# blob) adds boxtree::blob, which alone needs liblzma and zstd. Codecs and queries are components, too:
# one that was left out is not found.
include(CMakePackageConfigHelpers)

set(BOXTREE_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/boxtree)
install(TARGETS boxtree_format boxtree_runtime EXPORT boxtreeTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TARGET boxtree_paper)
  install(TARGETS boxtree_paper EXPORT boxtreeTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
if(BOXTREE_BLOB)
  install(TARGETS boxtree_blob EXPORT boxtreeBlobTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT boxtreeBlobTargets NAMESPACE boxtree:: DESTINATION ${BOXTREE_CONFIG_DIR})
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/format/include/boxtree/ ${PROJECT_SOURCE_DIR}/runtime/include/boxtree/
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/boxtree)
install(FILES ${BOXTREE_INCLUDE_DIR}/boxtree/configuration.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/boxtree)
if(BOXTREE_BUILD_COOKER)
  install(TARGETS boxtree_cli EXPORT boxtreeTargets RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(EXPORT boxtreeTargets NAMESPACE boxtree:: DESTINATION ${BOXTREE_CONFIG_DIR})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/boxtreeConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/boxtreeConfig.cmake
                              INSTALL_DESTINATION ${BOXTREE_CONFIG_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/boxtreeConfigVersion.cmake
                                 COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/boxtreeConfig.cmake
              ${PROJECT_BINARY_DIR}/boxtreeConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/BoxtreeCookedAssets.cmake
        DESTINATION ${BOXTREE_CONFIG_DIR})
