# SPDX-License-Identifier: BSD-3-Clause
# For Python wheels of packages that build on prf_core (scikit-build-core, no catkin): finds Python,
# pybind11 and Eigen, and builds prf_core into the package. Headers that the system lacks come from
# PyPI; pyproject.toml of the package names them.
if(SKBUILD_STATE STREQUAL "sdist")
  set(carried ${CMAKE_CURRENT_SOURCE_DIR}/.prf_core)
  if(NOT CMAKE_CURRENT_LIST_DIR STREQUAL carried)
    file(REMOVE_RECURSE ${carried})
    file(COPY ${CMAKE_CURRENT_LIST_DIR}/CMakeLists.txt ${CMAKE_CURRENT_LIST_DIR}/wheel.cmake
      ${CMAKE_CURRENT_LIST_DIR}/include ${CMAKE_CURRENT_LIST_DIR}/src DESTINATION ${carried})
  endif()
  return()
endif()
find_package(Python REQUIRED COMPONENTS Interpreter Development.Module)
find_package(pybind11 CONFIG REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE HINTS ${Python_SITELIB}/cmeel.prefix)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
add_subdirectory(${CMAKE_CURRENT_LIST_DIR} prf_core EXCLUDE_FROM_ALL)
set(prf_core_LIBRARIES prf_core)
