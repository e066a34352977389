# Debian packages: `cpack` in the build directory makes libboxtree1 (the C interface), libboxtree-cpp0.1 (of a
# build with BUILD_SHARED_LIBS alone), libboxtree-dev and, with the cooker, boxtree. To have libraries where
# Debian has them, configure with CMAKE_INSTALL_PREFIX=/usr.
set(soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(version_of_build "(= ${PROJECT_VERSION})")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME boxtree)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "boxtree developers <boxtree@example.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Folders of packages are the same whatever the umask of who makes them.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

file(REAL_PATH ${PROJECT_SOURCE_DIR}/CHANGELOG.md changelog) # sources may be links
find_program(BOXTREE_GZIP gzip)
if(BOXTREE_GZIP) # else no dpkg either
  execute_process(COMMAND ${BOXTREE_GZIP} -9nc ${changelog} OUTPUT_FILE ${PROJECT_BINARY_DIR}/changelog.gz)
endif()

# boxtree_add_package(COMPONENT NAME SECTION DEPENDS DESCRIPTION): a package of one component of install
# rules. Debian wants licence and changes in each.
macro(boxtree_add_package component name section depends description)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}")
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${description}")
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${name}
          RENAME copyright COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${name}
          COMPONENT ${component} EXCLUDE_FROM_ALL)
endmacro()

set(CPACK_COMPONENTS_ALL)
set(needed "libeigen3-dev (>= 3.4)")
file(WRITE ${PROJECT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
if(BOXTREE_HAS_C)
  get_target_property(c_soversion boxtree_c SOVERSION)
  boxtree_add_package(boxtree_runtime libboxtree${c_soversion} libs ""
"queries on collision trees in mapped files (shared library for C)
Maps .bxt files, which boxtree cooks from meshes, and answers ray, box, sphere,
closest-point, contact and distance queries straight from their bytes.")
  set(CPACK_DEBIAN_BOXTREE_RUNTIME_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
  string(PREPEND needed "libboxtree${c_soversion} ${version_of_build}, ")
endif()
if(BUILD_SHARED_LIBS)
  boxtree_add_package(boxtree_cpp_runtime libboxtree-cpp${soversion} libs ""
"queries on collision trees in mapped files (shared library for C++)
Maps .bxt files, which boxtree cooks from meshes, and answers ray, box, sphere,
closest-point, contact and distance queries straight from their bytes.")
  set(CPACK_DEBIAN_BOXTREE_CPP_RUNTIME_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
  string(PREPEND needed "libboxtree-cpp${soversion} ${version_of_build}, ")
else()
  if(BOXTREE_HIGHWAY)
    string(APPEND needed ", pkg-config, libhwy-dev")
  endif()
  if(BOXTREE_BLOB)
    string(APPEND needed ", liblzma-dev, libzstd-dev")
  endif()
endif()
if(BOXTREE_BUILD_COOKER)
  boxtree_add_package(boxtree_program boxtree graphics ""
"cooks meshes into collision trees and queries them (command line)
Turns meshes of any format that assimp reads into .bxt files: small, versioned,
checked, and queried without loading. Also verifies, exports and measures them.")
  if(BOXTREE_HTTP) # loaded for caches on servers alone; newer releases call it by the second name
    set(CPACK_DEBIAN_BOXTREE_PROGRAM_PACKAGE_RECOMMENDS "libcurl4 | libcurl4t64")
  endif()
  string(PREPEND needed "boxtree ${version_of_build}, ")
endif()
boxtree_add_package(boxtree_development libboxtree-dev libdevel "${needed}"
"queries on collision trees in mapped files (development files)
Headers, library, and the files by which CMake and pkg-config find them. In
CMake, boxtree_add_cooked_assets() cooks the meshes of a target as it is built.")
include(CPack)
