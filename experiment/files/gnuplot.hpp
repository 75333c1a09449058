// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace experiment {

/// Returns a text as a gnuplot string.  Content is never executed, because the names of a world are untrusted.
std::string gnuplot_text(const std::string& text);

/// Returns the y axis for error curves, by a typical error of each: from 0, or logarithmic where one is so much larger
/// than another that the smaller one would coincide with the axis.
std::string axis_of_errors(const std::vector<double>& errors_m);

/// Runs `gnuplot SCRIPT` in a directory; its output is written to plot.log there.  It is killed when it takes more
/// processor time than the limit (which other programs on a busy machine do not take from it), or 20 times as long
/// (because it waits), or once `give_up` returns true.  Returns true when the images were written.
bool run_gnuplot(const std::string& directory, const std::string& script, std::chrono::milliseconds cpu_limit,
                 const std::function<bool()>& give_up);

}  // namespace experiment
