// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/shoal/sdf/sdf_files.hpp"
#include "tools/shoal/urdf/urdf_import.hpp"

namespace tools {

/// Reads a model in SDF and converts it into a vehicle file.  `model`: its name in a world; empty: the only one. Throws
/// sim::ConfigError of one line.
RobotImport import_sdf(const std::string& path, const std::string& model, const RobotImportOptions& options);

/// The same of a text that was added to the files.
RobotImport import_sdf(SdfFiles& files, const std::string& path, const std::string& model,
                       const RobotImportOptions& options);

}  // namespace tools
