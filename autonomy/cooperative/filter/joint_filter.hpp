// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "autonomy/cooperative/estimator/estimator.hpp"
#include "autonomy/cooperative/estimator/payload.hpp"

namespace navigation {

/// Places of a vehicle's states in its part of the state vector; -1: the vehicle does not have it.
///
///     0, 1            east, north p (m)
///     heading_bias    b (rad), a constant or a random walk: true heading = measured heading + b + h
///     slow_heading    h (rad), a Gauss-Markov process
///     speed_scale     s: true velocity = (1 + s) * measured velocity
///     clock, drift    lead c of the own clock (m, times the speed of sound) and its gain d (m/s)
///     slow_fix        two Gauss-Markov errors g of a satellite fix (m)
struct StateLayout {
  int size = 2;
  int heading_bias = -1, slow_heading = -1, speed_scale = -1, clock = -1, drift = -1, slow_fix = -1;
};
StateLayout layout_of(const DeviceErrors& errors);

/// Extended Kalman filter of one or more vehicles, with copies of earlier states (delayed states).  Vehicles and copies
/// are called parts, and have numbers.  Updates are in Joseph form.
class JointFilter {
 public:
  enum class Outcome { used, refused };

  /// `sound_speed_mps` converts clocks to ranges; `gate`: see Setup.
  explicit JointFilter(double sound_speed_mps = 1500, double gate = 0)
      : sound_speed_mps_(sound_speed_mps), gate_(gate) {}

  /// Adds a vehicle, and returns its number.
  int add(const DeviceErrors& errors, Time time, const Vector2& p_W, double std_m);
  /// Adds a part with this position and covariance, independent of all others.
  int add(const Position& position);
  /// Adds a copy of a part's present position and clock, and returns its number.
  int copy(int part);
  /// Returns a filter of the parts of this one, and then those of another, which is independent.
  JointFilter joined_with(const JointFilter& other) const;
  /// Marginalizes a copy.  Its number may be used again.
  void remove(int part);

  /// Moves a vehicle with a measured velocity until `time`, with white noise q (m^2/s).  Both are in the axes of the
  /// measured heading, so that the heading error turns both.  An earlier time has no effect.
  ///
  ///     p' = p + (1 + s) R(b + h) v dt     dp/db = dp/dh = left((1 + s) R(b + h) v dt)     dp/ds = R(b + h) v dt
  ///     Q = R(b + h) q R(b + h)' dt
  ///     c' = c + d dt     h' = exp(-dt / T) h     g' = exp(-dt / T) g
  void move(int vehicle, Time time, const Vector2& v_W, const Matrix2& q);
  /// Returns the Jacobian of this motion, of all states.
  Eigen::MatrixXd jacobian(int vehicle, Time time, const Vector2& v_W) const;
  /// Moves a part by the linear motion p' = F p + offset + noise of covariance Q, for other models than that of move().
  void move_linear(int part, const Matrix2& F, const Vector2& offset, const Matrix2& Q);
  /// Updates with a satellite position.  One beyond the gate is refused, but after five in a row the covariance of the
  /// position grows by the innovation, and that one is used.  `kept`, if not null, becomes the I - K H of the
  /// update.
  Outcome fix(int vehicle, const Vector2& p_W, double std_m, Eigen::MatrixXd* kept = nullptr);

  /// Linearized range z = |(p_a - p_b, dz)| + c_a - c_b between two parts, or to a position outside of the filter.
  struct RangeRow {
    Eigen::VectorXd H;
    double predicted_m = 0;
    Vector2 u = Vector2::Zero();  ///< horizontal part of the unit vector from the other one
    double bend_variance_m2 = 0;  ///< second-order term of the range, 3 (m / 2r)^2, m = cross-range variance
  };
  RangeRow range_row(int own, int other, double dz_m) const;
  RangeRow range_row(int own, const Position& other, double dz_m) const;
  /// Updates with a range between two parts.
  Outcome range(int own, int other, double dz_m, double range_m, double std_m);
  /// Updates with a range to a position, whose error is regarded as independent; `more_variance_m2`: of its clock.
  Outcome range(int own, const Position& other, double dz_m, double range_m, double std_m, double more_variance_m2 = 0);

  /// Linearized measurement by a sensor: (horizontal range, bearing by the heading of the observer) of another part or
  /// a position.  A position has no heading error.  It is linearized at the displacement that positions and relative
  /// measurement give together, not at the predicted one, which may be wrong by more than the distance: the first
  /// iteration of an iterated filter (Bell and Cathey, IEEE Trans. Automatic Control 38(2), 1993).
  struct RelativeRow {
    Eigen::MatrixXd H;  ///< 2 rows
    Vector2 innovation = Vector2::Zero();
    Matrix2 J = Matrix2::Zero();  ///< derivative with respect to the other position
    /// Covariance of its error, with the terms of second order.  By the variances a along and s sideways of the
    /// relative position after the relative measurement they are 3 (s / 2r)^2 of the range, a s / r^4 of the bearing.
    Matrix2 R = Matrix2::Zero();
  };
  RelativeRow relative_row(int own, int other, const Relative& seen) const;
  RelativeRow relative_row(int own, const Position& other, const Relative& seen) const;
  /// Whether such a measurement, whose error has the covariance R + more, is finite and within the gate.
  bool within_gate(const RelativeRow& row, const Matrix2& more) const;
  /// Updates with it, unless it is beyond the gate.  Any number of refused ones in a row changes nothing: a sensor that
  /// takes one vehicle for another does so again and again.
  Outcome see(const RelativeRow& row, const Matrix2& more = Matrix2::Zero());

  /// Updates with a scalar measurement z = H x + noise.
  void update(const Eigen::VectorXd& H, double innovation, double R);
  /// Updates with several.  Returns I - K H.
  Eigen::MatrixXd update(const Eigen::MatrixXd& H, const Eigen::VectorXd& innovation, const Eigen::MatrixXd& R);
  /// Multiplies a part of the information into that of a position: information matrix L and vector about the position.
  void inform(int part, const Matrix2& L, const Vector2& eta);
  /// Whether an innovation is within the gate; of two numbers within that of the same probability, 99.9 %.
  bool within_gate(const Vector2& innovation, const Matrix2& S) const;
  bool within_gate(double innovation, double variance) const {
    return gate_ <= 0 || innovation * innovation <= gate_ * variance;
  }

  int size() const { return static_cast<int>(x_.size()); }
  const Eigen::VectorXd& x() const { return x_; }
  const Eigen::MatrixXd& P() const { return P_; }
  void set_P(const Eigen::MatrixXd& P) { P_ = P; }
  void set_x(const Eigen::VectorXd& x) { x_ = x; }
  const StateLayout& layout(int part) const { return at(part).layout; }
  int offset(int part) const { return at(part).offset; }

  Vector2 position(int part) const { return x_.segment<2>(at(part).offset); }
  Matrix2 covariance(int part) const { return P_.block<2, 2>(at(part).offset, at(part).offset); }
  Time time(int vehicle) const { return at(vehicle).time; }
  /// Returns the estimate of a vehicle shortly after its last motion.
  Estimate now(int vehicle, Time time) const;

 private:
  struct Part {
    StateLayout layout;
    int offset = 0;
    Time time = 0;
    Vector2 v_W = Vector2::Zero();
    DeviceErrors errors;
    int refused_fixes = 0;  ///< in a row
    bool in_use = true;
  };
  const Part& at(int part) const { return parts_[static_cast<std::size_t>(part)]; }
  Part& at(int part) { return parts_[static_cast<std::size_t>(part)]; }
  int add_part(const Part& part);
  /// Heading error b + h of a part.
  double heading_error(const Part& part) const;
  Vector2 corrected(const Part& part, const Vector2& v_W) const;
  /// `other`: its position, with the covariance of the relative one; `observer`: whose heading error counts, or null.
  RelativeRow relative_row(const Part& own, const Position& other, const Relative& seen, const Part* observer) const;
  static Matrix2 bend_of(const Vector2& d_W, const Matrix2& P);
  Outcome use_range(const RangeRow& row, double range_m, double variance_m2);
  /// Coefficients of the motion over some time.
  struct Step {
    double dt_s = 0, slow_heading_kept = 1, slow_fix_kept = 1;
    Vector2 moved_W = Vector2::Zero(), per_heading_W = Vector2::Zero(), per_scale_W = Vector2::Zero();
  };
  Step step_of(const Part& part, Time time, const Vector2& v_W) const;
  /// Applies the Jacobian to the lines of a matrix, its rows or its columns.
  template <class Line>
  static void apply(const Part& part, const Step& step, const Line& line);
  void symmetrize();

  double sound_speed_mps_;
  double gate_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd P_;
  std::vector<Part> parts_;
};

}  // namespace navigation
