# SPDX-License-Identifier: BSD-3-Clause
# Each public header compiles alone. What a source or test of its package includes first has been shown to; for
# every other header there is a source of a single #include, built with the tests, with the directories of the
# package's library and nothing else.
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(OpenCV REQUIRED COMPONENTS core)
file(GLOB packages RELATIVE ${CMAKE_SOURCE_DIR}/src CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/*/include)
foreach(include ${packages})
  get_filename_component(package ${include} DIRECTORY)
  file(GLOB_RECURSE headers RELATIVE ${CMAKE_SOURCE_DIR}/src/${include} CONFIGURE_DEPENDS
    ${CMAKE_SOURCE_DIR}/src/${include}/*.hpp)
  file(GLOB_RECURSE users CONFIGURE_DEPENDS
    ${CMAKE_SOURCE_DIR}/src/${package}/src/*.cpp ${CMAKE_SOURCE_DIR}/src/${package}/test/*.cpp)
  foreach(user ${users})
    file(STRINGS ${user} first REGEX "^#include" LIMIT_COUNT 1)
    if(first MATCHES "[<\"](.*)[>\"]")
      list(REMOVE_ITEM headers ${CMAKE_MATCH_1})
    endif()
  endforeach()
  if(NOT headers)
    continue()
  endif()
  set(sources "")
  foreach(header ${headers})
    set(source ${CMAKE_BINARY_DIR}/header_check/${header}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include \"@header@\"\n" @ONLY)
    list(APPEND sources ${source})
  endforeach()
  add_library(${package}_headers OBJECT EXCLUDE_FROM_ALL ${sources})
  target_compile_features(${package}_headers PRIVATE cxx_std_17)
  target_compile_options(${package}_headers PRIVATE -O0)
  target_include_directories(${package}_headers SYSTEM PRIVATE
    $<TARGET_PROPERTY:${package},INCLUDE_DIRECTORIES> ${OpenCV_INCLUDE_DIRS})
  target_link_libraries(${package}_headers PRIVATE Eigen3::Eigen)
  add_dependencies(${package}_headers ${package})  # generated messages come first
  add_dependencies(tests ${package}_headers)
endforeach()
