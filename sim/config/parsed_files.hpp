// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/config/config_node.hpp"

namespace sim {

/// Parses the text of a file, as parse_config_text().  The trees of the last files are kept, for requests that spawn
/// many vehicles of a file: a file with the same name and text is not parsed again.  Thread-safe.
ConfigNode parse_file_text(const std::string& text, const std::string& path, Diagnostics& diagnostics);

}  // namespace sim
