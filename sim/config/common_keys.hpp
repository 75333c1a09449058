// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace sim {

/// Reads the version of a file's format, a required key: only 1 exists.  A greater one is an error that says so.
void read_version(ParamReader& in, const char* key, int& version);

/// Reads a list of points `[[x, y, z], ...]`, or of `[x, y]` when `columns` is 2 (z is then 0).
void read_points(ParamReader& in, const char* key, std::vector<Vector3d>& value, std::size_t columns,
                 const char* meaning);

}  // namespace sim
