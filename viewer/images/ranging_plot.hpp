// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"

namespace viewer {

/// Returns true for types of which all messages are drawn in one plot, side_scan_t and multibeam_t; false for types of
/// which each message is one image.
bool are_all_drawn(std::int64_t fingerprint);

/// Plots a recording of a range sensor with gnuplot, as a PNG file: all payloads where are_all_drawn(), else the first.
/// All are of one type.  Throws std::runtime_error with the reason.
void draw_ranging(const std::vector<sim::Bytes>& payloads, const std::string& title, const std::string& png);

}  // namespace viewer
