// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>

#include "sim/config/diagnostics.hpp"
#include "sim/device/plugin_interface.hpp"

// A plugin is a library with device types that were built outside of the source tree.  It is loaded into the program,
// uses its functions, and registers its devices with the same macros as built-in ones.

#define SHOAL_TEXT_OF_EXPANDED(value) #value
#define SHOAL_TEXT_OF(value) SHOAL_TEXT_OF_EXPANDED(value)

/// What program and plugin must have in common.  Eigen's alignment follows from options such as -march, and changes
/// the layout of everything that holds a vector.
#define SHOAL_PLUGIN_ABI                                                                                               \
  "shoal " SHOAL_INTERFACE_VERSION ", headers " SHOAL_INTERFACE_HASH                                                   \
  ", abi " SHOAL_TEXT_OF(__GXX_ABI_VERSION) ", strings " SHOAL_TEXT_OF(_GLIBCXX_USE_CXX11_ABI) ", C++ " SHOAL_TEXT_OF( \
      __cplusplus) ", alignment " SHOAL_TEXT_OF(EIGEN_MAX_ALIGN_BYTES)

#define SHOAL_PLUGIN_MARK "shoal-plugin|"

/// Once in each plugin, in any of its files: SHOAL_PLUGIN("thermometer", "1.0");
#define SHOAL_PLUGIN(name, version)                                                 \
  extern "C" __attribute__((visibility("default"))) const char shoal_plugin_info[]; \
  const char shoal_plugin_info[] = SHOAL_PLUGIN_MARK name "|" version "|" SHOAL_PLUGIN_ABI

namespace sim {

/// Where a plugin is found: in `directory`, then in the directories of SHOAL_PLUGIN_PATH, then in lib/shoal/plugins of
/// the program's prefix.  Empty: nowhere.
std::string find_plugin(const std::string& file, const std::string& directory);

/// Loads a plugin, once.  What is wrong with it becomes one error at `place`; `who` as in Diagnostics::error.
void load_plugin(const std::string& path, const SourcePlace& place, const std::string& who, Diagnostics& diagnostics);

/// `file` is the path of a plugin that was loaded, or the bare name of its file.
bool is_loaded_plugin(const std::string& file);

}  // namespace sim
