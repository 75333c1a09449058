// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "autonomy/filters/chi_square.hpp"
#include "autonomy/filters/odometer.hpp"
#include "autonomy/filters/pose2.hpp"

namespace autonomy {

/// Extended Kalman filter of a rover's pose: state east, north, yaw.
class Ekf {
 public:
  struct Params {
    // The variances of odometry grow in proportion to the distance, so that a divided move has the error of the whole.
    double along_std_m = 0.03;             ///< of the distance after 1 m
    double across_std_m = 0.01;            ///< sideways slip after 1 m
    double yaw_per_turn_std_rad = 0.04;    ///< after a turn of 1 rad
    double yaw_per_meter_std_rad = 0.015;  ///< after 1 m
    double gate = chi_square_999_2;        ///< squared Mahalanobis distance
    int max_refusals = 10;                 ///< consecutive ones, before the estimate itself is considered wrong
  };

  Ekf(const Pose2& start, double position_std_m, double yaw_std_rad)
      : Ekf(start, position_std_m, yaw_std_rad, Params()) {}
  Ekf(const Pose2& start, double position_std_m, double yaw_std_rad, const Params& params);

  void predict(const Increment& move);
  /// Updates with a position in the world.  Returns false, without a change of the estimate, when the gate rejects it.
  bool update_position(const Vector2d& p_W, double std_m);
  /// Updates with the detection of another rover at `p_BN_B`, in the body frame, which reports its position `p_WN_W`.
  bool update_relative(const Vector2d& p_BN_B, double seen_std_m, const Vector2d& p_WN_W, double neighbor_std_m);

  const Pose2& pose() const { return pose_; }
  const Eigen::Matrix3d& covariance() const { return P_; }
  /// Returns the root of the mean of the variances of east and north.
  double position_std_m() const;

 private:
  using Jacobian = Eigen::Matrix<double, 2, 3>;
  bool update(const Vector2d& innovation, const Jacobian& H, const Eigen::Matrix2d& R);
  void count_refusal();

  Params params_;
  Pose2 pose_;
  Eigen::Matrix3d P_;
  int refusals_ = 0;
};

}  // namespace autonomy
