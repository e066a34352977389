# What the cooker, the command line and their tests use of other projects. A build for another system has none of
# their libraries: it takes those that are headers alone from this machine, without the headers beside them, and
# does without assimp, oneTBB and libcurl.
option(BOXTREE_ASSIMP "Read meshes by assimp, too; else OBJ, OFF, PLY and STL alone" ${native})
option(BOXTREE_HTTP "Caches on servers (cook --cache http://...), with headers of libcurl" ${native})
# ThreadSanitizer does not see how an oneTBB built without it orders tasks, and calls every pair of tasks a race.
set(boxtree_has_tbb ${native})
if(BOXTREE_SANITIZE MATCHES thread)
  set(boxtree_has_tbb OFF)
endif()
option(BOXTREE_TBB "Share work among threads by oneTBB; else by threads of the C++ library" ${boxtree_has_tbb})

# boxtree_provide(PACKAGE TARGET FOLDER): what find_package(PACKAGE) finds is TARGET, the headers in FOLDER.
function(boxtree_provide package target folder)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${folder})
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${package}Config.cmake "")
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${package}ConfigVersion.cmake
       "set(PACKAGE_VERSION_COMPATIBLE TRUE)\n")
endfunction()

# boxtree_link_headers(RESULT HEADER): a folder with nothing but a link to the folder of HEADER, "fmt/format.h".
function(boxtree_link_headers result header)
  cmake_path(GET header PARENT_PATH name)
  find_path(boxtree_parent_of_${name} ${header} REQUIRED)
  set(links ${PROJECT_BINARY_DIR}/headers/${name})
  file(MAKE_DIRECTORY ${links})
  file(CREATE_LINK ${boxtree_parent_of_${name}}/${name} ${links}/${name} SYMBOLIC)
  set(${result} ${links} PARENT_SCOPE)
endfunction()

if(CMAKE_CROSSCOMPILING)
  boxtree_link_headers(boxtree_folder CLI/CLI.hpp)
  boxtree_provide(CLI11 CLI11::CLI11 ${boxtree_folder})
  boxtree_link_headers(boxtree_folder nlohmann/json.hpp)
  boxtree_provide(nlohmann_json nlohmann_json::nlohmann_json ${boxtree_folder})
  boxtree_link_headers(boxtree_folder fmt/format.h)
  boxtree_provide(fmt fmt::fmt ${boxtree_folder})
  target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
  boxtree_link_headers(BOXTREE_TOMLPLUSPLUS_INCLUDE_DIR toml++/toml.h)
endif()
if(NOT BOXTREE_TBB)
  find_package(Threads REQUIRED)
  boxtree_provide(TBB TBB::tbb ${PROJECT_SOURCE_DIR}/cooker/threads)
  target_link_libraries(TBB::tbb INTERFACE Threads::Threads)
endif()
