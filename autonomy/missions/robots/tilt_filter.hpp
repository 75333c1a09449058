// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

namespace autonomy {

/// Interval between the time stamps of successive messages.
class StampInterval {
 public:
  /// Takes the next stamp; `is_new` is false for a repeated or a slightly older message, which is not to be used.
  /// Returns the seconds since the previous one; none for the first, and when the clock jumped.
  std::optional<double> take(std::int64_t utime, bool& is_new);

 private:
  std::optional<std::int64_t> utime_ = {};
};

/// Tilt of a body in one plane, the fast part from a gyro and the slow part from an inclinometer, which errs while it
/// is accelerated.  The passive complementary filter with bias estimate of R. Mahony, T. Hamel and J.-M. Pflimlin,
/// "Nonlinear complementary filters on the special orthogonal group", IEEE Trans. Automatic Control 53(5), 2008, for
/// one angle, with both poles at -1 / T:
///
///     tilt' = rate - bias + 2 / T (measured - tilt),  bias' = -1 / T^2 (measured - tilt)
class TiltFilter {
 public:
  /// `time_constant_s`: T, above 0.
  explicit TiltFilter(double time_constant_s) : time_constant_s_(time_constant_s) {}
  /// Takes the mean rate over the interval that ends at `utime`.  Returns whether it is new.
  bool predict(std::int64_t utime, double rate_radps);
  /// Takes the tilt that the inclinometer measured; the first one is the initial tilt.
  void correct(std::int64_t utime, double tilt_rad);

  /// Whether both sensors have reported.
  bool known() const { return tilted_ && rated_; }
  double tilt_rad() const { return tilt_rad_; }
  /// The last rate, without its estimated bias.
  double rate_radps() const { return rate_radps_ - bias_radps_; }
  double bias_radps() const { return bias_radps_; }

 private:
  double time_constant_s_;
  StampInterval gyro_ = {}, inclinometer_ = {};
  bool tilted_ = false, rated_ = false;
  double tilt_rad_ = 0, rate_radps_ = 0, bias_radps_ = 0;
};

}  // namespace autonomy
