// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/replay/recorded_steps.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "bridges/log/run_journal.hpp"

namespace tools {

namespace {

bool is_message(const ReplayLog::Letter& letter) {
  return letter.bus != bridges::RunJournal::serial_bus && letter.channel != bridges::RunJournal::request_channel;
}

}  // namespace

bool is_of_the_handshake(std::string_view channel) {
  static constexpr std::array<std::string_view, 10> names{
      "sim.ack",    "sim.control", "sim.control.reply", "sim.hash",     "sim.mail",
      "sim.notice", "sim.resend",  "sim.resent",        "sim.snapshot", "sim.tick"};
  return std::find(names.begin(), names.end(), channel) != names.end();
}

RecordedSteps::RecordedSteps(const ReplayLog& log) : log_(log), file_(log.path) {}

void RecordedSteps::mail_after(std::int64_t step, const Use& use) {
  for (; next_mail_ < log_.letters.size() && log_.letters[next_mail_].step <= step; ++next_mail_) {
    const ReplayLog::Letter& letter = log_.letters[next_mail_];
    if (is_message(letter)) use(letter.channel, letter.payload);
  }
}

/// A record holds mail twice: as it came, with the stamp of the step before, and in sim.mail.
bool RecordedSteps::is_copy_of_mail() {
  const auto utime_of = [this](const ReplayLog::Letter& letter) {
    return log_.info.epoch_utime + letter.step * log_.info.step_us;
  };
  // The copy of a letter whose time is over is not in the record: it begins after it.
  while (next_copy_ < log_.letters.size() &&
         (!is_message(log_.letters[next_copy_]) || utime_of(log_.letters[next_copy_]) < event_.utime))
    ++next_copy_;
  if (next_copy_ == log_.letters.size()) return false;
  const ReplayLog::Letter& letter = log_.letters[next_copy_];
  const bool same =
      letter.channel == event_.channel && event_.utime == utime_of(letter) &&
      std::equal(letter.payload.begin(), letter.payload.end(), event_.payload.begin(), event_.payload.end());
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
    if (!is_copy_of_mail()) use(event_.channel, event_.payload);
  }
}

}  // namespace tools
