// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"
#include "autonomy/filters/range_aided_ekf.hpp"

namespace navigation {

namespace {

using autonomy::MarineEkf;

/// Filter of the program `coop_auv` as a plug-in: naive, but it doubts a beacon whose ranges contradict, and finds the
/// error of the own clock behind contradictions of several beacons.  Slow errors of heading are a random walk of the
/// bias with the same initial growth, and those of fixes are not modeled.  autonomy::CoopAuv says what differs in front
/// of the filter.
class CoopAuvFilter final : public EstimatorOf<CoopAuvFilter> {
 public:
  static constexpr const char* meaning =
      "filter of the program coop_auv: naive, with tests for faulty beacons and clocks";

  void start(const Setup& setup) override {
    need_bytes(setup, "coop_auv", position_bytes);
    setup_ = setup;
    filter_.emplace(setup.time, setup.position_W, setup.position_std_m, params_of(setup));
  }
  void predict(Time time, const Vector2& v_W, const Matrix2& q) override {
    filter_->predict(time, v_W, std::sqrt(0.5 * q.trace()));
  }
  void fix(Time time, const Vector2& p_W, double std_m) override { filter_->update_position(time, p_W, std_m); }
  void on_range(const ReceivedRange& received) override {
    const auto sender = position_in(received.payload);
    if (!sender) return;
    const double clock_m2 = sender_clock_variance_m2(setup_, received.sender, received.toa - setup_.time);
    MarineEkf::Range range;
    range.beacon = received.sender;
    range.utime = received.toa;
    range.range_m = received.range_m;
    range.std_m = std::sqrt(received.std_m * received.std_m + clock_m2);
    range.p_WS << sender->p_W, received.sender_z_m;
    range.beacon_covariance = sender->P;
    range.own_z_m = received.own_z_m;
    filter_->update_range(range);
  }
  Bytes make_payload(Time time, std::size_t) override {
    const Estimate estimate = now(time);
    return payload_of({estimate.p_W, estimate.P});
  }
  Estimate now(Time time) const override {
    const MarineEkf& filter = filter_->with_ranges();
    Estimate estimate;
    estimate.p_W = filter.position_at(time);
    estimate.P = filter.position_covariance();
    estimate.v_W = filter.velocity();
    estimate.heading_bias_rad = filter.heading_bias_rad();
    estimate.clock_error_s = filter.range_bias_m() / setup_.sound_speed_mps;
    return estimate;
  }

 private:
  static MarineEkf::Params params_of(const Setup& setup) {
    constexpr double no_gate = 1e12;
    const DeviceErrors& errors = setup.errors();
    const double c = setup.sound_speed_mps;
    MarineEkf::Params params;
    params.states = errors.clock_drift > 0 ? 6 : errors.clock_s > 0 || errors.clock_walk_srts > 0 ? 5 : 4;
    params.heading_bias_std_rad = std::hypot(errors.heading_bias_rad, errors.slow_heading_rad);
    params.heading_bias_walk_rad =
        std::hypot(errors.heading_walk_radprts, errors.slow_heading_rad * std::sqrt(2 / errors.slow_heading_time_s));
    params.speed_scale_std = errors.speed_scale;
    params.speed_scale_walk = 0;
    params.range_bias_std_m = c * errors.clock_s;
    params.range_bias_walk_m = c * errors.clock_walk_srts;
    params.range_drift_std_mps = c * errors.clock_drift;
    params.range_drift_walk_mps = 0;
    params.heading_noise_radprtHz = params.speed_noise_mpsprtHz = 0;  // they come with each motion
    params.range_gate = setup.gate > 0 ? setup.gate : no_gate;
    if (setup.gate <= 0) params.position_gate = no_gate;
    return params;
  }

  Setup setup_;
  std::optional<autonomy::RangeAidedEkf> filter_;
};

SHOAL_ESTIMATOR("coop_auv", CoopAuvFilter);

}  // namespace

}  // namespace navigation
