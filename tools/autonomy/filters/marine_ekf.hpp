// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "tools/autonomy/filters/pose2.hpp"

namespace autonomy {

/// Extended Kalman filter of a submerged vehicle's horizontal position.  Its states, in this order:
///
///     0, 1  east, north (m)
///     2     heading bias b (rad): true heading = measured heading + b
///     3     speed scale s: true velocity = (1 + s) * measured velocity
///     4     range bias c (m): speed of sound times how far the own clock is ahead of the beacons'
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
    // At the start, one sigma.
    double heading_bias_std_rad = 0.05;
    double speed_scale_std = 0.03;
    double range_bias_std_m = 30;
    double range_drift_std_mps = 0.005;
    // White noise, by the root of its density: variances grow with time.
    double heading_noise_radprtHz = 0.035;  ///< of the measured heading
    double speed_noise_mpsprtHz = 0.01;     ///< of the measured velocity
    // Random walks, after 1 s.
    double heading_bias_walk_rad = 1e-4;
    double speed_scale_walk = 1e-5;
    double range_bias_walk_m = 0.01;
    double range_drift_walk_mps = 1e-5;
    /// With two states the biases are taken for noise that changes every so many seconds.
    double bias_as_noise_s = 60;

    double range_gate = 10.83;     ///< innovation squared over its variance: 99.9 % of chi-square with 1 degree
    double position_gate = 13.82;  ///< the same with 2 degrees
    int max_refusals = 5;          ///< in a row, before something is held to be wrong, and not only a measurement
  };
  struct Range {
    int beacon = 0;          ///< whose
    std::int64_t utime = 0;  ///< of arrival, by the own clock
    double range_m = 0;      ///< slant; below 0: the own clock is behind
    double std_m = 1;
    Eigen::Vector3d p_WS = Eigen::Vector3d::Zero();  ///< where the beacon was when it sent
    Eigen::Matrix2d beacon_covariance = Eigen::Matrix2d::Zero();
    double own_z_m = 0;  ///< known by pressure
  };
  enum class Outcome {
    accepted,
    refused,   ///< the gate did not let it through, or its beacon is in doubt
    inflated,  ///< refused once too often: the variance of the clock (a range) or of the position (GPS) was opened
    too_old,
  };

  MarineEkf(std::int64_t utime, const Vector2d& p_W, double position_std_m, const Params& params);

  /// Moves on to `utime` with a velocity over ground as DVL and compass measure it, in the axes of the world.
  /// `more_noise_mpsprtHz`: what a worse source of velocity adds.  A time that is not later has no effect.
  void predict(std::int64_t utime, const Vector2d& v_measured_W, double more_noise_mpsprtHz = 0);
  /// A position by GPS.
  Outcome update_position(std::int64_t utime, const Vector2d& p_W, double std_m);
  /// A contradicting range never increases the uncertainty of the position: the clock is wrong when two or more
  /// beacons contradict by the same amount, or by one that grows linearly; otherwise the beacon, which is then in
  /// doubt until it has agreed again for a while.  Ranges that were used with a wrong clock have taught wrong things:
  /// `without_ranges`, when it is given, is a filter of the same vehicle that used none, and from which this one starts
  /// again.
  Outcome update_range(const Range& range, const MarineEkf* without_ranges = nullptr);

  /// The own clock was set: what was at `utime` is now at `utime + by_us`, and ranges are longer by `range_m`, which is
  /// known to `range_std_m`.
  void shift_clock(std::int64_t by_us, double range_m, double range_std_m);

  std::int64_t utime() const { return utime_; }
  Vector2d position() const { return x_.head<2>(); }
  Eigen::Matrix2d position_covariance() const { return P_.topLeftCorner<2, 2>(); }
  Vector2d velocity() const;
  /// Where it was or will be at a time near to that of the filter: by the way it made since, or by its velocity.
  Vector2d position_at(std::int64_t utime) const;
  double heading_bias_rad() const { return x_[2]; }
  double speed_scale() const { return x_[3]; }
  double range_bias_m() const { return x_[4]; }
  const State& state() const { return x_; }
  const Covariance& covariance() const { return P_; }
  /// Innovation squared over its variance, of the last measurement that was looked at.
  double last_nis() const { return last_nis_; }
  int accepted() const { return accepted_; }
  int refused() const { return refused_; }
  int inflated() const { return inflated_; }

 private:
  /// Way made by the measured velocity, since the beginning.
  struct Mark {
    std::int64_t utime;
    Vector2d displacement_W;
  };
  /// Measured way from `utime` to now.  Nothing when that is too old.
  std::optional<Vector2d> distance_since(std::int64_t utime) const;
  /// The estimated displacement that corresponds to a measured one.
  Vector2d corrected(const Vector2d& displacement_W) const;
  /// Rows of the derivative of the position at an earlier time, by the state now.
  Eigen::Matrix<double, 2, max_states> earlier_position_jacobian(const Vector2d& displacement_W) const;

  /// What is known of a beacon.
  struct Trust {
    int refusals = 0;          ///< in a row
    int agreements = 0;        ///< in a row while it is in doubt
    double doubted_at_m2 = 0;  ///< variance of the innovation when its doubt began; 0: it is trusted
  };
  /// A range that did not fit.
  struct Contradiction {
    int beacon;
    std::int64_t utime;
    double innovation_m;
    double variance_m2;  ///< without what the clock's states add
  };
  /// Correction of the own clock's lead, and gains, in range.
  struct ClockError {
    double now_m = 0;
    double rate_mps = 0;
    double variance_m2 = 0;
  };
  enum class Opinion { agrees, agrees_in_doubt, contradicts, nonsense };

  Opinion opinion_of(int beacon, double innovation_m, double variance_m2);
  /// Clock error that explains the last contradictions; nothing: the beacons may be at fault.
  std::optional<ClockError> error_behind(const Contradiction& last, bool can_restart);
  /// What all contradictions say alike, when they are of two beacons or more.
  std::optional<ClockError> common_error() const;
  /// When none of the last ranges of several beacons fits, though some did before: what those have taught is wrong.
  /// The clock may be off by as much as the ranges are.
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
  int refused_positions_ = 0;                 ///< in a row
  std::map<int, Trust> trust_;                ///< by beacon
  std::deque<Contradiction> contradictions_;  ///< since the last range that fitted
  int ranges_used_ = 0;
  int accepted_ = 0;
  int refused_ = 0;
  int inflated_ = 0;
  double last_nis_ = 0;
};

}  // namespace autonomy
