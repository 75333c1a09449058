# SPDX-License-Identifier: BSD-3-Clause
# cmake --install build/release --prefix P: the programs, what plugins and clients are built against, worlds and vehicles.
# --component NAME installs a part of it:
#   programs  the programs, worlds, vehicles, schemas, examples and the Python modules; of the target programs
#   client    what a client in C++ is built against; of the target shoal_client
#   device    what a plugin is built against, besides `client`
#   python    the Python package, with SHOAL_PYTHON; see python/CMakeLists.txt
include(CMakePackageConfigHelpers)
set(package_dir lib/cmake/Shoal)
set(types_dir ${PROJECT_SOURCE_DIR}/messages)

install(TARGETS shoal RUNTIME DESTINATION bin COMPONENT programs)  # the others: shoal_describe_program()
install(TARGETS generate_type_tables RUNTIME DESTINATION lib/shoal COMPONENT device)
install(TARGETS shoal_client ARCHIVE DESTINATION lib COMPONENT client)
install(FILES bridges/client/shoal/client.hpp DESTINATION include/shoal/shoal COMPONENT client)

install(DIRECTORY sim DESTINATION include/shoal COMPONENT device FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY ${PROJECT_BINARY_DIR}/sim/generated/sim DESTINATION include/shoal COMPONENT device)
foreach(header IN LISTS SHOAL_PLUGIN_HEADERS)
  cmake_path(RELATIVE_PATH header BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION include/shoal/${folder} COMPONENT device)
endforeach()
install(DIRECTORY ${types_dir}/shoal ${PROJECT_BINARY_DIR}/messages/generated/shoal DESTINATION include/shoal
        COMPONENT client FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY ${types_dir}/reporter DESTINATION include/shoal/messages COMPONENT device
        FILES_MATCHING PATTERN "*.hpp")
file(GLOB lcm_files CONFIGURE_DEPENDS ${types_dir}/*/*.lcm)
install(FILES ${lcm_files} DESTINATION share/shoal/types COMPONENT client)

# The first lines of worlds and vehicles refer to ../docs/reference/schema.
install(DIRECTORY worlds vehicles DESTINATION share/shoal COMPONENT programs)
install(DIRECTORY docs/reference/schema DESTINATION share/shoal/docs/reference COMPONENT programs)
install(FILES LICENSE DESTINATION share/doc/shoal COMPONENT programs)

# Templates of `shoal new program`.
install(DIRECTORY examples/client DESTINATION share/shoal/examples COMPONENT programs
        FILES_MATCHING PATTERN "*.cpp" PATTERN CMakeLists.txt PATTERN build EXCLUDE)
# Those for the Python package are apart: the folder of the others has another package of its name, made by lcm-gen.
set(package_examples allan_deviation dead_reckoning first_run own_client pilot random_policy range_only_filter read_record)
list(TRANSFORM package_examples PREPEND examples/python/)
list(TRANSFORM package_examples APPEND .py)
install(FILES ${package_examples} DESTINATION share/shoal/examples/python COMPONENT programs)
list(JOIN package_examples "|" package_examples)
install(DIRECTORY examples/python/ ${PROJECT_BINARY_DIR}/python/ DESTINATION share/shoal/python COMPONENT programs
        FILES_MATCHING PATTERN "*.py" PATTERN __pycache__ EXCLUDE PATTERN CMakeFiles EXCLUDE
        REGEX "/(${package_examples})$" EXCLUDE)

# Two packages: the one that is installed, and one of the build folder, which CMake finds when its bin is in PATH.
set(shoal_include_dirs "\${PACKAGE_PREFIX_DIR}/include/shoal")
set(shoal_type_tables "\${PACKAGE_PREFIX_DIR}/lib/shoal/generate_type_tables")
set(shoal_lcm_files "\${PACKAGE_PREFIX_DIR}/share/shoal/types/*.lcm")
set(shoal_client_library "\${PACKAGE_PREFIX_DIR}/lib/libshoal_client.a")
configure_package_config_file(cmake/ShoalConfig.cmake.in ${PROJECT_BINARY_DIR}/package/ShoalConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
set(shoal_include_dirs ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/sim/generated ${types_dir}
                       ${PROJECT_BINARY_DIR}/messages/generated ${PROJECT_SOURCE_DIR}/bridges/client)
set(shoal_type_tables ${PROJECT_BINARY_DIR}/messages/generate_type_tables)
set(shoal_lcm_files ${types_dir}/*/*.lcm)
set(shoal_client_library ${PROJECT_BINARY_DIR}/bridges/libshoal_client.a)
configure_package_config_file(cmake/ShoalConfig.cmake.in ${PROJECT_BINARY_DIR}/ShoalConfig.cmake
                              INSTALL_DESTINATION . INSTALL_PREFIX ${PROJECT_BINARY_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ShoalConfigVersion.cmake COMPATIBILITY ExactVersion)
foreach(module IN ITEMS LcmGenerate DescribeProgram)
  configure_file(cmake/${module}.cmake ${PROJECT_BINARY_DIR}/${module}.cmake COPYONLY)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/package/ShoalConfig.cmake ${PROJECT_BINARY_DIR}/ShoalConfigVersion.cmake
              cmake/LcmGenerate.cmake cmake/DescribeProgram.cmake DESTINATION ${package_dir} COMPONENT client)
