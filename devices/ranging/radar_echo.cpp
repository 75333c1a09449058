// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/radar_echo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/medium/sea_states.hpp"

namespace devices {

namespace {

constexpr double light_mps = 299792458.0;
constexpr double max_sea_state = 6;

/// Coefficients of the model of the sea: all for 0 to 60 degrees, in dB.
struct SeaCoefficients {
  double c1, c2, c3, c4, c5;
};
constexpr SeaCoefficients of_horizontal{-73.0, 20.781, 7.351, 25.65, 0.0054};
constexpr SeaCoefficients of_vertical{-50.796, 25.93, 0.7093, 21.588, 0.00211};

}  // namespace

void RadarParams::read(sim::ParamReader& in) {
  in.read("frequency_GHz", frequency_GHz, sim::between(0.5, 35),
          "frequency: 9.41 is in the X band, 3.05 in the S band");
  in.read("peak_power_W", peak_power_W, sim::above_to(0, 1e7), "transmitted power of a pulse");
  in.read("pulse_s", pulse_s, sim::between(1e-9, 1e-4),
          "length of a pulse: c pulse / 2 is the resolution in range, 1 / pulse the band of the receiver");
  in.read_deg("horizontal_deg", horizontal_rad, sim::between(0.1, 30), "width of the beam at -3 dB, one way");
  in.read_deg("vertical_deg", vertical_rad, sim::between(0.1, 45), "height of the beam at -3 dB, one way");
  in.read_choice("polarization", polarization,
                 {{"horizontal", Polarization::horizontal}, {"vertical", Polarization::vertical}},
                 "polarization, for the echo of the sea");
  in.read("losses_dB", losses_dB, sim::between(0, 60), "losses of transmitter, antenna and receiver together");
  in.read("noise_figure_dB", noise_figure_dB, sim::between(0, 60), "noise of the receiver over that of 290 K");
}

double RadarParams::pulse_m() const {
  return light_mps * pulse_s / 2;
}

double RadarParams::gain() const {
  return 26000 / (sim::radians_to_degrees(horizontal_rad) * sim::radians_to_degrees(vertical_rad));
}

double RadarParams::echo_constant_mWm2() const {
  const double wavelength_m = light_mps / (frequency_GHz * 1e9);
  const double root = gain() * wavelength_m;
  return 1e3 * peak_power_W * root * root / std::pow(4 * std::numbers::pi, 3) * std::pow(10, -losses_dB / 10);
}

double RadarParams::noise_mW() const {
  constexpr double boltzmann_JpK = 1.380649e-23, temperature_K = 290;
  return 1e3 * boltzmann_JpK * temperature_K / pulse_s * std::pow(10, noise_figure_dB / 10);
}

double sea_reflectivity(double grazing_rad, double frequency_GHz, double sea_state, RadarParams::Polarization kind) {
  if (!(grazing_rad > 0)) return 0;
  const SeaCoefficients& c = kind == RadarParams::Polarization::horizontal ? of_horizontal : of_vertical;
  const double a = std::min(sim::radians_to_degrees(grazing_rad), 60.0);
  const double level_dB = c.c1 + c.c2 * std::log10(std::sin(sim::degrees_to_radians(a))) +
                          (27.5 + c.c3 * a) * std::log10(frequency_GHz) / (1 + 0.95 * a) +
                          c.c4 * std::pow(1 + sea_state, 1 / (2 + 0.085 * a + 0.033 * sea_state)) + c.c5 * a * a;
  return std::pow(10, level_dB / 10);
}

double sea_state_of(const sim::Medium& medium) {
  if (!medium.has_waves()) return std::min(std::pow(medium.mean_wind_mps() / 3.16, 1 / 0.8), max_sea_state);
  double variance_m2 = 0;
  for (const sim::WaveComponent& wave : medium.wave_components())
    variance_m2 += wave.amplitude_m * wave.amplitude_m / 2;
  const double hs_m = 4 * std::sqrt(variance_m2);
  const auto& heights_m = sim::hs_of_sea_state_m;
  const auto* const above = std::upper_bound(heights_m.begin(), heights_m.end(), hs_m);
  const auto next = static_cast<double>(above - heights_m.begin());
  return next > max_sea_state ? max_sea_state : next - (*above - hs_m) / (*above - *(above - 1));
}

double detected_mW(double steady_mW, double interference_mW, sim::Random& random) {
  if (steady_mW == 0) return -std::log(random.uniform()) * interference_mW;
  const double std = std::sqrt(interference_mW / 2);
  const double in_phase = std::sqrt(steady_mW) + std * random.gaussian(), quadrature = std * random.gaussian();
  return in_phase * in_phase + quadrature * quadrature;
}

double clutter_texture(double shape, sim::Random& random) {
  if (shape < 1) {
    // A variate of shape + 1 times u^(1 / shape); their means are shape + 1 and shape / (shape + 1).
    const double share = std::pow(random.uniform(), 1 / shape);
    return clutter_texture(shape + 1, random) * (shape + 1) / shape * share;
  }
  const double d = shape - 1.0 / 3, c = 1 / std::sqrt(9 * d);
  for (;;) {
    const double x = random.gaussian(), root = 1 + c * x;
    if (root <= 0) continue;
    const double v = root * root * root;
    if (std::log(random.uniform()) < x * x / 2 + d - d * v + d * std::log(v)) return d * v / shape;
  }
}

}  // namespace devices
