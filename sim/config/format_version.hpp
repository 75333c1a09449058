// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/param_reader.hpp"

namespace sim {

/// Reads the required key `shoal`, the version of the format of a file, which is 1.
void read_format_version(ParamReader& in, int& version);

}  // namespace sim
