// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/pressure.hpp"

#include "messages/reporter/message_reporter.hpp"
#include "shoal/pressure_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

void Pressure::Params::read(sim::ParamReader& in) {
  depth.read(in);
  in.read("pressure_noise", pressure_noise, "error of the pressure, Pa");
  in.read("temperature_noise", temperature_noise, "error of the temperature, degrees C");
}

Pressure::Pressure(const Params& params, const sim::DeviceContext& context)
    : params_(params), pressure_noise_(context, params), temperature_noise_(context, params) {}

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

void fill(const Pressure& pressure, shoal::pressure_t& message) {
  message.pressure_Pa = pressure.pressure_Pa();
  message.depth_m = pressure.depth_m();
  message.temperature_C = pressure.temperature_C();
}

SHOAL_SENSOR("pressure", Pressure, shoal::pressure_t);

void DepthFormula::read(sim::ParamReader& in) {
  in.read("assumed_density_kgpm3", assumed_density_kgpm3, sim::between(500, 2000),
          "density that the sensor assumes when it converts pressure to depth");
  in.read("assumed_gravity_mps2", assumed_gravity_mps2, sim::between(0.1, 100), "gravity that the sensor assumes");
  in.read("assumed_surface_Pa", assumed_surface_Pa, sim::between(0, 1e7),
          "absolute pressure that it assumes at depth 0");
}

}  // namespace devices
