// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "motion/record/frame_pace.hpp"
#include "motion/record/record_input.hpp"
#include "motion/record/record_view.hpp"
#include "tools/shoal/motion/record_line.hpp"

namespace tools {

/// Command line of `shoal motion record`.
struct RecordArguments {
  std::string file, events;
  std::string operation;  ///< in the words of the command line
  std::vector<std::string> devices, overdub, actions;
  std::optional<double> rate, from_s, to_s, duration_s;
  bool append = false, overwrite = false, recover = false, with_page = false, open = false, embed = false;
  experiment::ViewOptions view;
  motion::StageOptions stage;
};

/// Key of an action of the world.
struct BoundAction {
  std::string key;
  sim::ConfigNode action;
};

/// A recording that lasts: its inputs, its line on the terminal and its live page.
class RecordSession {
 public:
  /// All must outlive this.  Throws command_line::UsageError for keys that have two effects and without an input,
  /// DriveError for an input that cannot be read, bridges::WebError.
  RecordSession(const RecordArguments& arguments, motion::MotionRecorder& recorder, std::vector<BoundAction> actions);

  /// Records until an input ends it; returns the exit code.
  int run();

 private:
  using Clock = motion::FramePace::Clock;

  bool is_over() const;
  void show_mode();
  void carry_out();
  void carry_out(motion::RecordWish wish);
  void measure_push();
  void wait();

  const RecordArguments& arguments_;
  motion::MotionRecorder& recorder_;
  std::vector<BoundAction> actions_;
  motion::JointCommands commands_;
  const bool is_live_;  ///< at the pace of the clock
  RecordLine line_;
  motion::FramePace pace_;
  std::vector<std::unique_ptr<motion::RecordInput>> inputs_;
  const motion::TerminalInput* terminal_ = nullptr;  ///< whose mode is not shown yet
  Clock::time_point mode_until_{};
  std::optional<motion::RecordView> view_;
  bool is_paused_ = false, is_finished_ = false;
};

}  // namespace tools
