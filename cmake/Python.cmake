# SPDX-License-Identifier: Apache-2.0

# The Python that the package is built for. By default the system's rather than the first one on
# PATH: that is where Debian's numpy is. Another: -DPython3_EXECUTABLE=...
if(NOT DEFINED Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The Python that kelpie is built for")
endif()
find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter Development.Module)
find_package(pybind11 2.10 REQUIRED CONFIG)

# The package is put together here, ready to be imported with this folder on PYTHONPATH.
set(KELPIE_PYTHON_DIR "${PROJECT_BINARY_DIR}/python")
