// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/servo_overload.hpp"

#include <algorithm>

namespace devices {

namespace {
constexpr int parts_of_window = 60;
constexpr double rounding_s = 1e-9;  // of a sum of steps
}  // namespace

void ServoOverload::Params::read(sim::ParamReader& in) {
  in.read("share", share, sim::above_to(0, 1), "mean of the effort over the largest effort, above which it is off");
  in.read("window_s", window_s, sim::above_to(0, 3600), "time over which the mean is taken");
}

double ServoOverload::time_s() const {
  double time_s = 0;
  for (const Part& part : parts_) time_s += part.time_s;
  return time_s;
}

bool ServoOverload::add(const Params& params, double share, double step_s) {
  if (off_) return false;
  if (parts_.empty() || parts_.back().time_s >= params.window_s / parts_of_window - rounding_s) parts_.emplace_back();
  parts_.back().share_s += share * step_s;
  parts_.back().time_s += step_s;
  // Remove what is older than the window.
  const double all_s = time_s();
  double older_s = all_s - params.window_s;
  while (older_s >= parts_.front().time_s - rounding_s && parts_.size() > 1) {
    older_s -= parts_.front().time_s;
    parts_.erase(parts_.begin());
  }
  off_ = all_s >= params.window_s - rounding_s && mean_share(params) > params.share;
  return off_;
}

double ServoOverload::mean_share(const Params& params) const {
  if (parts_.empty()) return 0;
  const Part& oldest = parts_.front();
  double share_s = 0;
  for (const Part& part : parts_) share_s += part.share_s;
  // Count the part of the oldest one that is in the window.
  const double older_s = std::clamp(time_s() - params.window_s, 0.0, oldest.time_s);
  share_s -= oldest.share_s * older_s / oldest.time_s;
  return share_s / params.window_s;
}

void ServoOverload::reset() {
  parts_.clear();
  off_ = false;
}

void ServoOverload::Part::visit_state(sim::StateArchive& archive) {
  archive(share_s, time_s);
  archive.require(share_s, 0, sim::StateArchive::max_number, "the effort of a servo's window");
  archive.require(time_s, 1e-7, 3601, "the time of a servo's window");
}

void ServoOverload::visit_state(sim::StateArchive& archive) {
  archive(parts_, off_);
  if (archive.restoring() && parts_.size() > parts_of_window + 2) archive.fail("the window of a servo is too long");
}

}  // namespace devices
