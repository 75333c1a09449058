// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/config/param_info.hpp"

namespace tools {

/// Pages of docs/ that are made from what the program knows.  A test fails when one is stale.
/// Page names: devices, world_format, messages, metrics, programs.  Throws std::out_of_range on any other.
std::string reference_page(const std::string& name);

/// What `shoal describe NAME` prints, in lines of at most `columns` characters where its words allow: a device type,
/// `device` (keys of all devices), `world`, `vehicle`, `noise`, `metrics`, a message type, or a program with a
/// declaration.  Empty when nothing is called so.
std::string describe_text(const std::string& name, std::size_t columns = 1000);

/// A title and a table of keys, as describe_text() has them.
std::string describe_keys(const std::string& title, const std::vector<sim::ParamInfo>& params,
                          std::size_t columns = 1000);

}  // namespace tools
