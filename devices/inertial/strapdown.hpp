// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/math.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Returns the rotation vector (axis times angle in [0, pi]) of a unit quaternion.
sim::Vector3d rotation_vector(const sim::Quaterniond& q);
/// Returns the unit quaternion of a rotation vector.
sim::Quaterniond rotation_of(const sim::Vector3d& vector_rad);

/// First-order low-pass filter, exact for an input that is constant between samples: y += (1 - exp(-dt / T)) (x - y).
class LowPass {
 public:
  /// `time_constant_s` 0: no filtering.
  explicit LowPass(double time_constant_s) : time_constant_s_(time_constant_s) {}
  void change(double time_constant_s);
  /// Makes the next input the first: the filter begins in its steady state again.
  void restart() { started_ = false; }
  const sim::Vector3d& apply(const sim::Vector3d& x, double dt_s);
  void visit_state(sim::StateArchive& archive) { archive(started_, y_); }

 private:
  double time_constant_s_;
  double cached_dt_s_ = -1;
  double gain_ = 1;
  bool started_ = false;
  sim::Vector3d y_ = sim::Vector3d::Zero();
};

/// Outputs of ideal gyros and accelerometers fixed to the sensor frame S: integrals over the sampling interval divided
/// by its length, as accumulated in strapdown units (Titterton and Weston, Strapdown Inertial Navigation Technology,
/// 2nd ed., 2004).  Because means are used instead of differences of positions, a contact force of a millisecond is
/// spread over the interval and causes no ringing.
class Strapdown {
 public:
  explicit Strapdown(const sim::DeviceContext& context);
  /// Computes the means since the last call.  The first call has no interval: it gives the instantaneous angular
  /// velocity, and the specific force of a sensor that is not accelerated.
  void measure(const sim::SenseContext& context);
  /// Makes the next call the first: the vehicle was put elsewhere, which no sensor feels.
  void restart() { started_ = false; }
  void visit_state(sim::StateArchive& archive) { archive(started_, q_WS_, v_WS_W_, w_WS_S_, f_S_); }

  /// Mean angular velocity: the rotation vector from the last attitude to the present one, divided by dt.  Its integral
  /// equals the attitude exactly when the sensor turns by less than half a revolution per sample.
  const sim::Vector3d& w_WS_S() const { return w_WS_S_; }
  /// Mean specific force: (velocity change of the origin of S minus that due to gravity) / dt, in the axes of S
  /// half-way between the two attitudes.
  const sim::Vector3d& f_S() const { return f_S_; }

 private:
  const sim::Body& body_;
  bool started_ = false;
  sim::Quaterniond q_WS_ = sim::Quaterniond::Identity();  ///< at the last sample
  sim::Vector3d v_WS_W_ = sim::Vector3d::Zero();
  sim::Vector3d w_WS_S_ = sim::Vector3d::Zero();
  sim::Vector3d f_S_ = sim::Vector3d::Zero();
};

}  // namespace devices
