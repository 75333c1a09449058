// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/strapdown.hpp"

#include <cmath>

#include "sim/world/world.hpp"

namespace devices {

sim::Vector3d rotation_vector(const sim::Quaterniond& q) {
  const double sine = q.vec().norm();
  // Below 1e-9 the angle equals twice the sine in double precision; this avoids 0 / 0.
  const double factor = sine < 1e-9 ? 2 : 2 * std::atan2(sine, std::abs(q.w())) / sine;
  return (q.w() < 0 ? -factor : factor) * q.vec();
}

sim::Quaterniond rotation_of(const sim::Vector3d& vector_rad) {
  const double angle = vector_rad.norm();
  if (angle == 0) return sim::Quaterniond::Identity();
  return sim::Quaterniond(Eigen::AngleAxisd(angle, vector_rad / angle));
}

void LowPass::change(double time_constant_s) {
  time_constant_s_ = time_constant_s;
  cached_dt_s_ = -1;
}

const sim::Vector3d& LowPass::apply(const sim::Vector3d& x, double dt_s) {
  if (dt_s != cached_dt_s_) {  // avoids exp() in every sample
    cached_dt_s_ = dt_s;
    gain_ = time_constant_s_ > 0 ? -std::expm1(-dt_s / time_constant_s_) : 1;
  }
  if (started_)
    y_ += gain_ * (x - y_);
  else
    y_ = x;  // steady state: it was switched on before the run
  started_ = true;
  return y_;
}

Strapdown::Strapdown(const sim::DeviceContext& context) : body_(context.body) {}

void Strapdown::measure(const sim::SenseContext& context) {
  // An event may change gravity; the sample of that interval uses the new value for all of it.
  const sim::Vector3d gravity_W_mps2(0, 0, -context.world.physics().gravity_mps2());
  sim::Quaterniond q_WS(context.X_WS.linear());
  if (started_ && context.dt_s > 0) {
    if (q_WS.dot(q_WS_) < 0) q_WS.coeffs() = -q_WS.coeffs();  // same rotation, with the sign closest to the last one
    w_WS_S_ = rotation_vector(q_WS_.conjugate() * q_WS) / context.dt_s;
    // The normalized sum of two unit quaternions is the rotation half-way between them.
    const sim::Quaterniond q_half(sim::Quaterniond(q_WS_.coeffs() + q_WS.coeffs()).normalized());
    f_S_ = q_half.conjugate() * sim::Vector3d((context.v_WS_W - v_WS_W_) / context.dt_s - gravity_W_mps2);
  } else {
    w_WS_S_ = context.X_WS.linear().transpose() * body_.w_WB_W();
    f_S_ = context.X_WS.linear().transpose() * -gravity_W_mps2;
  }
  q_WS_ = q_WS;
  v_WS_W_ = context.v_WS_W;
  started_ = true;
}

}  // namespace devices
