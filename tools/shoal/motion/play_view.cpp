// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/play_view.hpp"

#include <spdlog/fmt/fmt.h>

#include <stdexcept>
#include <thread>

#include "experiment/process/signals.hpp"
#include "sim/config/message_text.hpp"

namespace tools {

PlayView::PlayView(const experiment::ViewOptions& options, motion::MotionStage& stage, double rate)
    : stage_(stage), page_(options, stage) {
  page_.control().speed = rate;
}

bool PlayView::goes_on() {
  constexpr std::chrono::microseconds max_wait{20'000};
  sim::RunControl& control = page_.control();
  while (experiment::caught_signal() == 0) {
    page_.serve(viewer::RunView::answering(
        [this](const std::string& command, double value, const std::string&) { return execute(command, value); }));
    // The motion waits for the first page, so that its beginning is seen.
    has_page_ = has_page_ || page_.clients() > 0;
    auto wait = max_wait;
    if (has_page_ && control.may_step()) {
      const sim::World& world = stage_.world();
      wait = control.paused ? std::chrono::microseconds{0} : pacer_.until(world.now() + world.step_time(), control);
    }
    if (wait.count() == 0) {
      control.step_taken();
      return true;
    }
    // Short waits, since the page is served in this thread.
    std::this_thread::sleep_for(std::min(wait, max_wait));
  }
  return false;
}

std::string PlayView::execute(const std::string& command, double value) {
  if (command == "rewind") return rewind(value);
  if (command != "where" && !experiment::set_pace(page_.control(), command, value))
    throw std::runtime_error("'" + sim::shortened(sim::printable(command)) +
                             "' is not possible while a motion is played: record over it to change the world");
  return fmt::format("step {}, {:.6g} s", stage_.world().step_number(), stage_.now_s());
}

std::string PlayView::rewind(double seconds) {
  if (!(seconds > 0 && seconds <= 1e9))
    throw std::runtime_error(fmt::format("'rewind' needs a value above 0, in seconds, got {}", seconds));
  page_.control().set_paused(true);
  stage_.go_to(std::max(stage_.now_s() - seconds, stage_.earliest_s()));
  page_.went_back();
  return execute("where", 0);
}

}  // namespace tools
