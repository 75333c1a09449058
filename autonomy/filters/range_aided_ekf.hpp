// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "autonomy/filters/marine_ekf.hpp"

namespace autonomy {

/// Filter of a vehicle that uses ranges, with its dead reckoning: a second filter with the same start, motions and
/// fixes, but no ranges, from which the first one restarts when ranges have corrupted it (MarineEkf::update_range()).
class RangeAidedEkf {
 public:
  /// Parameters and errors are those of MarineEkf, here and below.
  RangeAidedEkf(std::int64_t utime, const Vector2d& p_W, double position_std_m, const MarineEkf::Params& params)
      : with_ranges_(utime, p_W, position_std_m, params), without_ranges_(with_ranges_) {}

  void predict(std::int64_t utime, const Vector2d& v_measured_W, double more_noise_mpsprtHz) {
    for (MarineEkf* filter : {&with_ranges_, &without_ranges_})
      filter->predict(utime, v_measured_W, more_noise_mpsprtHz);
  }
  void update_position(std::int64_t utime, const Vector2d& p_W, double std_m) {
    for (MarineEkf* filter : {&with_ranges_, &without_ranges_}) filter->update_position(utime, p_W, std_m);
  }
  /// Returns whether the range changed the estimate.
  bool update_range(const MarineEkf::Range& range) {
    const MarineEkf::Outcome outcome = with_ranges_.update_range(range, &without_ranges_);
    return outcome == MarineEkf::Outcome::accepted || outcome == MarineEkf::Outcome::inflated;
  }
  void shift_clock(std::int64_t by_us, double range_m, double range_std_m) {
    for (MarineEkf* filter : {&with_ranges_, &without_ranges_}) filter->shift_clock(by_us, range_m, range_std_m);
  }

  const MarineEkf& with_ranges() const { return with_ranges_; }
  const MarineEkf& without_ranges() const { return without_ranges_; }

 private:
  MarineEkf with_ranges_, without_ranges_;
};

}  // namespace autonomy
