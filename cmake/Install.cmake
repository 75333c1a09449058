# SPDX-License-Identifier: BSD-3-Clause
# cmake --install build/release --prefix P: the programs, what plugins and clients are built against, worlds and vehicles.
include(CMakePackageConfigHelpers)
set(package_dir lib/cmake/Shoal)
set(types_dir ${PROJECT_SOURCE_DIR}/messages)

install(TARGETS shoal RUNTIME DESTINATION bin)  # the others: shoal_describe_program()
install(TARGETS generate_type_tables RUNTIME DESTINATION lib/shoal)
install(TARGETS shoal_client ARCHIVE DESTINATION lib)
install(FILES bridges/client/shoal/client.hpp DESTINATION include/shoal/shoal)

install(DIRECTORY sim DESTINATION include/shoal FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY ${PROJECT_BINARY_DIR}/sim/generated/sim DESTINATION include/shoal)
install(DIRECTORY ${types_dir}/shoal ${PROJECT_BINARY_DIR}/messages/generated/shoal DESTINATION include/shoal
        FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY ${types_dir}/reporter DESTINATION include/shoal/messages FILES_MATCHING PATTERN "*.hpp")
file(GLOB lcm_files CONFIGURE_DEPENDS ${types_dir}/*/*.lcm)
install(FILES ${lcm_files} DESTINATION share/shoal/types)

# The first lines of worlds and vehicles name ../docs/reference/schema.
install(DIRECTORY worlds vehicles DESTINATION share/shoal)
install(DIRECTORY docs/reference/schema DESTINATION share/shoal/docs/reference)
install(FILES LICENSE DESTINATION share/doc/shoal)

configure_package_config_file(cmake/ShoalConfig.cmake.in ${PROJECT_BINARY_DIR}/ShoalConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ShoalConfigVersion.cmake COMPATIBILITY ExactVersion)
install(FILES ${PROJECT_BINARY_DIR}/ShoalConfig.cmake ${PROJECT_BINARY_DIR}/ShoalConfigVersion.cmake
              cmake/LcmGenerate.cmake cmake/DescribeProgram.cmake DESTINATION ${package_dir})
