// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/motion/motion_track.hpp"

namespace sim {

/// Invalid frames: `line` and `column` count from 1.
struct FramesError {
  int line = 0;
  int column = 0;
  std::string text;  ///< empty: no error
};

/// Reads CSV text: a head `t_s,JOINT,...`, then a line for each frame, with times in s that increase and values in rad
/// or m.  Lines that start with `#` are remarks.  Between frames the values are linear.  On an error nothing is
/// returned, and `error` says where.
std::vector<MotionTrack> parse_motion_frames(std::string_view text, FramesError& error);

/// Reads a CSV file for a key of a file.  Errors name line and column of the CSV file.
std::vector<MotionTrack> read_motion_frames(const std::string& path, ParamReader& in, const char* key);

/// Returns the tracks as CSV text; all must have keys at the same times.
std::string motion_frames_text(const std::vector<MotionTrack>& tracks);

/// Samples tracks at 0, period_s, 2 period_s, ... to `end_s`.
std::vector<MotionTrack> sampled(const std::vector<MotionTrack>& tracks, double end_s, double period_s);

}  // namespace sim
