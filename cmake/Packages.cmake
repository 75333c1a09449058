# SPDX-License-Identifier: BSD-3-Clause
# tools/package makes Debian packages of an installation: shoal, libshoal-dev, python3-shoal and shoal-doc.  Each is
# made of components of cmake/Install.cmake.
set(SHOAL_MAINTAINER "The Shoal authors <noreply@users.noreply.github.com>" CACHE STRING "Maintainer in the packages")

# What the target package_files makes is installed if it was made.
#   man/         a page for each program and command, by help2man
#   completion/  of bash and zsh
#   site/        the documentation, by tools/docs
set(package_files ${PROJECT_BINARY_DIR}/package_files)
add_custom_target(package_files
                  COMMAND ${PROJECT_SOURCE_DIR}/tools/package_files ${PROJECT_BINARY_DIR}/bin ${package_files}
                          ${SHOAL_MAINTAINER}
                  DEPENDS programs COMMENT "Man pages, completions, copyright and changelogs" VERBATIM)
install(DIRECTORY ${package_files}/man/ DESTINATION share/man/man1 COMPONENT programs OPTIONAL)
install(FILES ${package_files}/completion/shoal DESTINATION share/bash-completion/completions COMPONENT programs OPTIONAL)
install(FILES ${package_files}/completion/_shoal DESTINATION share/zsh/vendor-completions COMPONENT programs OPTIONAL)
install(DIRECTORY ${PROJECT_BINARY_DIR}/docs/site/ DESTINATION share/doc/shoal-doc/html COMPONENT doc OPTIONAL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME shoal)
set(CPACK_PACKAGE_CONTACT "${SHOAL_MAINTAINER}")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_RELEASE "")
include(CPackComponent)

# shoal_package(<name> <group> SECTION <section> SUMMARY <text> TEXT <text> COMPONENTS <component>...
#               [DEPENDS <text>] [RECOMMENDS <text>] [ALL])
# ALL: for every architecture.
function(shoal_package name)
  cmake_parse_arguments(ARG "ALL" "SECTION;SUMMARY;TEXT;DEPENDS;RECOMMENDS" "COMPONENTS" ${ARGN})
  string(MAKE_C_IDENTIFIER ${name} group)
  string(TOUPPER ${group} upper)
  foreach(component IN LISTS ARG_COMPONENTS)
    string(TOUPPER ${component} upper_component)
    set(CPACK_COMPONENT_${upper_component}_GROUP ${group} PARENT_SCOPE)
    install(DIRECTORY ${package_files}/doc/${name} DESTINATION share/doc COMPONENT ${component} OPTIONAL)
  endforeach()
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${ARG_SECTION} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${ARG_SUMMARY}\n${ARG_TEXT}" PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${ARG_SUMMARY}\n${ARG_TEXT}" PARENT_SCOPE)
  set(CPACK_COMPONENT_GROUP_${upper}_DESCRIPTION "${ARG_SUMMARY}\n${ARG_TEXT}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${ARG_DEPENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_RECOMMENDS "${ARG_RECOMMENDS}" PARENT_SCOPE)
  if(ARG_ALL)
    set(CPACK_DEBIAN_${upper}_PACKAGE_ARCHITECTURE all PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS OFF PARENT_SCOPE)
  endif()
endfunction()

shoal_package(shoal SECTION science COMPONENTS programs
  SUMMARY "simulator of many vehicles on land, at the surface and under water"
  TEXT "Vehicles with their devices publish and subscribe on LCM channels, so that
the same autonomy programs, loggers and viewers work with the simulator and
with the vehicles. The same world, seed and programs give the same run, bit
for bit. This package has the programs, worlds and vehicles."
  RECOMMENDS "gnuplot-nox, iproute2, ffmpeg")
shoal_package(libshoal-dev SECTION libdevel COMPONENTS client device
  SUMMARY "client library and headers of the Shoal simulator"
  TEXT "A program in C++ becomes a client of the simulator with the library, which
runs in lockstep with it; the headers are for plugins with own devices."
  DEPENDS "shoal (= ${PROJECT_VERSION}), liblcm-dev, liblcm-bin, libglib2.0-dev, zlib1g-dev, libssl-dev, libeigen3-dev, libspdlog-dev, pkg-config"
  RECOMMENDS "cmake, g++")
shoal_package(shoal-doc SECTION doc ALL COMPONENTS doc
  SUMMARY "documentation of the Shoal simulator"
  TEXT "Lessons, guides, models with their equations, the reference of all keys,
devices, messages and metrics, and the interfaces for plugins and clients, as
HTML.")
if(SHOAL_PYTHON AND NOT SHOAL_SANITIZE)
  # The module is for the version of Python with which it was built.
  execute_process(COMMAND ${SHOAL_PYTHON_INTERPRETER} -c "import sys; print(f'python3 (>= 3.{sys.version_info.minor}), python3 (<< 3.{sys.version_info.minor + 1})', end='')"
                  OUTPUT_VARIABLE python_package COMMAND_ERROR_IS_FATAL ANY)
  shoal_package(python3-shoal SECTION python COMPONENTS python
    SUMMARY "Python package of the Shoal simulator"
    TEXT "Worlds in the process of Python, clients of a run over LCM, records as NumPy
arrays, many worlds at once with the interfaces of Gymnasium and PettingZoo, and
plots of results."
    DEPENDS "shoal (= ${PROJECT_VERSION}), ${python_package}, python3-numpy"
    RECOMMENDS "python3-matplotlib, python3-pandas")
  set(CPACK_COMPONENTS_ALL programs client device doc python)
else()
  set(CPACK_COMPONENTS_ALL programs client device doc)
endif()
include(CPack)
