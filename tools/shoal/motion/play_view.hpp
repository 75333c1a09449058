// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/time/pacer.hpp"
#include "motion/record/stage_view.hpp"

namespace tools {

/// Live page of a motion that is played.  Pages pause it, step it, set its pace and go back in it; they do not change
/// the world.
class PlayView {
 public:
  /// Starts the server.  `rate`: simulated seconds in a second of the clock.  `stage` must outlive this.  Throws
  /// bridges::WebError.
  PlayView(const experiment::ViewOptions& options, motion::MotionStage& stage, double rate);

  std::string url() const { return page_.url(); }
  /// Serves the pages until the next step is due, the first one when a page is open; returns false when a signal ends
  /// it.
  bool goes_on();

 private:
  std::string execute(const std::string& command, double value);
  std::string rewind(double seconds);

  motion::MotionStage& stage_;
  motion::StageView page_;
  experiment::Pacer pacer_;
  bool has_page_ = false;
};

}  // namespace tools
