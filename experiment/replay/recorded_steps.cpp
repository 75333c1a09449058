// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/recorded_steps.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "bridges/log/run_journal.hpp"

namespace experiment {

namespace {

bool is_message(const ReplayLog::Input& input) {
  return input.bus != bridges::RunJournal::serial_bus && input.channel != bridges::RunJournal::request_channel;
}

}  // namespace

bool is_of_the_handshake(std::string_view channel) {
  static constexpr std::array<std::string_view, 11> names{
      "sim.ack",    "sim.control", "sim.control.reply", "sim.hash",   "sim.inputs", "sim.audit",
      "sim.resend", "sim.resent",  "sim.snapshot",      "sim.record", "sim.tick"};
  return std::find(names.begin(), names.end(), channel) != names.end();
}

RecordedSteps::RecordedSteps(const ReplayLog& log) : log_(log), file_(log.path) {}

void RecordedSteps::inputs_after(std::int64_t step, const Use& use) {
  for (; next_input_ < log_.inputs.size() && log_.inputs[next_input_].step <= step; ++next_input_) {
    const ReplayLog::Input& input = log_.inputs[next_input_];
    if (is_message(input)) use(input.channel, input.payload);
  }
}

/// A record contains inputs twice: as received, with the time stamp of the previous step, and in sim.inputs.
bool RecordedSteps::is_copy_of_input() {
  const auto utime_of = [this](const ReplayLog::Input& input) {
    return log_.info.epoch_utime + input.step * log_.info.step_us;
  };
  // The copy of an earlier input is not in the record, which starts after it.
  while (next_copy_ < log_.inputs.size() &&
         (!is_message(log_.inputs[next_copy_]) || utime_of(log_.inputs[next_copy_]) < event_.utime))
    ++next_copy_;
  if (next_copy_ == log_.inputs.size()) return false;
  const ReplayLog::Input& input = log_.inputs[next_copy_];
  const bool same =
      input.channel == event_.channel && event_.utime == utime_of(input) &&
      std::equal(input.payload.begin(), input.payload.end(), event_.payload.begin(), event_.payload.end());
  if (same) ++next_copy_;
  return same;
}

void RecordedSteps::published_at(std::int64_t step, const Use& use) {
  const std::int64_t end_utime = log_.info.epoch_utime + step * log_.info.step_us;
  while (true) {
    if (!has_event_ && !file_.next(event_)) return;
    has_event_ = true;
    if (event_.utime > end_utime) return;
    has_event_ = false;
    if (is_of_the_handshake(event_.channel)) continue;
    if (event_.channel == "sim.info" && !std::exchange(skipped_info_, true)) continue;
    if (!is_copy_of_input()) use(event_.channel, event_.payload);
  }
}

}  // namespace experiment
