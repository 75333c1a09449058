// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/bound/usbl_errors.hpp"

#include <cmath>

#include "devices/sound_positioning/transponder.hpp"
#include "devices/sound_positioning/usbl.hpp"
#include "experiment/score/bound/device_params.hpp"
#include "sim/acoustics/propagation/propagation.hpp"

namespace experiment {

double UsblHearing::cosine_std(double range_m) const {
  devices::UsblTone received = tone;
  received.snr = tone.snr * sim::to_power(-sim::spreading_loss(range_m, spreading) -
                                          sim::absorption_loss(range_m, absorption_dBpkm));
  return array.cosine_std(received);
}

UsblErrors::Plane UsblErrors::at(const sim::Vector3d& displacement_m) const {
  const double level_m = displacement_m.head<2>().norm(), range_m = displacement_m.norm();
  const double cosine = range_m > 0 ? level_m / range_m : 1;
  const auto square = [](double x) { return x * x; };
  // A level array measures both horizontal components by its cosines: range times their error.
  const double array_m2 = hearing ? square(range_m * hearing->cosine_std(range_m)) : 0;
  return {square(cosine * range_std_m) + square(displacement_m.z() * elevation_std_rad) + array_m2,
          square(range_m * across_std_rad) + square(level_m * heading_std_rad) + array_m2};
}

std::optional<UsblHearing> usbl_hearing(const sim::VehicleConfig& own,
                                        const std::vector<const sim::VehicleConfig*>& vehicles,
                                        const sim::AcousticsConfig& acoustics, const sim::Medium& medium) {
  const FirstDevice<devices::Usbl> usbl(own);
  if (!usbl || !usbl.params->array) return std::nullopt;
  for (const sim::VehicleConfig* other : vehicles) {
    const FirstDevice<devices::Transponder> transponder(*other);
    if (!transponder || transponder.params->network != usbl.params->interrogator.network) continue;
    const devices::Transponder::Params& answer = *transponder.params;
    const double frequency_Hz = answer.answer_frequency_Hz.value_or(devices::lowest_answer_Hz);
    const sim::Vector3d p_W(0, 0, medium.still_surface_m() - 1);  // in the water, as a USBL of a boat
    const sim::AmbientNoise noise = acoustics.noise.with_wind(medium.mean_wind_mps());
    UsblHearing hearing;
    hearing.array = *usbl.params->array;
    hearing.tone.snr =
        sim::to_power(sim::Decibels(answer.source_level_dB) - noise.band_level(frequency_Hz, answer.bandwidth_Hz));
    hearing.tone.time_bandwidth = answer.bandwidth_Hz * answer.ping_s;
    hearing.tone.wavelength_m = medium.sound_speed_mps(p_W) / frequency_Hz;
    hearing.spreading = sim::straight_spreading(acoustics, medium.has_sound_profile());
    hearing.absorption_dBpkm = sim::absorption_dBpkm(acoustics.absorption, frequency_Hz, medium, p_W, p_W);
    return hearing;
  }
  return std::nullopt;
}

}  // namespace experiment
