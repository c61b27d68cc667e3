# The Python module is built by default where its tools are: pybind11, and a Python with its headers and numpy. Who asks for it
# gets an error where they are not.
if(NOT DEFINED Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  # Another python3 on the PATH need not have numpy.
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Interpreter that the Python module is built for")
endif()
find_path(CERTA_PYBIND11_HEADERS pybind11/pybind11.h)
mark_as_advanced(CERTA_PYBIND11_HEADERS)
set(CERTA_BUILD_PYTHON_DEFAULT OFF)
if(PROJECT_IS_TOP_LEVEL AND CERTA_PYBIND11_HEADERS AND NOT CERTA_SANITIZE)
  find_package(Python 3.8 QUIET COMPONENTS Interpreter Development.Module NumPy)
  set(CERTA_BUILD_PYTHON_DEFAULT ${Python_FOUND})
endif()
option(CERTA_BUILD_PYTHON "Build the Python module" ${CERTA_BUILD_PYTHON_DEFAULT})
