// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/water_optics.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

// At 650, 550 and 450 nm.
const LinearColor pure_absorption(0.340F, 0.0565F, 0.00922F);  // Pope and Fry (1997)
const LinearColor pure_scattering(0.0010F, 0.0019F, 0.0045F);  // Morel (1974)
const LinearColor wavelength_nm(650, 550, 450);

constexpr float kirk = 0.256F;  ///< K^2 = a^2 + 0.256 a b, with the sun at the zenith (Kirk 1984)

/// Completes absorption and scattering.
WaterOptics completed(WaterOptics optics) {
  optics.attenuation = optics.absorption + optics.scattering;
  const auto squares =
      optics.absorption.array().square() + kirk * (optics.absorption.array() * optics.scattering.array());
  optics.downward = squares.sqrt().matrix();
  return optics;
}

/// Daylight with depth, 1/m, by Jerlov (1976), and scattering at 550 nm, 1/m, by Solonenko and Mobley (2015).
struct JerlovRow {
  LinearColor downward;
  float scattering;
};

const JerlovRow jerlov_rows[] = {
    {{0.36F, 0.063F, 0.019F}, 0.002F},   // I
    {{0.37F, 0.067F, 0.026F}, 0.004F},   // IA
    {{0.375F, 0.072F, 0.036F}, 0.054F},  // IB
    {{0.40F, 0.089F, 0.068F}, 0.365F},   // II
    {{0.445F, 0.12F, 0.135F}, 0.998F},   // III
    {{0.45F, 0.12F, 0.25F}, 0.372F},     // 1C
    {{0.46F, 0.19F, 0.39F}, 1.071F},     // 3C
    {{0.54F, 0.30F, 0.56F}, 1.382F},     // 5C
    {{0.63F, 0.46F, 0.89F}, 2.394F},     // 7C
    {{0.76F, 0.63F, 1.6F}, 3.180F},      // 9C
};

constexpr ChoiceWords<JerlovType> jerlov_words{{"I", JerlovType::I},   {"IA", JerlovType::IA},   {"IB", JerlovType::IB},
                                               {"II", JerlovType::II}, {"III", JerlovType::III}, {"1C", JerlovType::C1},
                                               {"3C", JerlovType::C3}, {"5C", JerlovType::C5},   {"7C", JerlovType::C7},
                                               {"9C", JerlovType::C9}};

}  // namespace

WaterOptics water_optics(double visibility_m) {
  const LinearColor dissolved(0.003F, 0.015F, 0.06F);  // absorption per scattering of particles
  constexpr double clearest_m = 60;
  // The particles make up what pure water lacks of the attenuation at 550 nm.
  const auto desired = static_cast<float>(4.8 / std::min(visibility_m, clearest_m));
  const float particles = std::max(0.0F, (desired - pure_absorption.y() - pure_scattering.y()) / (1 + dissolved.y()));
  const auto thinner = static_cast<float>(std::min(1.0, clearest_m / visibility_m));
  WaterOptics optics;
  optics.absorption = pure_absorption + particles * dissolved;
  optics.scattering = pure_scattering + LinearColor::Constant(particles);
  optics.absorption *= thinner;
  optics.scattering *= thinner;
  optics.molecular = thinner * pure_scattering;
  return completed(optics);
}

WaterOptics water_optics(JerlovType type) {
  const JerlovRow& row = jerlov_rows[static_cast<std::size_t>(type)];
  WaterOptics optics;
  optics.molecular = pure_scattering;
  const float particles = std::max(0.0F, row.scattering - pure_scattering.y());
  for (int i = 0; i < 3; ++i) {
    const float b = pure_scattering[i] + particles * std::pow(550 / wavelength_nm[i], 1.7F), half = 0.5F * kirk * b;
    optics.scattering[i] = b;
    optics.absorption[i] = std::sqrt(half * half + row.downward[i] * row.downward[i]) - half;
  }
  return completed(optics);
}

WaterOptics chlorophyll_optics(double chlorophyll_mgpm3) {
  const LinearColor pigments(0.356F, 0.357F, 0.944F);  // relative to 440 nm (Prieur and Sathyendranath 1981)
  const auto matter = static_cast<float>(0.06 * std::pow(chlorophyll_mgpm3, 0.65));
  const auto particles = static_cast<float>(0.3 * std::pow(chlorophyll_mgpm3, 0.62));
  WaterOptics optics;
  optics.molecular = pure_scattering;
  for (int i = 0; i < 3; ++i) {
    // Dissolved matter that goes with the pigments is a fifth at 440 nm (Morel 1991); without pigments there is none.
    const float dissolved = matter > 0 ? 0.2F * std::exp(-0.014F * (wavelength_nm[i] - 440)) : 0;
    optics.absorption[i] = (pure_absorption[i] + matter * pigments[i]) * (1 + dissolved);
    optics.scattering[i] = pure_scattering[i] + particles * 550 / wavelength_nm[i];
  }
  return completed(optics);
}

void WaterLookConfig::read(ParamReader& in) {
  in.read_choice("jerlov", jerlov, "unset", jerlov_words,
                 "class of the water by Jerlov: of the ocean I to III, of coasts 1C to 9C, each from clear to turbid");
  in.read("chlorophyll_mgpm3", chlorophyll_mgpm3, between(0, 100), "instead: chlorophyll of open sea (case 1)");
  in.read("visibility_m", visibility_m, between(0.1, 1e6), "instead: distance at which a black target disappears");
  in.read("details", details, "false: neither caustics nor particles");
  in.read("caustics", caustics, "pattern of sunlight that waves focus, on what is under water");
  in.read("particles_per_m3", particles_per_m3, between(0, 5000), "marine snow: particles of 0.5 to 2 mm");
  if (in.describing()) return;
  // A key with a wrong value has been reported.
  int given = 0;
  for (const char* key : {"jerlov", "chlorophyll_mgpm3", "visibility_m"}) given += in.has(key) ? 1 : 0;
  const char* rule = "needs exactly one of 'jerlov', 'chlorophyll_mgpm3' and 'visibility_m'";
  if (given == 0) in.error(rule);
  if (given > 1) in.error(in.has("visibility_m") ? "visibility_m" : "chlorophyll_mgpm3", rule);
}

WaterOptics WaterLookConfig::optics() const {
  if (jerlov) return water_optics(*jerlov);
  return chlorophyll_mgpm3 ? chlorophyll_optics(*chlorophyll_mgpm3) : water_optics(visibility_m.value_or(60));
}

}  // namespace sim
