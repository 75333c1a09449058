// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_keys.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace experiment {

namespace {

constexpr const char* question = "run until (seconds, or name of an event; Esc: do not): ";
constexpr double slower_than_most = 32;  ///< multiple of real time, from as fast as possible
constexpr double slowest = 1e-3, fastest = 1e6;

}  // namespace

RunKeys::RunKeys(TimeControl& time, sim::RunControl& control, Show report, Show send_request)
    : time_(time), control_(control), report_(std::move(report)), request_(std::move(send_request)) {}

std::string RunKeys::help() {
  return "keys: space pause, n step, N 10 steps, + - faster slower, 1 real time, m as fast as possible,\n"
         "      r back 10 s, R back 30 s, s snapshot, u run until, q quit, ? this";
}

void RunKeys::read() {
  constexpr int max_at_once = 50;
  for (int i = 0; i < max_at_once; ++i) {
    const auto now = KeySequences::Clock::now();
    const auto byte = keys_.next();
    for (const char key : byte ? sequences_.next(*byte, now) : sequences_.alone(now)) press(key);
    if (!byte) return;
  }
}

void RunKeys::press(char key) {
  try {
    if (asking_)
      answer(key);
    else
      execute(key);
  } catch (const std::exception& error) {
    report_(error.what());
  }
}

void RunKeys::execute(char key) {
  switch (key) {
    // Pause, steps and speed.
    case ' ':
      control_.set_paused(!control_.paused);
      return report_(run_state());
    case 'n':
    case '.':
    case 'N':
      control_.add_steps(key == 'N' ? 10 : 1);
      return;
    case '+':
      return change_speed(2);
    case '-':
      return change_speed(0.5);
    case '1':
      control_.set_speed(1);
      return report_(run_state());
    case 'm':
      control_.set_speed(0);
      return report_(run_state());
    // Rewind and snapshot.
    case 'r':
    case 'R':
      return report_(time_.rewind(key == 'r' ? 10 : 30, false));
    case 's':
      return report_(time_.write_snapshot(""));
    // Start of a question.
    case 'u':
      asking_ = true;
      answer_.clear();
      return request_(question);
    // End and help.
    case 'q':
      control_.quit = true;
      return;
    case '?':
    case 'h':
      return report_(help());
    default:
      return;
  }
}

void RunKeys::answer(char key) {
  constexpr char escape = 27, backspace = 8, erase = 127;
  if (key == '\n' || key == '\r') {
    asking_ = false;
    double time_s = 0;
    const char* end = answer_.data() + answer_.size();
    const auto [at, error] = std::from_chars(answer_.data(), end, time_s);
    const bool number = error == std::errc{} && at == end;
    if (answer_.empty()) return report_("not");
    return report_(time_.execute("until", number ? "" : answer_, time_s).value_or(""));
  }
  if (key == escape) {
    asking_ = false;
    return report_("not");
  }
  if ((key == backspace || key == erase) && !answer_.empty())
    answer_.pop_back();
  else if (std::isprint(static_cast<unsigned char>(key)) != 0 && answer_.size() < 100)
    answer_ += key;
  request_(question + answer_);
}

void RunKeys::change_speed(double factor) {
  if (control_.speed <= 0 && factor > 1) return report_(run_state());
  const double speed = control_.speed <= 0 ? slower_than_most : control_.speed * factor;
  control_.set_speed(std::clamp(speed, slowest, fastest));
  report_(run_state());
}

std::string RunKeys::run_state() const {
  const std::string speed =
      control_.speed > 0 ? fmt::format("{:g} x real time", control_.speed) : "as fast as possible";
  return time_.place() + (control_.paused ? "; continues " : "; goes ") + speed;
}

}  // namespace experiment
