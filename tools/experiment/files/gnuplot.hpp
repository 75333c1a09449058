// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace tools {

/// A text as a gnuplot string.  Any content stays text: the names of a world are untrusted.
std::string gnuplot_text(const std::string& text);

/// The y axis of curves of errors, by a usual error of each: from 0, or logarithmic where one is much larger than
/// another, which would be a line on the axis.
std::string axis_of_errors(const std::vector<double>& errors_m);

/// Runs `gnuplot SCRIPT` in a directory; its output is written to plot.log there.  It is killed when it takes longer
/// than the limit, or once `give_up` returns true.  True when the images were made.
bool run_gnuplot(const std::string& directory, const std::string& script, std::chrono::milliseconds limit,
                 const std::function<bool()>& give_up);

}  // namespace tools
