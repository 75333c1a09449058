// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/stage_view.hpp"

#include "experiment/run/scores_message.hpp"
#include "experiment/run/version.hpp"

namespace motion {

StageView::StageView(const experiment::ViewOptions& options, MotionStage& stage)
    : stage_(stage),
      page_(options, experiment::short_version()),
      bus_(page_),
      publisher_(
          bus_, stage.world(),
          [&stage](shoal::sim_scores_t& message) {
            if (stage.scoring() != nullptr) experiment::fill_scores(*stage.scoring(), message);
          },
          [] { return true; }) {
  page_.start(stage_.world(), std::nullopt);
  page_.announce();
  stage_.after_step = [this, before = std::move(stage_.after_step)](MotionStage& now) {
    if (before) before(now);
    publisher_.after_step();
    page_.after_step(now.world(), publisher_, control_);
  };
}

StageView::~StageView() {
  stage_.after_step = {};
  page_.ended(stage_.world(), control_, "quit", "");
}

void StageView::serve(const viewer::RunView::Execute& execute) {
  page_.serve(stage_.world(), publisher_, control_, "", execute);
}

void StageView::went_back() {
  publisher_.discard();
  publisher_.set_branch(++control_.branch);
  page_.moved(stage_.world(), control_, true);
}

}  // namespace motion
