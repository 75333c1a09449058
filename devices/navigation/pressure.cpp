// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/pressure.hpp"

#include "shoal/message_codec.hpp"
#include "shoal/pressure_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

void Pressure::Params::read(sim::ParamReader& in) {
  depth.read(in);
  in.read("pressure_noise", pressure_noise, "error of the pressure, Pa");
  in.read("temperature_noise", temperature_noise, "error of the temperature, degrees C");
}

Pressure::Pressure(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      pressure_noise_(context.noise(params.pressure_noise, 1, "pressure_noise")),
      temperature_noise_(context.noise(params.temperature_noise, 1, "temperature_noise")) {}

void Pressure::change(const Params& params) {
  params_ = params;
  pressure_noise_.change(params.pressure_noise);
  temperature_noise_.change(params.temperature_noise);
}

void Pressure::measure(const sim::SenseContext& context) {
  const sim::Medium& medium = context.world.medium();
  pressure_Pa_ = medium.pressure_Pa(context.X_WS.translation());
  temperature_C_ = medium.temperature_C(context.X_WS.translation());
}

void Pressure::disturb(double dt_s, sim::Random& random) {
  pressure_noise_.apply(pressure_Pa_, dt_s, random);
  temperature_noise_.apply(temperature_C_, dt_s, random);
}

void Pressure::visit_state(sim::StateArchive& archive) {
  archive(pressure_Pa_, temperature_C_, pressure_noise_, temperature_noise_);
}

void PressureReporter::report(sim::Time sampled_at, sim::Publisher& out) const {
  shoal::pressure_t message;
  message.utime = out.utime(sampled_at);
  message.pressure_Pa = pressure_.pressure_Pa();
  message.depth_m = pressure_.depth_m();
  message.temperature_C = pressure_.temperature_C();
  shoal::encode_into(message, out.buffer());
  out.publish(out.buffer());
}

SHOAL_SENSOR("pressure", Pressure, PressureReporter);

}  // namespace devices
