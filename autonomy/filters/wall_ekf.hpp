// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "autonomy/filters/chi_square.hpp"
#include "autonomy/filters/pose2.hpp"

namespace autonomy {

/// Known vertical wall, seen from above.
struct Wall {
  Vector2d from_W, to_W;
};

/// Returns the first wall that a horizontal ray meets, with its range; std::nullopt if it meets none.  A hit within
/// `margin_m` of the end of a wall counts as none: a wide beam may miss it.
struct WallHit {
  double range_m;
  Vector2d normal_W;  ///< towards the start of the ray
};
std::optional<WallHit> first_wall(const std::vector<Wall>& walls, const Vector2d& from_W, double direction_rad,
                                  double margin_m);

/// Extended Kalman filter of a vehicle with an IMU, a known speed through the water, and ranges to known walls.  Its
/// states are x = (east, north, b, current east, current north), with b the heading minus the integral of the gyro.
/// Prediction over dt, with the direction u of the heading, the slip w, and left(u) 90 degrees to its left:
///     p' = p + (v + c) dt,   v = s u + w left(u),   dp'/db = left(v) dt,   dp'/dc = dt
/// A range z along a beam at the angle a from the bow, of a sonar l ahead of the origin, to a wall n p = d:
///     h = (d - n (p + l u)) / (n v),   v: direction of the beam
///     dh/dp = -n / (n v),   dh/db = -(l n left(u) + h n left(v)) / (n v)
class WallEkf {
 public:
  struct Params {
    double speed_noise_mpsprtHz = 0.1;     ///< of the speed through the water
    double heading_noise_radprtHz = 1e-3;  ///< drift of the gyro
    double current_noise_mpsprtHz = 5e-3;
    double current_std_mps = 0.3;    ///< at the start
    double gate = chi_square_999_1;  ///< of a squared normalized innovation
  };
  using State = Eigen::Matrix<double, 5, 1>;
  using Covariance = Eigen::Matrix<double, 5, 5>;

  /// `heading_offset_rad`: heading minus the integral of the gyro.
  WallEkf(const Vector2d& p_W, double position_std_m, double heading_offset_rad, double heading_std_rad,
          const Params& params);

  /// `gyro_yaw_rad`: integral of the gyro; `slip_mps`: velocity through the water to the left.
  void predict(double dt_s, double gyro_yaw_rad, double speed_mps, double slip_mps = 0);
  void update_position(const Vector2d& p_W, double std_m);
  /// Returns whether it was used.  `beam_rad`: from the bow, counter-clockwise; `lever_m`: the sonar ahead of the
  /// origin.
  bool update_range(const std::vector<Wall>& walls, double gyro_yaw_rad, double beam_rad, double lever_m,
                    double range_m, double std_m);

  /// The current may have changed by this much.
  void loosen_current(double std_mps);

  Vector2d p_W() const { return x_.head<2>(); }
  double yaw_rad(double gyro_yaw_rad) const;
  Vector2d current_W() const { return x_.tail<2>(); }
  Eigen::Matrix2d position_covariance() const { return P_.topLeftCorner<2, 2>(); }
  double heading_std_rad() const;

 private:
  bool update(double innovation, const Eigen::Matrix<double, 1, 5>& H, double variance, bool gated);

  Params params_;
  State x_ = State::Zero();
  Covariance P_ = Covariance::Zero();
};

}  // namespace autonomy
