// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "shoal/message_schema.hpp"
#include "sim/random/allan.hpp"

namespace viewer {

/// Allan deviation (IEEE 952-1997) of one numeric field of the messages.
struct AllanCurve {
  std::string field;  ///< such as `angular_velocity_radps[2]`
  std::vector<sim::AllanPoint> points;
};

/// Allan deviations of one channel of a log.
struct AllanTable {
  std::string channel;
  double dt_s = 0;  ///< between messages, by their `utime`
  std::vector<AllanCurve> curves;
};

/// Computes the deviation of every double that is an element of an array of fixed size, and of `rate_error` of a clock.
/// Throws std::runtime_error when the channel has too few messages, has several types, or its messages are not
/// equidistant in time (within 1 %).
AllanTable allan_table(const std::string& log, const std::string& channel, const shoal::MessageTypes& types);

/// Returns the table as CSV: `field,tau_s,deviation,relative_error`.
std::string to_csv(const AllanTable& table);
/// Plots the table into a PNG file with gnuplot; one panel for each array.  Throws std::runtime_error.
void plot(const AllanTable& table, const std::string& png);

}  // namespace viewer
