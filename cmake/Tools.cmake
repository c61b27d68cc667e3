# Targets that look at the code instead of building it: tidy, format.
find_program(CERTA_RUN_CLANG_TIDY NAMES run-clang-tidy-14 run-clang-tidy)
find_program(CERTA_CLANG_FORMAT NAMES clang-format-14)
if(PROJECT_IS_TOP_LEVEL AND CERTA_RUN_CLANG_TIDY)
  add_custom_target(tidy
    COMMAND ${CERTA_RUN_CLANG_TIDY} -quiet -p ${PROJECT_BINARY_DIR} "^${PROJECT_SOURCE_DIR}/(src|cli)/"
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} USES_TERMINAL VERBATIM)
endif()
if(PROJECT_IS_TOP_LEVEL AND CERTA_CLANG_FORMAT)
  file(GLOB_RECURSE certa_sources CONFIGURE_DEPENDS
    ${PROJECT_SOURCE_DIR}/include/*.h ${PROJECT_SOURCE_DIR}/src/*.h ${PROJECT_SOURCE_DIR}/src/*.cpp
    ${PROJECT_SOURCE_DIR}/cli/*.h ${PROJECT_SOURCE_DIR}/cli/*.cpp
    ${PROJECT_SOURCE_DIR}/python/*.h ${PROJECT_SOURCE_DIR}/python/*.cpp ${PROJECT_SOURCE_DIR}/tests/*.h
    ${PROJECT_SOURCE_DIR}/tests/*.cpp ${PROJECT_SOURCE_DIR}/bench/*.cpp ${PROJECT_SOURCE_DIR}/examples/*.cpp)
  add_custom_target(format COMMAND ${CERTA_CLANG_FORMAT} -i ${certa_sources} VERBATIM)
endif()
