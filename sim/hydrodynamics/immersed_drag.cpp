// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/immersed_drag.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Skin friction: below this speed drag is linear instead of quadratic, so that oscillations decay.
constexpr double slow_mps = 0.005;

}  // namespace

void ImmersedDrag::begin(const Matrix3d& R_WB, const Vector3d& v_WC_W, const Vector3d& w_W) {
  R_WB_ = R_WB;
  twist_ << v_WC_W, w_W;
  force_N_.setZero();
  torque_Nm_.setZero();
  linear_kgps_ = linear_kgpm_ = 0;
  angular_Nms_.setZero();
  angular_by_speed_Ns2_.setZero();
  angular_by_rate_Nms2_.setZero();
  reach_m_.setZero();
  parts_.clear();
}

void ImmersedDrag::factors(const Part& part, const Vector6d& twist, double& speed, double& rate) const {
  const Vector3d w = twist.tail<3>();
  speed = (twist.head<3>() + w.cross(part.at_CP_W) - part.v_fluid_W).norm() + slow_mps;
  rate = w.norm() + slow_mps / part.piece->radius_m;
}

void ImmersedDrag::add(const ImmersedPiece& piece, double share, double density_kgpm3, const Vector3d& v_fluid_W,
                       const Vector3d& at_CP_W, const Matrix3d& R_WP) {
  parts_.push_back({&piece, R_WP, at_CP_W, v_fluid_W, 0.5 * density_kgpm3 * share, 0, 0});
  Part& part = parts_.back();
  // Drag with the velocities that begin() got.
  const Vector3d w_W = twist_.tail<3>();
  const Vector3d v_P = R_WP.transpose() * (twist_.head<3>() + w_W.cross(at_CP_W) - v_fluid_W);
  const Vector3d w_P = R_WP.transpose() * w_W;
  part.speed = v_P.norm() + slow_mps;
  part.rate = w_P.norm() + slow_mps / piece.radius_m;
  const Vector3d force = R_WP * (-part.pressure * part.speed * piece.drag_area_m2.cwiseProduct(v_P));
  const Vector3d turning = -part.pressure * part.rate * piece.angular_drag_area_m5.cwiseProduct(w_P);
  force_N_ += force;
  torque_Nm_ += at_CP_W.cross(force) + R_WP * turning;
  // Bounds of its derivatives.
  const double by_speed = 2 * part.pressure * piece.drag_area_m2.maxCoeff();
  const Vector3d by_rate = 2 * part.pressure * piece.R_BP.cwiseAbs2() * piece.angular_drag_area_m5;
  const Vector3d arm_squared_B = (R_WB_.transpose() * at_CP_W).cwiseAbs2();
  const Vector3d reach_squared = Vector3d::Constant(arm_squared_B.sum()) - arm_squared_B;
  linear_kgpm_ += by_speed;
  linear_kgps_ += by_speed * part.speed;
  angular_by_speed_Ns2_ += by_speed * reach_squared;
  angular_by_rate_Nms2_ += by_rate;
  angular_Nms_ += by_speed * part.speed * reach_squared + by_rate * part.rate;
  reach_m_ = reach_m_.cwiseMax(reach_squared.cwiseMax(0).cwiseSqrt());
}

bool ImmersedDrag::too_stiff(double mass_kg, const Vector3d& inertia_kgm2, double dv_mps, const Vector3d& dw_radps,
                             double step_s) const {
  constexpr double max = 0.25;  // fraction of a velocity that drag may remove in a step
  const double faster = dv_mps + dw_radps.dot(reach_m_);
  if (step_s * (linear_kgps_ + linear_kgpm_ * faster) > max * mass_kg) return true;
  const Vector3d rates = angular_Nms_ + angular_by_speed_Ns2_ * faster + angular_by_rate_Nms2_.cwiseProduct(dw_radps);
  return (step_s * rates - max * inertia_kgm2).maxCoeff() > 0;
}

/// Finds the factors `speed` and `rate` at the end of the step by iteration.  With the geometric mean of two iterates
/// the error of their logarithms at least halves each time: for M v' = F - k s v the new s falls with the old one, by
/// at most its own ratio.
Vector6d ImmersedDrag::acceleration(const Matrix6d& M, const Vector6d& other, double step_s) {
  constexpr int iterations = 10;
  Vector6d a = Vector6d::Zero();
  for (int i = 0; i < iterations; ++i) {
    // Linear system with the present factors.
    Matrix6d system = M;
    Vector6d f = other;
    for (const Part& part : parts_) {
      const auto turned = [&](double factor, const Vector3d& areas) -> Matrix3d {
        return part.R_WP * (part.pressure * factor * areas).asDiagonal() * part.R_WP.transpose();
      };
      const Matrix3d D = turned(part.speed, part.piece->drag_area_m2), S = cross_matrix(part.at_CP_W);
      const Matrix3d turning = turned(part.rate, part.piece->angular_drag_area_m5), SD = S * D;
      const Vector3d w = twist_.tail<3>();
      const Vector3d force = D * (twist_.head<3>() + w.cross(part.at_CP_W) - part.v_fluid_W);
      f.head<3>() -= force;
      f.tail<3>() -= part.at_CP_W.cross(force) + turning * w;
      system.topLeftCorner<3, 3>() += step_s * D;
      system.bottomLeftCorner<3, 3>() += step_s * SD;
      system.topRightCorner<3, 3>() += step_s * SD.transpose();
      system.bottomRightCorner<3, 3>() += step_s * (turning - SD * S);
    }
    // Solve, and update the factors with the velocities at the end.
    a = system.llt().solve(f);
    const Vector6d end = twist_ + step_s * a;
    for (Part& part : parts_) {
      double speed, rate;
      factors(part, end, speed, rate);
      part.speed = std::sqrt(part.speed * speed);
      part.rate = std::sqrt(part.rate * rate);
    }
  }
  return a;
}

}  // namespace sim
