// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>

#include "sim/config/diagnostics.hpp"
#include "sim/device/plugin_interface.hpp"

// A plugin is a shared library with device types that is built outside of the source tree.  It is loaded into the
// program, uses its functions, and registers its devices with the same macros as built-in ones.

#define SHOAL_TEXT_OF_EXPANDED(value) #value
#define SHOAL_TEXT_OF(value) SHOAL_TEXT_OF_EXPANDED(value)

/// ABI identifier that must be equal in program and plugin.  The alignment of Eigen depends on options such as -march,
/// and changes the layout of all objects that contain a vector.
#define SHOAL_PLUGIN_ABI                                                                                               \
  "shoal " SHOAL_INTERFACE_VERSION ", headers " SHOAL_INTERFACE_HASH                                                   \
  ", abi " SHOAL_TEXT_OF(__GXX_ABI_VERSION) ", strings " SHOAL_TEXT_OF(_GLIBCXX_USE_CXX11_ABI) ", C++ " SHOAL_TEXT_OF( \
      __cplusplus) ", alignment " SHOAL_TEXT_OF(EIGEN_MAX_ALIGN_BYTES)

#define SHOAL_PLUGIN_MARK "shoal-plugin|"

/// Declares a plugin; needed once in each plugin, in any of its files: SHOAL_PLUGIN("thermometer", "1.0");
#define SHOAL_PLUGIN(name, version)                                                 \
  extern "C" __attribute__((visibility("default"))) const char shoal_plugin_info[]; \
  const char shoal_plugin_info[] = SHOAL_PLUGIN_MARK name "|" version "|" SHOAL_PLUGIN_ABI

namespace sim {

/// Returns the path of a plugin, searched in `directory`, then in the directories of SHOAL_PLUGIN_PATH, then in
/// lib/shoal/plugins of the installation prefix.  Empty: not found.
std::string find_plugin(const std::string& file, const std::string& directory);

/// Loads a plugin once.  A failure is reported as one error at `place`; `who` as in Diagnostics::error.
void load_plugin(const std::string& path, const SourcePlace& place, const std::string& who, Diagnostics& diagnostics);

/// Returns whether a plugin is loaded.  `file`: its path or bare file name.
bool is_loaded_plugin(const std::string& file);

}  // namespace sim
