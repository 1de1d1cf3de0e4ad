# SPDX-License-Identifier: BSD-3-Clause
# Writes packaged_profiles.cpp into the build folder of whoever includes this: the profiles of the
# platform's motion are built in, so that a core that knows no ROS finds them.
file(GLOB profiles CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/../config/profiles/*.yaml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${profiles})
set(PACKAGED_PROFILES "")
foreach(profile ${profiles})
  get_filename_component(name ${profile} NAME_WE)
  file(READ ${profile} text)
  string(APPEND PACKAGED_PROFILES "      {\"${name}\", R\"yaml(${text})yaml\"},\n")
endforeach()
configure_file(${CMAKE_CURRENT_LIST_DIR}/../src/motion/packaged_profiles.cpp.in packaged_profiles.cpp @ONLY)
