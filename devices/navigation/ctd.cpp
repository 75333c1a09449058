// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/ctd.hpp"

#include <algorithm>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/ctd_t.hpp"
#include "sim/medium/sea_water.hpp"
#include "sim/world/world.hpp"

namespace devices {

void Ctd::Params::read(sim::ParamReader& in) {
  depth.read(in);
  in.read("conductivity_noise", conductivity_noise, "error of the conductivity, S/m");
  in.read("temperature_noise", temperature_noise, "error of the temperature, degrees C");
  in.read("pressure_noise", pressure_noise, "error of the pressure, Pa");
  in.read("sound_speed_noise", sound_speed_noise, "error of the speed of sound, m/s");
}

Ctd::Ctd(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      conductivity_noise_(context, params),
      temperature_noise_(context, params),
      pressure_noise_(context, params),
      sound_speed_noise_(context, params) {}

void Ctd::measure(const sim::SenseContext& context) {
  const sim::Medium& medium = context.world.medium();
  const sim::Vector3d& p_WS = context.X_WS.translation();
  reading_ = {};
  reading_.temperature_C = medium.temperature_C(p_WS);
  reading_.pressure_Pa = medium.pressure_Pa(p_WS);
  reading_.valid = medium.in_water(p_WS);
  if (!reading_.valid) return;
  reading_.conductivity_Spm = sim::conductivity_Spm(medium.salinity_psu(p_WS), reading_.temperature_C, pressure_dbar());
  reading_.sound_speed_mps = medium.sound_speed_mps(p_WS);
}

void Ctd::disturb(double dt_s, sim::Random& random) {
  conductivity_noise_.apply(reading_.conductivity_Spm, dt_s, random);
  temperature_noise_.apply(reading_.temperature_C, dt_s, random);
  pressure_noise_.apply(reading_.pressure_Pa, dt_s, random);
  sound_speed_noise_.apply(reading_.sound_speed_mps, dt_s, random);
  if (reading_.valid) return;
  reading_.conductivity_Spm = 0;
  reading_.sound_speed_mps = 0;
}

double Ctd::salinity_psu() const {
  return sim::practical_salinity_psu(reading_.conductivity_Spm, reading_.temperature_C, pressure_dbar());
}

void fill(const Ctd& ctd, shoal::ctd_t& message) {
  const Ctd::Reading& reading = ctd.reading();
  message.valid = reading.valid;
  message.conductivity_Spm = reading.conductivity_Spm;
  message.temperature_C = reading.temperature_C;
  message.pressure_Pa = reading.pressure_Pa;
  message.depth_m = ctd.depth_m();
  message.salinity_psu = ctd.salinity_psu();
  message.sound_speed_mps = reading.sound_speed_mps;
}

SHOAL_SENSOR("ctd", Ctd, shoal::ctd_t);

}  // namespace devices
