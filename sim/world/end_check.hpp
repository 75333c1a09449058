// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace sim {

class World;

/// Returns the warnings of the end of a run: what WorldWarnings has kept for it, and the sensors whose readings have
/// all lacked something, such as a lock or a fix, for a minute or more.  `is_awaited`: returns whether a program waits
/// for the reports on a channel, without which it is usual that a GPS under water has no fix.
std::vector<std::string> end_warnings(const World& world, const std::function<bool(const std::string&)>& is_awaited);

}  // namespace sim
