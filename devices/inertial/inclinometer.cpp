// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/inclinometer.hpp"

#include <cmath>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/inclination_t.hpp"

namespace devices {

Tilt tilt_of(const sim::Vector3d& up_S) {
  // The third row of Rz(yaw) Ry(pitch) Rx(roll) is (-sin p, cos p sin r, cos p cos r).
  return {std::atan2(up_S.y(), up_S.z()), std::atan2(-up_S.x(), std::hypot(up_S.y(), up_S.z()))};
}

void Inclinometer::Params::read(sim::ParamReader& in) {
  in.read("ideal", ideal, "measure the attitude, whatever the acceleration");
  in.read("time_constant_s", time_constant_s, sim::at_least(0),
          "time constant of a first-order low pass on the force; 0: none");
  in.read("noise", noise, "error of roll and of pitch, rad");
}

Inclinometer::Inclinometer(const Params& params, const sim::DeviceContext& context)
    : ideal_(params.ideal), strapdown_(context), filter_(params.time_constant_s), noise_(context, params, 2) {}

void Inclinometer::change(const Params& params) {
  ideal_ = params.ideal;
  filter_.change(params.time_constant_s);
}

void Inclinometer::measure(const sim::SenseContext& context) {
  strapdown_.measure(context);
  reading_ = tilt_of(context.X_WS.linear().row(2).transpose());
}

void Inclinometer::disturb(double dt_s, sim::Random& random) {
  const Tilt by_force = tilt_of(filter_.apply(strapdown_.f_S(), dt_s));
  if (!ideal_) reading_ = by_force;
  double angles_rad[2] = {reading_.roll_rad, reading_.pitch_rad};
  noise_.apply(std::span<double>(angles_rad), dt_s, random);
  reading_ = {angles_rad[0], angles_rad[1]};
}

void fill(const Inclinometer& inclinometer, shoal::inclination_t& message) {
  message.roll_rad = inclinometer.reading().roll_rad;
  message.pitch_rad = inclinometer.reading().pitch_rad;
}

SHOAL_SENSOR("inclinometer", Inclinometer, shoal::inclination_t);

}  // namespace devices
