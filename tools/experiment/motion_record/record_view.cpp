// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/motion_record/record_view.hpp"

#include "tools/experiment/run/version.hpp"

namespace tools {

RecordView::RecordView(const ViewOptions& options, MotionStage& stage)
    : stage_(stage),
      page_(options, short_version()),
      bus_(page_),
      publisher_(bus_, stage.world(), {}, [] { return true; }) {
  page_.start(stage_.world(), std::nullopt);
  stage_.after_step = [this](MotionStage& now) {
    publisher_.after_step();
    page_.after_step(now.world(), publisher_, control_);
  };
}

RecordView::~RecordView() {
  stage_.after_step = {};
  page_.ended(stage_.world(), control_, "quit", "");
}

void RecordView::serve(bool is_paused) {
  control_.paused = is_paused;
  page_.serve(stage_.world(), publisher_, control_, "", [](const std::string&, double, const std::string&) {
    return RunView::Answer{false, "a recording is steered by its keys"};
  });
}

void RecordView::went_back() {
  publisher_.discard();
  publisher_.set_branch(++control_.branch);
  page_.moved(stage_.world(), control_, true);
}

}  // namespace tools
