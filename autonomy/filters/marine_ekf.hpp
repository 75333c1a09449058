// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "autonomy/filters/chi_square.hpp"
#include "autonomy/filters/pose2.hpp"

namespace autonomy {

/// Extended Kalman filter of a submerged vehicle's horizontal position.  Its states, in this order:
///
///     0, 1  east, north (m)
///     2     heading bias b (rad): true heading = measured heading + b
///     3     speed scale s: true velocity = (1 + s) * measured velocity
///     4     range bias c (m): speed of sound times the lead of the own clock over the beacons' clocks
///     5     drift of c (m/s)
///
/// `states` of Params is the number of estimated states; the others stay 0.  Times are by the vehicle's own clock.  A
/// measurement may be older than the last prediction: a packet is complete seconds after its first sound.
class MarineEkf {
 public:
  static constexpr int max_states = 6;
  using State = Eigen::Matrix<double, max_states, 1>;
  using Covariance = Eigen::Matrix<double, max_states, max_states>;

  using Row = Eigen::Matrix<double, 1, max_states>;

  struct Params {
    int states = 4;  ///< 2, 4, 5 or 6
    // Initial standard deviations.
    double heading_bias_std_rad = 0.05;
    double speed_scale_std = 0.03;
    double range_bias_std_m = 30;
    double range_drift_std_mps = 0.005;
    // White noise, as the root of its density: variances grow with time.
    double heading_noise_radprtHz = 0.035;  ///< of the measured heading
    double speed_noise_mpsprtHz = 0.01;     ///< of the measured velocity
    // Random walks, after 1 s.
    double heading_bias_walk_rad = 1e-4;
    double speed_scale_walk = 1e-5;
    double range_bias_walk_m = 0.01;
    double range_drift_walk_mps = 1e-5;
    /// In a filter of two states the biases are modeled as noise that changes at this interval.
    double bias_as_noise_s = 60;

    double range_gate = chi_square_999_1;     ///< squared innovation over its variance
    double position_gate = chi_square_999_2;  ///< the same
    int max_refusals = 5;  ///< consecutive ones, before a state is considered wrong instead of the measurement
  };
  struct Range {
    int beacon = 0;          ///< identifier of the beacon
    std::int64_t utime = 0;  ///< of arrival, by the own clock
    double range_m = 0;      ///< slant range; below 0: the own clock is behind
    double std_m = 1;
    Eigen::Vector3d p_WS = Eigen::Vector3d::Zero();  ///< position of the beacon at the time of sending
    Eigen::Matrix2d beacon_covariance = Eigen::Matrix2d::Zero();
    double own_z_m = 0;  ///< known from pressure
  };
  enum class Outcome {
    accepted,
    refused,   ///< rejected by the gate, or its beacon is in doubt
    inflated,  ///< after max_refusals: the variance of the clock (a range) or of the position (GPS) was increased
    too_old,
  };

  MarineEkf(std::int64_t utime, const Vector2d& p_W, double position_std_m, const Params& params);

  /// Predicts to `utime` with a velocity over ground as DVL and compass measure it, in the axes of the world.
  /// `more_noise_mpsprtHz`: additional noise of a worse source of velocity.  A time that is not later has no effect.
  void predict(std::int64_t utime, const Vector2d& v_measured_W, double more_noise_mpsprtHz = 0);
  /// Updates with a GPS position.
  Outcome update_position(std::int64_t utime, const Vector2d& p_W, double std_m);
  /// Updates with a range.  A contradicting range never increases the uncertainty of the position: the clock is wrong
  /// when two or more beacons contradict by the same amount, or by one that grows linearly; otherwise the beacon, which
  /// is then in doubt until its ranges agree again for some time.  Ranges that were used with a wrong clock have
  /// corrupted the estimate: `without_ranges`, if given, is a filter of the same vehicle that used none, from which
  /// this one restarts.
  Outcome update_range(const Range& range, const MarineEkf* without_ranges = nullptr);

  /// Corrects for an adjustment of the own clock: the time `utime` becomes `utime + by_us`, and ranges are longer by
  /// `range_m`, with standard deviation `range_std_m`.
  void shift_clock(std::int64_t by_us, double range_m, double range_std_m);

  std::int64_t utime() const { return utime_; }
  Vector2d position() const { return x_.head<2>(); }
  Eigen::Matrix2d position_covariance() const { return P_.topLeftCorner<2, 2>(); }
  Vector2d velocity() const;
  /// Returns the position at a time near that of the filter, by the motion since then, or by its velocity.
  Vector2d position_at(std::int64_t utime) const;
  double heading_bias_rad() const { return x_[2]; }
  double speed_scale() const { return x_[3]; }
  double range_bias_m() const { return x_[4]; }
  const State& state() const { return x_; }
  const Covariance& covariance() const { return P_; }
  /// Squared innovation over its variance, of the last measurement.
  double last_nis() const { return last_nis_; }
  int accepted() const { return accepted_; }
  int refused() const { return refused_; }
  int inflated() const { return inflated_; }

 private:
  /// Distance traveled by the measured velocity, since the start.
  struct Mark {
    std::int64_t utime;
    Vector2d displacement_W;
  };
  /// Returns the measured displacement from `utime` to now; std::nullopt when that is too old.
  std::optional<Vector2d> distance_since(std::int64_t utime) const;
  /// Returns the estimated displacement that corresponds to a measured one.
  Vector2d corrected(const Vector2d& displacement_W) const;
  /// Returns the rows of the Jacobian of the position at an earlier time, with respect to the state now.
  Eigen::Matrix<double, 2, max_states> earlier_position_jacobian(const Vector2d& displacement_W) const;

  /// Confidence in a beacon.
  struct Trust {
    int refusals = 0;          ///< consecutive ones
    int agreements = 0;        ///< consecutive ones while it is in doubt
    double doubted_at_m2 = 0;  ///< variance of the innovation when the doubt started; 0: it is trusted
  };
  /// Range that the gate rejected.
  struct Contradiction {
    int beacon;
    std::int64_t utime;
    double innovation_m;
    double variance_m2;  ///< without the contribution of the clock states
  };
  /// Correction of the own clock's lead, and gains, in range.
  struct ClockError {
    double now_m = 0;
    double rate_mps = 0;
    double variance_m2 = 0;
  };
  enum class Opinion { agrees, agrees_in_doubt, contradicts, nonsense };

  Opinion opinion_of(int beacon, double innovation_m, double variance_m2);
  /// Returns the clock error that explains the last contradictions; nothing: the beacons may be at fault.
  std::optional<ClockError> error_behind(const Contradiction& last, bool can_restart);
  /// Returns the error common to all contradictions, when they are of two beacons or more.
  std::optional<ClockError> common_error() const;
  /// Handles the case that none of the last ranges of several beacons agrees, though some did before: the estimate from
  /// them is wrong, and the clock may be off by as much as the ranges are.
  std::optional<ClockError> error_besides_ranges() const;
  bool several_beacons_contradict() const;
  void open_clock(const ClockError& error);
  void take_motion_of(const MarineEkf& other);

  template <int n>
  void use(const Eigen::Matrix<double, n, 1>& innovation, const Eigen::Matrix<double, n, max_states>& H,
           const Eigen::Matrix<double, n, n>& R);

  Params params_;
  std::int64_t utime_;
  State x_ = State::Zero();
  Covariance P_ = Covariance::Zero();
  Vector2d v_measured_W_ = Vector2d::Zero();
  std::deque<Mark> marks_;
  int refused_positions_ = 0;                 ///< consecutive ones
  std::map<int, Trust> trust_;                ///< by beacon
  std::deque<Contradiction> contradictions_;  ///< since the last accepted range
  int ranges_used_ = 0;
  int accepted_ = 0;
  int refused_ = 0;
  int inflated_ = 0;
  double last_nis_ = 0;
};

}  // namespace autonomy
