// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "motion/record/motion_recorder.hpp"
#include "motion/record/stage_view.hpp"

namespace motion {

/// Live page of a recording of a motion.  Pages see the world, and change it by actions, which become a part of the
/// recording; only keys steer it.
class RecordView {
 public:
  /// Starts the server.  `recorder` must outlive this.  Throws bridges::WebError.
  RecordView(const experiment::ViewOptions& options, MotionRecorder& recorder)
      : recorder_(recorder), page_(options, recorder.stage()) {}

  std::string url() const { return page_.url(); }
  /// Serves the pages; to be called once a frame, even while the recording is paused.
  void serve(bool is_paused);
  /// Announces that the recording went back in time.
  void went_back() { page_.went_back(); }

 private:
  std::string execute(const std::string& command, const std::string& text);

  MotionRecorder& recorder_;
  StageView page_;
};

}  // namespace motion
