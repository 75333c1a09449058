// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "motion/record/joint_commands.hpp"
#include "motion/record/motion_recorder.hpp"

namespace tools {

/// Line of a recording on a terminal: time, what happens, how safely it stands, joints that move.
class RecordLine {
 public:
  /// `file`: name of the motion file.
  RecordLine(bool is_shown, bool shows_set, std::string file);
  ~RecordLine() { end(); }
  RecordLine(const RecordLine&) = delete;
  RecordLine& operator=(const RecordLine&) = delete;
  void show(motion::MotionRecorder& recorder, const motion::JointCommands& commands,
            const std::vector<double>& velocities, bool is_paused);
  void end();

 private:
  std::string joints_text(motion::MotionRecorder& recorder, const std::vector<double>& velocities) const;

  bool is_shown_, shows_set_, has_line_ = false;
  std::string file_;
  std::chrono::steady_clock::time_point next_{};
};

/// Returns the static margin as text: `static 43 mm`, or that fewer than three contacts carry the vehicle.
std::string margin_text(const std::optional<experiment::Support>& support);
/// Returns the pushes that a vehicle withstands as a line, without its end: each direction in N s, then the worst.
std::string push_text(const motion::PushMargin& margin, double at_s);

}  // namespace tools
