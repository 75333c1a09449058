// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "experiment/run/time_control.hpp"
#include "experiment/terminal/terminal_keys.hpp"
#include "experiment/terminal/terminal_parser.hpp"
#include "sim/run/run_control.hpp"

namespace experiment {

/// Actions of the keys of a terminal on a run.
class RunKeys {
 public:
  /// `report` shows a line of text, `send_request` an unfinished line.  All must outlive this.
  using Show = std::function<void(const std::string& text)>;
  RunKeys(TimeControl& time, sim::RunControl& control, Show report, Show send_request);

  /// Returns one or two lines that name all keys.
  static std::string help();
  /// Executes the keys that were pressed.
  void read();
  void press(char key);

 private:
  void execute(char key);
  void answer(char key);
  void change_speed(double factor);
  std::string run_state() const;

  TimeControl& time_;
  sim::RunControl& control_;
  Show report_, request_;
  TerminalKeys keys_;
  KeySequences sequences_;
  bool asking_ = false;
  std::string answer_;
};

}  // namespace experiment
