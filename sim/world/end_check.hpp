// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace sim {

class World;

/// Returns the warnings of the end of a run: what WorldWarnings has kept for it, and the sensors whose readings have
/// all lacked something, such as a lock or a fix, for a minute or more.
std::vector<std::string> end_warnings(const World& world);

}  // namespace sim
