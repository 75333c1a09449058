// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bridges/view/view_publisher.hpp"
#include "motion/analysis/motion_stage.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/run/run_control.hpp"
#include "viewer/server/run_view.hpp"

namespace motion {

/// Live page of a world in which a motion is recorded or played, with its scores if the stage has them.
class StageView {
 public:
  /// Starts the server, and sends the state after each step of the stage, which must outlive this.  Throws
  /// bridges::WebError.
  StageView(const experiment::ViewOptions& options, MotionStage& stage);
  ~StageView();
  StageView(const StageView&) = delete;
  StageView& operator=(const StageView&) = delete;

  std::string url() const { return page_.url(); }
  /// Number of pages.
  int clients() const { return page_.clients(); }
  /// Pace as shown on the pages.
  sim::RunControl& control() { return control_; }
  /// Serves the pages, and passes their requests on; to be called once a frame, also during a pause.
  void serve(const viewer::RunView::Execute& execute);
  /// Announces that the stage went back in time.
  void went_back();

 private:
  /// Bus of the messages for viewers only.
  class PageBus final : public sim::Bus {
   public:
    explicit PageBus(viewer::RunView& page) : page_(page) {}
    void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override {
      page_.message(channel, payload, at);
    }
    std::unique_ptr<sim::Mailbox> open_mailbox(const std::string& channel, std::size_t capacity) override {
      return nobody_.open_mailbox(channel, capacity);
    }
    sim::BusCounts counts() const override { return nobody_.counts(); }

   private:
    viewer::RunView& page_;
    sim::InProcessBus nobody_;
  };

  MotionStage& stage_;
  sim::RunControl control_;
  viewer::RunView page_;
  PageBus bus_;
  bridges::ViewPublisher publisher_;
};

}  // namespace motion
