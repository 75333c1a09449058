// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/record_line.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <numbers>

#include "motion/analysis/motion_tracking.hpp"
#include "sim/base/text_layout.hpp"
#include "tools/shoal/motion/motion_commands.hpp"

namespace tools {

namespace {

constexpr double safe_margin_m = 0.01;
constexpr std::size_t max_columns = 100;

}  // namespace

RecordLine::RecordLine(bool is_shown, bool shows_set, std::string file)
    : is_shown_(is_shown && isatty(STDERR_FILENO) != 0), shows_set_(shows_set), file_(std::move(file)) {}

void RecordLine::end() {
  if (has_line_) std::cerr << '\n';
  has_line_ = false;
}

void RecordLine::show(motion::MotionRecorder& recorder, const motion::JointCommands& commands,
                      const std::vector<double>& velocities, bool is_paused) {
  const auto now = std::chrono::steady_clock::now();
  if (!is_shown_ || now < next_) return;
  // Ten times a second: more would only cost time on a slow terminal.
  next_ = now + std::chrono::milliseconds(100);
  std::string line = fmt::format("{:8.2f} s  {}  ", recorder.now_s(),
                                 is_paused                 ? "paused   "
                                 : recorder.is_recording() ? "recording"
                                                           : "playing  ");
  const std::optional<experiment::Support> support = recorder.stage().support();
  // Colors are added after the line is cut, since they take no columns.
  const std::size_t margin_at = line.size();
  const std::string margin = margin_text(support);
  line += margin;
  if (recorder.over_end_s() && recorder.now_s() > *recorder.over_end_s() + recorder.frame_s() / 2)
    line += fmt::format("  past the end of {}: {:.1f} s", file_, *recorder.over_end_s());
  if (commands.speed() != 1) line += fmt::format("  speed {:.2f}", commands.speed());
  if (shows_set_ && !commands.set().empty()) line += "  set " + commands.set();
  line = sim::cut_to(line + joints_text(recorder, velocities), max_columns);
  if (support && support->static_margin_m < safe_margin_m && sim::may_use_color(STDERR_FILENO))
    line.replace(margin_at, margin.size(), "\x1b[31m" + margin + "\x1b[39m");
  std::cerr << "\r\x1b[K" << line << std::flush;
  has_line_ = true;
}

std::string RecordLine::joints_text(motion::MotionRecorder& recorder, const std::vector<double>& velocities) const {
  std::string text;
  const std::vector<std::string>& sliders = recorder.settings().sliders;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    if (velocities[i] == 0) continue;
    const std::string& joint = recorder.joints()[i];
    const bool is_slider = std::find(sliders.begin(), sliders.end(), joint) != sliders.end();
    const double value = recorder.set_points()[i];
    text += is_slider ? fmt::format("  {} {:+.3f} m", joint, value)
                      : fmt::format("  {} {:+.1f}", joint, value * 180 / std::numbers::pi);
    if (recorder.is_at_limit(i)) text += " limit";
  }
  if (motion::tilt_rad(recorder.stage().vehicle()) > motion::fallen_rad) text += "  fallen";
  return text;
}

std::string margin_text(const std::optional<experiment::Support>& support) {
  return support ? fmt::format("static {:.0f} mm", support->static_margin_m * mm) : "no support";
}

std::string push_text(const motion::PushMargin& margin, double at_s) {
  constexpr std::array names{"ahead", "ahead left", "left",  "back left",
                             "back",  "back right", "right", "ahead right"};  // counter-clockwise
  const auto impulse = [&](double mps) {
    return fmt::format("{}{:.2f}", mps >= motion::PushOptions{}.greatest_mps ? ">" : "", mps * margin.mass_kg);
  };
  std::string text = fmt::format("withstands pushes at {:.2f} s, N s:", at_s);
  std::size_t worst = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += fmt::format(" {} {}{}", names[i], impulse(margin.withstood_mps[i]), i + 1 < names.size() ? "," : "");
    if (margin.withstood_mps[i] < margin.withstood_mps[worst]) worst = i;
  }
  return text + fmt::format("; least {} {}", impulse(margin.withstood_mps[worst]), names[worst]);
}

}  // namespace tools
