# SPDX-License-Identifier: BSD-3-Clause
# prf_add_python_tests(PATH [DEPENDENCIES TARGET...]): a test that runs pytest over a file, or over the test_*.py
# of a folder without those below it. Takes the place of catkin_add_nosetests, which skips everything where nose
# is gone (Debian 13).
function(prf_add_python_tests path)
  cmake_parse_arguments(arg "" "" "DEPENDENCIES" ${ARGN})
  if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/${path})
    file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${path}/test_*.py)
  else()
    set(files ${CMAKE_CURRENT_SOURCE_DIR}/${path})
  endif()
  if(NOT files)
    message(FATAL_ERROR "no Python tests at ${CMAKE_CURRENT_SOURCE_DIR}/${path}")
  endif()
  string(REPLACE "/" "." name ${path})
  set(results ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/pytest-${name}.xml)
  string(REPLACE ";" " " files "${files}")
  catkin_run_tests_target("pytest" ${name} "pytest-${name}.xml"
    COMMAND "${PYTHON_EXECUTABLE} -m pytest -q -p no:cacheprovider --junitxml=${results} ${files}"
    DEPENDENCIES ${arg_DEPENDENCIES} WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
endfunction()
