// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/tilt_filter.hpp"

#include <algorithm>

namespace autonomy {

namespace {

/// Maximum lead of a message; a later one belongs to another clock.
constexpr double max_late_s = 0.1;
/// Maximum interval between messages whose difference is used.
constexpr double max_gap_s = 1;

}  // namespace

std::optional<double> StampInterval::take(std::int64_t utime, bool& is_new) {
  // Floating point, because the difference of two integers may overflow.
  const std::optional<std::int64_t> before = utime_;
  const double dt_s = before ? (static_cast<double>(utime) - static_cast<double>(*before)) * 1e-6 : max_gap_s;
  is_new = dt_s > 0 || dt_s <= -max_late_s;
  if (is_new) utime_ = utime;
  return dt_s > 0 && dt_s < max_gap_s ? std::optional(dt_s) : std::nullopt;
}

bool TiltFilter::predict(std::int64_t utime, double rate_radps) {
  bool is_new = false;
  const auto dt_s = gyro_.take(utime, is_new);
  if (!is_new) return false;
  rate_radps_ = rate_radps;
  rated_ = true;
  if (dt_s && tilted_) tilt_rad_ += *dt_s * this->rate_radps();
  return true;
}

void TiltFilter::correct(std::int64_t utime, double tilt_rad) {
  bool is_new = false;
  const auto dt_s = inclinometer_.take(utime, is_new);
  if (!is_new) return;
  if (!tilted_) tilt_rad_ = tilt_rad;
  tilted_ = true;
  if (!dt_s) return;
  const double error_rad = tilt_rad - tilt_rad_, share = *dt_s / time_constant_s_;
  bias_radps_ -= share / time_constant_s_ * error_rad;
  tilt_rad_ += std::min(2 * share, 1.0) * error_rad;
}

}  // namespace autonomy
