// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "motion/formats/motion_format.hpp"
#include "sim/config/config_node.hpp"

namespace motion {

/// Returns text in double quotes, unless it is a plain word.
std::string yaml_word(const std::string& text);
/// Returns a number that every YAML reader takes as floating point: `0.0`, with at most 9 decimals.
std::string yaml_double(double value);

/// Parses the only YAML document of a file, which `---` may follow.  Errors go to `diagnostics`.
sim::ConfigNode parse_yaml_document(const MotionSource& source, sim::Diagnostics& diagnostics);

/// Returns the joints of the vehicle; each must be named once.  Throws sim::ConfigError at the place.
std::vector<std::string> joints_called(const MotionSource& source, const char* list,
                                       const std::vector<std::string>& foreign, const sim::SourcePlace& place);

}  // namespace motion
