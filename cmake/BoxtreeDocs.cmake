# The target `docs`: the API reference, build/docs/api/index.html.
find_program(BOXTREE_DOXYGEN doxygen)
set(BOXTREE_REFERENCE_DIR ${PROJECT_BINARY_DIR}/docs/api)
if(BOXTREE_DOXYGEN)
  add_custom_target(docs
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${BOXTREE_REFERENCE_DIR}
    COMMAND bash ${PROJECT_SOURCE_DIR}/docs/api/build.sh ${BOXTREE_REFERENCE_DIR} ${PROJECT_VERSION}
    COMMENT "Building ${BOXTREE_REFERENCE_DIR}/index.html"
    VERBATIM)
else()
  add_custom_target(docs
    COMMAND ${CMAKE_COMMAND} -E echo "The API reference needs Doxygen (apt-get install doxygen); configure again after that"
    COMMAND ${CMAKE_COMMAND} -E false
    VERBATIM)
endif()
