// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/filters/marine_ekf.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace autonomy {

namespace {

constexpr double max_memory_s = 60;
constexpr double bad_clock_mps = 0.15;  ///< 100 ppm, the worst error of common quartz clocks, times the speed of sound

}  // namespace

MarineEkf::MarineEkf(std::int64_t utime, const Vector2d& p_W, double position_std_m, const Params& params)
    : params_(params), utime_(utime) {
  if (params.states != 2 && (params.states < 4 || params.states > 6))
    throw std::invalid_argument("the filter has 2, 4, 5 or 6 states, not " + std::to_string(params.states));
  // Initial state and covariance.
  x_.head<2>() = p_W;
  P_.diagonal() << squared(position_std_m), squared(position_std_m), squared(params.heading_bias_std_rad),
      squared(params.speed_scale_std), squared(params.range_bias_std_m), squared(params.range_drift_std_mps);
  // A state without variance, noise and correlation is never changed.
  P_.diagonal().tail(max_states - params.states).setZero();
  marks_.push_back({utime, Vector2d::Zero()});
}

Vector2d MarineEkf::corrected(const Vector2d& displacement_W) const {
  return (1 + x_[3]) * turned(displacement_W, x_[2]);
}

Vector2d MarineEkf::velocity() const {
  return corrected(v_measured_W_);
}

void MarineEkf::predict(std::int64_t utime, const Vector2d& v_measured_W, double more_noise_mpsprtHz) {
  if (utime <= utime_ || !v_measured_W.allFinite()) return;
  // Jacobian of the motion.
  const double dt_s = seconds(utime - utime_);
  const Vector2d displacement_W = v_measured_W * dt_s;
  const Vector2d moved_W = corrected(displacement_W);
  Covariance F = Covariance::Identity();
  F.block<2, 1>(0, 2) = left_of(moved_W);
  F.block<2, 1>(0, 3) = turned(displacement_W, x_[2]);
  F(4, 5) = dt_s;

  // Process noise along and across the track.
  const double speed_mps = v_measured_W.norm();
  double along = squared(params_.speed_noise_mpsprtHz) + squared(more_noise_mpsprtHz);
  double across = squared(speed_mps * params_.heading_noise_radprtHz) + along;
  if (params_.states == 2) {
    along += squared(speed_mps * params_.speed_scale_std) * params_.bias_as_noise_s;
    across += squared(speed_mps * params_.heading_bias_std_rad) * params_.bias_as_noise_s;
  }
  Covariance Q = Covariance::Zero();
  const Vector2d ahead = speed_mps > 0 ? Vector2d(moved_W.normalized()) : Vector2d(1, 0);
  const Vector2d left = left_of(ahead);
  Q.topLeftCorner<2, 2>() = along * ahead * ahead.transpose() + across * left * left.transpose();
  const Eigen::Vector4d walks(params_.heading_bias_walk_rad, params_.speed_scale_walk, params_.range_bias_walk_m,
                              params_.range_drift_walk_mps);
  for (int i = 2; i < params_.states; ++i) Q(i, i) = squared(walks[i - 2]);

  // Prediction of state and covariance (extended Kalman filter).
  x_.head<2>() += moved_W;
  x_[4] += x_[5] * dt_s;
  P_ = F * P_ * F.transpose() + Q * dt_s;
  v_measured_W_ = v_measured_W;
  utime_ = utime;
  // History of displacements for late measurements.
  marks_.push_back({utime, marks_.back().displacement_W + displacement_W});
  while (seconds(utime - marks_[1].utime) > max_memory_s) marks_.pop_front();
}

void MarineEkf::shift_clock(std::int64_t by_us, double range_m, double range_std_m) {
  utime_ += by_us;
  for (Mark& mark : marks_) mark.utime += by_us;
  trust_.clear();  // the beacons may have been correct
  contradictions_.clear();
  if (params_.states <= 4) return;
  x_[4] += range_m;
  P_.row(4).setZero();
  P_.col(4).setZero();
  P_(4, 4) = squared(range_std_m);
}

std::optional<Vector2d> MarineEkf::distance_since(std::int64_t utime) const {
  if (utime >= utime_) return Vector2d(-v_measured_W_ * seconds(utime - utime_));
  if (utime < marks_.front().utime) return std::nullopt;
  const auto after = std::upper_bound(marks_.begin(), marks_.end(), utime,
                                      [](std::int64_t time, const Mark& mark) { return time < mark.utime; });
  const auto before = std::prev(after);
  const double part = seconds(utime - before->utime) / seconds(after->utime - before->utime);
  return Vector2d(marks_.back().displacement_W - before->displacement_W -
                  part * (after->displacement_W - before->displacement_W));
}

Vector2d MarineEkf::position_at(std::int64_t utime) const {
  const auto displacement_W = distance_since(std::max(utime, marks_.front().utime));
  return position() - corrected(*displacement_W);
}

Eigen::Matrix<double, 2, MarineEkf::max_states> MarineEkf::earlier_position_jacobian(
    const Vector2d& displacement_W) const {
  Eigen::Matrix<double, 2, max_states> J = Eigen::Matrix<double, 2, max_states>::Zero();
  J.leftCols<2>().setIdentity();
  J.col(2) = -left_of(corrected(displacement_W));
  J.col(3) = -turned(displacement_W, x_[2]);
  return J;
}

MarineEkf::Outcome MarineEkf::update_position(std::int64_t utime, const Vector2d& p_W, double std_m) {
  const auto displacement_W = distance_since(utime);
  if (!displacement_W) return Outcome::too_old;
  // Innovation and its normalized square.
  const Vector2d innovation = p_W - (position() - corrected(*displacement_W));
  const Eigen::Matrix<double, 2, max_states> H = earlier_position_jacobian(*displacement_W);
  const Eigen::Matrix2d R = squared(std_m) * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d S = H * P_ * H.transpose() + R;
  last_nis_ = innovation.dot(S.inverse() * innovation);
  Outcome outcome = Outcome::accepted;
  // This comparison also rejects NaN.
  if (!(last_nis_ <= params_.position_gate)) {
    ++refused_;
    if (!innovation.allFinite() || ++refused_positions_ < params_.max_refusals) return Outcome::refused;
    // Consecutive rejections are not outliers: an overconfident filter would reject forever.
    P_.topLeftCorner<2, 2>() += innovation.squaredNorm() * Eigen::Matrix2d::Identity();
    ++inflated_;
    outcome = Outcome::inflated;
  }
  refused_positions_ = 0;
  use<2>(innovation, H, R);
  return outcome;
}

MarineEkf::Outcome MarineEkf::update_range(const Range& range, const MarineEkf* without_ranges) {
  const auto displacement_W = distance_since(range.utime);
  if (!displacement_W) return Outcome::too_old;
  // Predicted range and direction at the time of arrival.
  const Vector2d then_W = position() - corrected(*displacement_W);
  const Vector2d d_W = then_W - range.p_WS.head<2>();
  const double distance_m = std::hypot(d_W.x(), d_W.y(), range.own_z_m - range.p_WS.z());
  const Vector2d u = d_W / std::max(distance_m, 1.0);  // horizontal part of the unit vector in space
  const double since_s = seconds(utime_ - range.utime);

  // Jacobian of the range.
  Row H = u.transpose() * earlier_position_jacobian(*displacement_W);
  const double position_variance = H * P_ * H.transpose();
  H(0, 4) = 1;
  H(0, 5) = -since_s;

  // Points of equal range lie on a circle, not on a line: an error q sideways makes the range longer by q^2 / 2r, whose
  // mean square is 3 (variance / 2r)^2.
  const Eigen::Matrix2d P = position_covariance();
  const double sideways_m2 = std::max(0.0, P.trace() - u.dot(P * u));
  const double bend_m = sideways_m2 / (2 * std::max(distance_m, 1.0));
  const double R = squared(range.std_m) + u.dot(range.beacon_covariance * u) + 3 * squared(bend_m);
  double innovation_m = range.range_m - (distance_m + x_[4] - x_[5] * since_s);
  const double S = H * P_ * H.transpose() + R;
  last_nis_ = squared(innovation_m) / S;

  // Gate, and the search for the cause of a contradiction.
  const Opinion opinion = std::isfinite(last_nis_) ? opinion_of(range.beacon, innovation_m, S) : Opinion::nonsense;
  Outcome outcome = Outcome::accepted;
  if (opinion != Opinion::agrees) {
    ++refused_;
    if (opinion != Opinion::contradicts) return Outcome::refused;
    const auto error =
        error_behind({range.beacon, range.utime, innovation_m, position_variance + R}, without_ranges != nullptr);
    if (!error) return Outcome::refused;
    open_clock(*error);
    outcome = Outcome::inflated;
    if (without_ranges != nullptr) {
      take_motion_of(*without_ranges);
      return outcome;  // the next range is processed from there
    }
    innovation_m -= error->now_m;
  }
  contradictions_.clear();
  ++ranges_used_;
  using One = Eigen::Matrix<double, 1, 1>;
  use<1>(One(innovation_m), H, One(R));
  return outcome;
}

MarineEkf::Opinion MarineEkf::opinion_of(int beacon, double innovation_m, double variance_m2) {
  Trust& trust = trust_[beacon];
  // A filter without other messages becomes uncertain, which does not make a contradicting beacon trustworthy.
  const bool in_doubt = trust.doubted_at_m2 > 0;
  const double variance_now_m2 = in_doubt ? std::min(variance_m2, trust.doubted_at_m2) : variance_m2;
  if (squared(innovation_m) > params_.range_gate * variance_now_m2) {
    trust.agreements = 0;
    if (++trust.refusals >= params_.max_refusals && !in_doubt) trust.doubted_at_m2 = variance_m2;
    return Opinion::contradicts;
  }
  trust.refusals = 0;
  if (in_doubt && ++trust.agreements < params_.max_refusals) return Opinion::agrees_in_doubt;
  trust = {};
  return Opinion::agrees;
}

std::optional<MarineEkf::ClockError> MarineEkf::error_behind(const Contradiction& last, bool can_restart) {
  contradictions_.push_back(last);
  if (contradictions_.size() > 2 * static_cast<std::size_t>(params_.max_refusals)) contradictions_.pop_front();
  auto error = common_error();
  return error || !can_restart ? error : error_besides_ranges();
}

bool MarineEkf::several_beacons_contradict() const {
  return std::any_of(contradictions_.begin(), contradictions_.end(),
                     [&](const Contradiction& each) { return each.beacon != contradictions_.front().beacon; });
}

std::optional<MarineEkf::ClockError> MarineEkf::error_besides_ranges() const {
  const auto many = 2 * static_cast<std::size_t>(params_.max_refusals);
  if (ranges_used_ == 0 || contradictions_.size() < many || !several_beacons_contradict()) return std::nullopt;
  ClockError error;
  for (const Contradiction& each : contradictions_)
    error.variance_m2 = std::max(error.variance_m2, squared(each.innovation_m));
  return error;
}

std::optional<MarineEkf::ClockError> MarineEkf::common_error() const {
  const auto& all = contradictions_;
  if (params_.states <= 4 || all.size() < static_cast<std::size_t>(params_.max_refusals) ||
      !several_beacons_contradict())
    return std::nullopt;
  // Weighted straight line through them, over the time before the last one.
  double w = 0, wt = 0, wtt = 0, we = 0, wte = 0;
  const auto since_last_s = [&](const Contradiction& each) { return seconds(each.utime - all.back().utime); };
  for (const Contradiction& each : all) {
    const double weight = 1 / each.variance_m2;
    const double t_s = since_last_s(each);
    w += weight;
    wt += weight * t_s;
    wtt += weight * t_s * t_s;
    we += weight * each.innovation_m;
    wte += weight * t_s * each.innovation_m;
  }
  // Constant error, or one that grows linearly if its rate is significant.
  ClockError error{we / w, 0, 1 / w};
  const double spread = wtt - wt * wt / w;  // its inverse is the variance of the rate
  const double rate_mps = spread > 0 ? (wte - wt * we / w) / spread : 0;
  if (params_.states > 5 && squared(rate_mps) * spread > params_.range_gate)
    error = {(we - rate_mps * wt) / w, rate_mps, 1 / w + squared(wt / w) / spread};
  // Check that all contradictions agree with it.
  const bool agreed = std::all_of(all.begin(), all.end(), [&](const Contradiction& each) {
    const double expected_m = error.now_m + error.rate_mps * since_last_s(each);
    return squared(each.innovation_m - expected_m) <= params_.range_gate * each.variance_m2;
  });
  return agreed ? std::optional(error) : std::nullopt;
}

void MarineEkf::open_clock(const ClockError& error) {
  ++inflated_;
  trust_.clear();
  contradictions_.clear();
  if (params_.states <= 4) return;
  x_[4] += error.now_m;
  x_[5] += error.rate_mps;
  for (const int i : {4, 5}) {
    const double variance = P_(i, i);
    P_.row(i).setZero();
    P_.col(i).setZero();
    P_(i, i) = variance;
  }
  P_(4, 4) = squared(error.now_m) + error.variance_m2;
  if (params_.states <= 5) return;
  P_(5, 5) = std::max(P_(5, 5), squared(error.rate_mps));
  // Earlier ranges fitted, so the clock must drift.
  if (ranges_used_ > 0) P_(5, 5) = std::max(P_(5, 5), squared(bad_clock_mps));
}

void MarineEkf::take_motion_of(const MarineEkf& other) {
  x_.head<4>() = other.x_.head<4>();
  P_.topRows<4>().setZero();
  P_.leftCols<4>().setZero();
  P_.topLeftCorner<4, 4>() = other.P_.topLeftCorner<4, 4>();
  ranges_used_ = 0;
}

template <int n>
void MarineEkf::use(const Eigen::Matrix<double, n, 1>& innovation, const Eigen::Matrix<double, n, max_states>& H,
                    const Eigen::Matrix<double, n, n>& R) {
  ++accepted_;
  const Eigen::Matrix<double, n, n> S = H * P_ * H.transpose() + R;
  const Eigen::Matrix<double, max_states, n> K = P_ * H.transpose() * S.inverse();
  x_ += K * innovation;
  // Joseph form of the covariance, which remains symmetric and positive under rounding.
  const Covariance A = Covariance::Identity() - K * H;
  P_ = A * P_ * A.transpose() + K * R * K.transpose();
}

}  // namespace autonomy
