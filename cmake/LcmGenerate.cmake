# SPDX-License-Identifier: BSD-3-Clause
# Debian's LCM 1.3.1 has no CMake package, so lcm-gen is called here.  Also works with 1.5.
find_program(LCM_GEN lcm-gen REQUIRED)

# lcm_generate(<headers> FILES <lcm file>... CPP_DIR <dir>)
# Adds rules that generate one C++ header per type, <dir>/<package>/<type>.hpp; returns their list in <headers>.
function(lcm_generate headers)
  cmake_parse_arguments(ARG "" "CPP_DIR" "FILES" ${ARGN})
  set(all_outputs)
  foreach(lcm_file IN LISTS ARG_FILES)
    # The names of the outputs depend on the text, so a changed text requires another configuration.
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${lcm_file})
    file(STRINGS ${lcm_file} package REGEX "^[ \t]*package[ \t]")
    string(REGEX REPLACE "^[ \t]*package[ \t]+([A-Za-z0-9_.]+).*" "\\1" package "${package}")
    string(REPLACE "." "/" package_dir "${package}")
    file(STRINGS ${lcm_file} declarations REGEX "^[ \t]*(struct|enum)[ \t]+[A-Za-z0-9_]+")
    set(outputs)
    foreach(declaration IN LISTS declarations)
      string(REGEX REPLACE "^[ \t]*(struct|enum)[ \t]+([A-Za-z0-9_]+).*" "\\2" type "${declaration}")
      list(APPEND outputs ${ARG_CPP_DIR}/${package_dir}/${type}.hpp)
    endforeach()
    # c++11: the default c++98 output does not compile when a type has a floating-point constant.
    add_custom_command(OUTPUT ${outputs}
      COMMAND ${LCM_GEN} --cpp --cpp-std=c++11 --cpp-hpath ${ARG_CPP_DIR} ${lcm_file}
      DEPENDS ${lcm_file} COMMENT "lcm-gen ${package_dir}: C++" VERBATIM)
    list(APPEND all_outputs ${outputs})
  endforeach()
  set(${headers} ${all_outputs} PARENT_SCOPE)
endfunction()

# lcm_generate_plugin_tables(<sources> FILES <lcm file>... CPP_DIR <dir>)
# For the types of a plugin: a source that registers them with the program, and <dir>/<package>/array_lengths.hpp, which
# encode_into() of shoal/message_codec.hpp needs.  Shoal_TYPE_TABLES and Shoal_LCM_FILES: from ShoalConfig.cmake.
function(lcm_generate_plugin_tables sources)
  cmake_parse_arguments(ARG "" "CPP_DIR" "FILES" ${ARGN})
  list(GET ARG_FILES 0 first)
  file(STRINGS ${first} package REGEX "^[ \t]*package[ \t]")
  string(REGEX REPLACE "^[ \t]*package[ \t]+([A-Za-z0-9_.]+).*" "\\1" package "${package}")
  if(package STREQUAL shoal)
    message(FATAL_ERROR "${first}: the package shoal is Shoal's own; the types of a plugin need another one")
  endif()
  string(REPLACE "." "/" package_dir "${package}")
  file(MAKE_DIRECTORY ${ARG_CPP_DIR}/${package_dir})
  set(texts ${ARG_CPP_DIR}/${package_dir}_texts.cpp)
  set(lengths ${ARG_CPP_DIR}/${package_dir}/array_lengths.hpp)
  add_custom_command(OUTPUT ${texts} ${lengths}
    COMMAND ${Shoal_TYPE_TABLES} ${texts} ${lengths} ${ARG_FILES} --known ${Shoal_LCM_FILES}
    DEPENDS ${ARG_FILES} COMMENT "Tables of the types of ${package}" VERBATIM)
  set(${sources} ${texts} ${lengths} PARENT_SCOPE)
endfunction()

# lcm_generate_python(<target> FILES <lcm file>... DIR <dir>)
# Adds a target that writes the Python packages into <dir>.
function(lcm_generate_python target)
  cmake_parse_arguments(ARG "" "DIR" "FILES" ${ARGN})
  # lcm-gen appends to __init__.py, so the folder is emptied first.
  set(done ${CMAKE_CURRENT_BINARY_DIR}/${target}.done)
  add_custom_command(OUTPUT ${done}
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${ARG_DIR}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${ARG_DIR}
    COMMAND ${LCM_GEN} --python --ppath ${ARG_DIR} ${ARG_FILES}
    COMMAND ${CMAKE_COMMAND} -E touch ${done}
    DEPENDS ${ARG_FILES} COMMENT "lcm-gen: Python into ${ARG_DIR}" VERBATIM)
  add_custom_target(${target} ALL DEPENDS ${done})
endfunction()
