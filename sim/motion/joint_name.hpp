// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sim {

/// Bytes of the longest name of a joint in a motion.
constexpr std::size_t max_joint_name = 255;

/// Returns what is wrong with the name of a joint in a motion, for an error: the rule and the name; empty: nothing.
std::string joint_name_error(std::string_view name);

}  // namespace sim
