// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/math.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// The rotation vector (axis times angle in [0, pi]) of a unit quaternion.
sim::Vector3d rotation_vector(const sim::Quaterniond& q);
/// The rotation of a rotation vector.
sim::Quaterniond rotation_of(const sim::Vector3d& vector_rad);

/// First-order low pass, exact for an input that is constant between samples: y += (1 - exp(-dt / T)) (x - y).
class LowPass {
 public:
  /// `time_constant_s` 0: no filtering.
  explicit LowPass(double time_constant_s) : time_constant_s_(time_constant_s) {}
  void change(double time_constant_s);
  const sim::Vector3d& apply(const sim::Vector3d& x, double dt_s);
  void visit_state(sim::StateArchive& archive) { archive(started_, y_); }

 private:
  double time_constant_s_;
  double cached_dt_s_ = -1;
  double gain_ = 1;
  bool started_ = false;
  sim::Vector3d y_ = sim::Vector3d::Zero();
};

/// What ideal gyros and accelerometers fixed to the sensor frame S give: integrals over the sampling interval, divided
/// by its length, as strapdown units sum up inside (Titterton and Weston, Strapdown Inertial Navigation Technology, 2nd
/// ed., 2004).  Means, not differences of positions: a contact that pushes for a millisecond is
/// spread over the interval and does not ring.
class Strapdown {
 public:
  explicit Strapdown(const sim::DeviceContext& context);
  /// Takes the means since the last call.  The first call has no interval: angular velocity of the moment, and the
  /// specific force of a sensor that is not accelerated.
  void measure(const sim::SenseContext& context);
  void visit_state(sim::StateArchive& archive) { archive(started_, q_WS_, v_WS_W_, w_WS_S_, f_S_); }

  /// Mean angular velocity: the rotation vector from the last attitude to this one by dt.  Its integral is the
  /// attitude exactly, as long as the sensor turns less than half a turn in a sample.
  const sim::Vector3d& w_WS_S() const { return w_WS_S_; }
  /// Mean specific force: (velocity gained by the origin of S, minus what gravity gave) by dt, in the axes of S
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
