# SPDX-License-Identifier: BSD-3-Clause
# Writes a header with all types of messages: SHOAL_ALL_MESSAGE_TYPES(X) expands to X(type) for each,
# SHOAL_MESSAGE_TYPE_LIST is a list of types.
include_guard(GLOBAL)
file(GLOB lcm_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/messages/*/*.lcm)
set(type_includes "")
set(type_calls "")
set(type_list "")
foreach(lcm_file IN LISTS lcm_files)
  file(STRINGS ${lcm_file} declarations REGEX "^[ \t]*struct[ \t]+[A-Za-z0-9_]+")
  foreach(declaration IN LISTS declarations)
    string(REGEX REPLACE "^[ \t]*struct[ \t]+([A-Za-z0-9_]+).*" "\\1" type "${declaration}")
    string(APPEND type_includes "#include \"shoal/${type}.hpp\"\n")
    string(APPEND type_calls " \\\n  X(${type})")
    list(APPEND type_list "shoal::${type}")
  endforeach()
endforeach()
list(JOIN type_list ", \\\n  " type_list)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/tests/generated/all_message_types.hpp CONTENT
     "#pragma once\n\n${type_includes}\n#define SHOAL_ALL_MESSAGE_TYPES(X)${type_calls}\n\n#define SHOAL_MESSAGE_TYPE_LIST \\\n  ${type_list}\n")
add_library(all_message_types INTERFACE)
target_include_directories(all_message_types INTERFACE ${PROJECT_BINARY_DIR}/tests/generated)
