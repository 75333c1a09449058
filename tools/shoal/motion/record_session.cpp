// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/record_session.hpp"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <thread>

#include "experiment/drive/drive_profile.hpp"
#include "experiment/process/signals.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

constexpr double back_s = 1;                              // of one press of the key
constexpr std::chrono::milliseconds time_to_answer{500};  // of a terminal that has the Kitty keyboard protocol

std::vector<std::string> keys_of(const std::vector<BoundAction>& actions) {
  std::vector<std::string> keys;
  for (const BoundAction& one : actions) keys.push_back(one.key);
  return keys;
}

motion::FramePace::Clock::duration clock_time(double seconds) {
  return std::chrono::duration_cast<motion::FramePace::Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

RecordSession::RecordSession(const RecordArguments& arguments, motion::MotionRecorder& recorder,
                             std::vector<BoundAction> actions)
    : arguments_(arguments),
      recorder_(recorder),
      actions_(std::move(actions)),
      commands_(
          recorder.controls(), recorder.joints(), [&](const std::string& joint) { return recorder.find(joint); },
          keys_of(actions_)),
      is_live_(arguments.events.empty()),
      line_(is_live_, !arguments.devices.empty(), std::filesystem::path(arguments.file).filename().string()),
      pace_(clock_time(recorder.frame_s() / arguments.rate.value_or(1)),
            clock_time(sim::to_seconds(recorder.stage().world().step_time()) / arguments.rate.value_or(1))) {
  // A key of --on must not also move a joint.
  for (const BoundAction& one : actions_)
    if (commands_.uses(one.key)) throw command_line::UsageError("--on: key '" + one.key + "' has another effect");
  if (!is_live_) inputs_.push_back(std::make_unique<motion::EventFileInput>(arguments.events));
  for (const std::string& device : arguments.devices)
    inputs_.push_back(std::make_unique<motion::DeviceInput>(device, commands_));
  if (is_live_ && experiment::TerminalKeys::possible()) {
    auto terminal = std::make_unique<motion::TerminalInput>(!arguments.devices.empty());
    if (arguments.devices.empty()) terminal_ = terminal.get();
    inputs_.push_back(std::move(terminal));
  }
  if (inputs_.empty()) throw command_line::UsageError("needs a terminal, or --input or --events");
  if (!arguments.with_page) return;
  view_.emplace(arguments.view, recorder);
  std::cerr << "live page: " << view_->url() << '\n';
}

int RecordSession::run() {
  if (is_live_)
    std::cerr << commands_.help()
              << "  space pauses, backspace goes back 1 s, tab stops all, - and = set the speed, ' measures pushes, "
                 "enter ends\n";
  const double period_s = recorder_.frame_s() / arguments_.rate.value_or(1);
  mode_until_ = Clock::now() + time_to_answer;
  pace_.restart(Clock::now());
  for (std::int64_t tick = 0; experiment::caught_signal() == 0 && !is_over(); ++tick) {
    bool goes_on = true;
    try {
      // Events of a file come at the times of frames, so that a recording from a file is the same on every machine.
      const auto until_us = static_cast<std::int64_t>(std::llround(static_cast<double>(tick) * period_s * 1e6));
      for (const auto& input : inputs_) goes_on = input->read(until_us, commands_) && goes_on;
    } catch (const experiment::DriveError& error) {
      line_.end();
      std::cerr << "shoal motion record: " << error.what() << "; what was recorded is saved\n";
      return exit_bus;
    }
    show_mode();
    carry_out();
    const std::vector<double> velocities = commands_.velocities();
    if (!is_paused_) recorder_.frame(velocities);
    if (view_) view_->serve(is_paused_);
    line_.show(recorder_, commands_, velocities, is_paused_);
    if (!goes_on || is_finished_) break;
    if (is_live_) wait();
  }
  line_.end();
  if (is_live_) std::cerr << pace_.text() << '\n';
  return exit_ok;
}

bool RecordSession::is_over() const {
  if (arguments_.duration_s && recorder_.now_s() >= *arguments_.duration_s - recorder_.frame_s() * 1.5) return true;
  return recorder_.is_full();
}

/// Says once, when the terminal has answered or cannot, how its keys move joints.
void RecordSession::show_mode() {
  if (terminal_ == nullptr || (!terminal_->reports_releases() && Clock::now() < mode_until_)) return;
  line_.end();
  std::cerr << (terminal_->reports_releases()
                    ? "hold the keys: a joint moves while its key is held\n"
                    : "a key starts its joint, the same key stops it: this terminal reports no releases\n");
  terminal_ = nullptr;
}

void RecordSession::carry_out() {
  for (const motion::RecordWish wish : commands_.take_wishes()) carry_out(wish);
  for (const std::size_t number : commands_.take_actions()) {
    try {
      recorder_.change(actions_[number].action);
    } catch (const std::runtime_error& error) {
      line_.end();
      std::cerr << "shoal motion record: key '" << actions_[number].key << "': " << error.what() << '\n';
    }
  }
}

void RecordSession::carry_out(motion::RecordWish wish) {
  switch (wish) {
    case motion::RecordWish::pause:
      is_paused_ = !is_paused_;
      break;
    case motion::RecordWish::finish:
      is_finished_ = true;
      break;
    case motion::RecordWish::push:
      measure_push();
      break;
    case motion::RecordWish::back:
      recorder_.back(back_s);
      if (view_) view_->went_back();
      commands_.release_all();
      is_paused_ = is_live_;
      break;
  }
}

/// The recording waits meanwhile.
void RecordSession::measure_push() {
  line_.end();
  if (is_live_) std::cerr << "measures pushes: the recording waits\n";
  const motion::PushMargin margin = recorder_.push_margin();
  std::cerr << push_text(margin, recorder_.now_s()) << '\n';
  pace_.restart(Clock::now());
}

/// Waits for the next frame.  When the machine is too slow, the recording is slower than the clock.
void RecordSession::wait() {
  std::this_thread::sleep_until(pace_.due());
  if (is_paused_)
    pace_.restart(Clock::now());
  else
    pace_.begin(Clock::now());
}

}  // namespace tools
