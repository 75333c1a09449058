// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"
#include "autonomy/filters/ekf.hpp"

namespace navigation {

namespace {

using autonomy::Ekf;

/// Filter of the program `coop_rover` as a plug-in, for land vehicles: naive, with the error of the heading as its
/// third state, fixed errors of odometry, and a position without GPS that is not sent.
///
/// The program knows the heading of its odometry.  Here it is the direction of the measured motion: a turn on the spot
/// counts when the vehicle moves on, and a vehicle that goes backwards seems to have turned.
class CoopRoverFilter final : public EstimatorOf<CoopRoverFilter> {
 public:
  static constexpr const char* meaning =
      "filter of the program coop_rover, on land: naive; only vehicles with GPS send";
  static constexpr bool at_sea = false;

  void start(const Setup& setup) override {
    need_bytes(setup, "coop_rover", position_bytes);
    setup_ = setup;
    time_ = setup.time;
    p_W_ = setup.position_W;
    variance_m2_ = setup.position_std_m * setup.position_std_m;
  }
  void predict(Time time, const Vector2& v_W, const Matrix2&) override {
    const Vector2 moved_W = v_W * seconds(time - time_);
    time_ = time;
    v_W_ = v_W;
    if (!filter_) {
      // At rest there is no direction of motion yet, and the filter needs a heading.
      if (v_W.norm() < min_speed_mps) {
        p_W_ += moved_W;
        return;
      }
      direction_rad_ = std::atan2(v_W.y(), v_W.x());
      filter_.emplace(autonomy::Pose2{p_W_, direction_rad_}, std::sqrt(variance_m2_), setup_.errors().heading_bias_rad);
    }
    if (v_W.norm() >= min_speed_mps) {
      const double turn_rad = std::remainder(std::atan2(v_W.y(), v_W.x()) - direction_rad_, 2 * M_PI);
      direction_rad_ += turn_rad;
      filter_->predict({0, 0, turn_rad});
    }
    const Vector2 moved_B = autonomy::turned(moved_W, -direction_rad_);
    filter_->predict({moved_B.x(), moved_B.y(), 0});
  }
  void fix(Time, const Vector2& p_W, double std_m) override {
    const double accuracy_m = std::hypot(std_m, setup_.errors().slow_fix_m);
    fix_std_m_ = accuracy_m;
    if (filter_) {
      filter_->update_position(p_W, accuracy_m);
      return;
    }
    const double gain = variance_m2_ / (variance_m2_ + accuracy_m * accuracy_m);
    p_W_ += gain * (p_W - p_W_);
    variance_m2_ *= 1 - gain;
  }
  void on_range(const ReceivedRange&) override {}
  void on_bearing(const Relative& seen) override {
    const auto other = position_in(seen.payload);
    if (!other || !filter_ || seen.by_other) return;
    const double ahead_rad = seen.bearing_rad - direction_rad_;
    const Vector2 seen_B = seen.range_m * Vector2(std::cos(ahead_rad), std::sin(ahead_rad));
    filter_->update_relative(seen_B, seen.range_std_m, other->p_W, std::sqrt(0.5 * other->P.trace()));
  }
  Bytes make_payload(Time time, std::size_t) override {
    if (!fix_std_m_) return {};
    const Estimate estimate = now(time);
    // Slow errors of GPS do not average out.
    const double std_m = std::max(std::sqrt(0.5 * estimate.P.trace()), *fix_std_m_);
    return payload_of({estimate.p_W, std_m * std_m * Matrix2::Identity()});
  }
  Estimate now(Time time) const override {
    Estimate estimate;
    if (filter_) {
      estimate.heading_bias_rad = std::remainder(filter_->pose().yaw_rad - direction_rad_, 2 * M_PI);
      estimate.P = filter_->covariance().topLeftCorner<2, 2>();
    } else {
      estimate.P = variance_m2_ * Matrix2::Identity();
    }
    estimate.v_W = autonomy::turned(v_W_, estimate.heading_bias_rad);
    estimate.p_W = (filter_ ? filter_->pose().p_W : p_W_) + estimate.v_W * seconds(time - time_);
    return estimate;
  }

 private:
  /// The direction of a slower motion is that of its errors.
  static constexpr double min_speed_mps = 0.02;

  Setup setup_;
  Time time_ = 0;
  Vector2 v_W_ = Vector2::Zero();
  double direction_rad_ = 0;   ///< of the measured motion
  std::optional<Ekf> filter_;  ///< from the first motion on, which shows the direction
  Vector2 p_W_ = Vector2::Zero();
  double variance_m2_ = 0;  ///< of each coordinate; with the position, until there is a filter
  std::optional<double> fix_std_m_;
};

SHOAL_ESTIMATOR("coop_rover", CoopRoverFilter);

}  // namespace

}  // namespace navigation
