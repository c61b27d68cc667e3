# certa_docs: the reference of the public headers, in HTML, by Doxygen. Never part of `all`; without Doxygen the target says so.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
find_program(CERTA_DOXYGEN doxygen)
find_program(CERTA_PYTHON_FOR_DOCS python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(CERTA_PYTHON_FOR_DOCS python3)
mark_as_advanced(CERTA_DOXYGEN CERTA_PYTHON_FOR_DOCS)
if(NOT CERTA_DOXYGEN OR NOT CERTA_PYTHON_FOR_DOCS)
  add_custom_target(certa_docs
    COMMAND ${CMAKE_COMMAND} -E echo "certa_docs: nothing is built, doxygen and python3 are not both here (Debian: apt-get install doxygen); then configure again"
    VERBATIM)
  return()
endif()
set(certa_docs ${PROJECT_BINARY_DIR}/reference)
file(GLOB certa_public_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/certa/*.h)
configure_file(${CMAKE_CURRENT_LIST_DIR}/Doxyfile.in ${certa_docs}/Doxyfile @ONLY)
add_custom_command(OUTPUT ${certa_docs}/checked
  COMMAND ${CERTA_DOXYGEN} ${certa_docs}/Doxyfile
  COMMAND ${CERTA_PYTHON_FOR_DOCS} ${PROJECT_SOURCE_DIR}/tools/check_reference.py ${certa_docs}
  COMMAND ${CMAKE_COMMAND} -E touch ${certa_docs}/checked
  DEPENDS ${certa_public_headers} ${CMAKE_CURRENT_LIST_DIR}/reference.md ${certa_docs}/Doxyfile
    ${PROJECT_SOURCE_DIR}/tools/label_headings.py ${PROJECT_SOURCE_DIR}/tools/check_reference.py
  VERBATIM)
add_custom_target(certa_docs DEPENDS ${certa_docs}/checked)
