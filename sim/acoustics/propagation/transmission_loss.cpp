// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/transmission_loss.hpp"

#include <algorithm>
#include <cmath>

#include "sim/medium/sea_water.hpp"

namespace sim {

Decibels spreading_loss(double range_m, double k) {
  return Decibels(k * 10 * std::log10(std::max(range_m, 1.0)));
}

Decibels spreading_loss_with_transition(double range_m, double transition_range_m) {
  const double near_m = std::min(range_m, transition_range_m);
  return spreading_loss(near_m, 2) + spreading_loss(std::max(range_m, 1.0) / std::max(near_m, 1.0), 1);
}

Decibels absorption_loss(double range_m, double absorption_dBpkm) {
  return Decibels(absorption_dBpkm * range_m / 1000);
}

void SpreadingConfig::read(ParamReader& in) {
  in.read("factor", factor, between(0, 4), "k of k 10 log10(range): 1 cylindrical, 1.5 practical, 2 spherical");
  in.read("transition_range_m", transition_range_m, between(1, 1e6),
          "instead of 'factor': spherical up to here, cylindrical beyond");
  if (in.has("factor") && in.has("transition_range_m"))
    in.error("transition_range_m", "'transition_range_m' and 'factor' exclude each other");
}

Decibels spreading_loss(double range_m, const SpreadingConfig& config) {
  return config.transition_range_m ? spreading_loss_with_transition(range_m, *config.transition_range_m)
                                   : spreading_loss(range_m, config.factor);
}

void AbsorptionConfig::read(ParamReader& in) {
  in.read_choice(
      "model", model,
      {{"thorp", Model::thorp}, {"francois_garrison", Model::francois_garrison}, {"constant", Model::constant}},
      "thorp: of the frequency alone, for sea water of 4 C; francois_garrison: of temperature, salinity and depth too");
  in.read("dBpkm", dBpkm, between(0, 1e4), "constant: at every frequency");
  in.read("pH", pH, between(6, 9), "francois_garrison: of the water");
  if (in.has("dBpkm") && model != Model::constant) in.error("dBpkm", "'dBpkm' is for model constant");
  if (in.has("pH") && model != Model::francois_garrison) in.error("pH", "'pH' is for model francois_garrison");
}

double absorption_dBpkm(const AbsorptionConfig& config, double frequency_Hz, const Medium& medium,
                        const Vector3d& from_W, const Vector3d& to_W) {
  const double f_kHz = frequency_Hz / 1000;
  if (config.model == AbsorptionConfig::Model::constant) return config.dBpkm;
  if (config.model == AbsorptionConfig::Model::thorp) return thorp_dBpkm(f_kHz);
  const auto at = [&](const Vector3d& p_W) {
    return francois_garrison_dBpkm(
        f_kHz, {medium.temperature_C(p_W), medium.salinity_psu(p_W), std::max(medium.depth_m(p_W), 0.0), config.pH});
  };
  return (at(from_W) + 4 * at((from_W + to_W) / 2) + at(to_W)) / 6;
}

}  // namespace sim
