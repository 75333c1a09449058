// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/config/param_info.hpp"

namespace tools {

/// Returns a page of docs/ that is generated from the program.  A test fails when one is out of date.
/// Page names: devices, world_format, messages, metrics, programs.  Throws std::out_of_range for any other.
std::string reference_page(const std::string& name);

/// Returns the output of `shoal describe NAME`, in lines of at most `columns` characters where its words allow: a
/// device type, `device` (keys of all devices), `world`, `vehicle`, `noise`, `metrics`, a message type, or a program
/// with a declaration.  Empty for an unknown name.
std::string describe_text(const std::string& name, std::size_t columns = 1000);

/// Returns a title and a table of keys, in the form of describe_text().
std::string describe_keys(const std::string& title, const std::vector<sim::ParamInfo>& params,
                          std::size_t columns = 1000);

}  // namespace tools
