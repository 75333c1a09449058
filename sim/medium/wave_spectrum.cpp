// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/wave_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sim {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

/// Cumulative integrals of a positive function by the trapezoidal rule, normalized to end at 1.
std::vector<double> running_share(const std::vector<double>& density, const std::vector<double>& at) {
  std::vector<double> sums(density.size(), 0);
  for (std::size_t i = 1; i < density.size(); ++i)
    sums[i] = sums[i - 1] + (density[i] + density[i - 1]) / 2 * (at[i] - at[i - 1]);
  for (double& sum : sums) sum /= sums.back();
  return sums;
}

/// Linear interpolation in a table with increasing `from`.
double looked_up(const std::vector<double>& from, const std::vector<double>& to, double value) {
  const auto above = std::upper_bound(from.begin() + 1, from.end() - 1, value);
  const auto i = static_cast<std::size_t>(above - from.begin());
  const double width = from[i] - from[i - 1];
  const double share = width > 0 ? std::clamp((value - from[i - 1]) / width, 0.0, 1.0) : 0;
  return to[i - 1] + (to[i] - to[i - 1]) * share;
}

/// Directions with the density cos^2s(angle / 2), drawn by the inverse of its cumulative integral.
class Spreading {
 public:
  explicit Spreading(double s) {
    constexpr int points = 4001;
    std::vector<double> density;
    for (int i = 0; i < points; ++i) {
      angles_.push_back(-std::numbers::pi + two_pi * i / (points - 1));
      density.push_back(std::pow(std::max(0.0, std::cos(angles_.back() / 2)), 2 * s));
    }
    shares_ = running_share(density, angles_);
  }
  double draw(Random& random) const { return looked_up(shares_, angles_, random.uniform()); }

 private:
  std::vector<double> angles_, shares_;
};

}  // namespace

double pierson_moskowitz_m2s(double omega, double hs_m, double tp_s) {
  if (!(omega > 0)) return 0;
  const double ratio = two_pi / tp_s / omega, ratio4 = ratio * ratio * ratio * ratio;
  return 5.0 / 16 * hs_m * hs_m * ratio4 / omega * std::exp(-1.25 * ratio4);
}

double jonswap_m2s(double omega, double hs_m, double tp_s, double gamma) {
  const double peak = two_pi / tp_s;
  const double width = omega <= peak ? 0.07 : 0.09;
  const double off = (omega - peak) / (width * peak);
  return (1 - 0.287 * std::log(gamma)) * pierson_moskowitz_m2s(omega, hs_m, tp_s) *
         std::pow(gamma, std::exp(-off * off / 2));
}

double wave_number(double omega, double gravity_mps2, double depth_m) {
  const double deep = omega * omega / gravity_mps2;
  if (!std::isfinite(depth_m) || deep * depth_m > 40) return deep;
  // Newton's method on f = k tanh(k h) - w^2/g, from the larger of the deep- and shallow-water limits.
  double k = std::max(deep, omega / std::sqrt(gravity_mps2 * depth_m));
  for (int i = 0; i < 50; ++i) {
    const double t = std::tanh(k * depth_m);
    const double next = k - (k * t - deep) / (t + k * depth_m * (1 - t * t));
    if (std::abs(next - k) <= 1e-15 * k) return next;
    k = next;
  }
  return k;
}

std::vector<WaveComponent> make_waves(const WavesConfig& config, double gravity_mps2, Random& random) {
  const double depth_m = config.water_depth_m.value_or(std::numeric_limits<double>::infinity());
  if (config.type == WavesConfig::Type::regular) {
    const double omega = two_pi / config.period_s;
    return {{omega, wave_number(omega, gravity_mps2, depth_m), config.height_m / 2, config.direction_rad,
             config.phase_rad}};
  }
  // Tabulate the spectra of elevation and vertical speed.
  const double gamma = config.type == WavesConfig::Type::jonswap ? config.gamma : 1;
  const double peak = two_pi / config.tp_s;
  constexpr int points = 20001;
  constexpr double lowest = 0.3;  // the energy below is a factor e^-150
  std::vector<double> omegas, energy, speed;
  for (int i = 0; i < points; ++i) {
    const double omega = peak * lowest * std::pow(config.cutoff / lowest, static_cast<double>(i) / (points - 1));
    omegas.push_back(omega);
    energy.push_back(jonswap_m2s(omega, 1, config.tp_s, gamma));
    speed.push_back(omega * omega * energy.back());
  }
  // Cumulative energy, and the measure that divides the bins.
  const std::vector<double> energy_below = running_share(energy, omegas);
  std::vector<double> measure = running_share(speed, omegas);
  for (std::size_t i = 0; i < measure.size(); ++i) measure[i] = (measure[i] + energy_below[i]) / 2;
  std::optional<Spreading> spreading;
  if (config.spreading) spreading.emplace(*config.spreading);
  // Draw one wave per bin.
  std::vector<WaveComponent> waves;
  double low_energy = 0;
  for (int i = 0; i < config.components; ++i) {
    const double upper = static_cast<double>(i + 1) / config.components;
    const double high_energy = i + 1 == config.components ? 1 : looked_up(measure, energy_below, upper);
    WaveComponent wave;
    wave.omega_radps = looked_up(measure, omegas, (i + random.uniform()) / config.components);
    wave.k_radpm = wave_number(wave.omega_radps, gravity_mps2, depth_m);
    wave.amplitude_m = config.hs_m / 4 * std::sqrt(2 * std::max(0.0, high_energy - low_energy));
    wave.phase_rad = two_pi * random.uniform();
    wave.direction_rad = config.direction_rad + (spreading ? spreading->draw(random) : 0);
    waves.push_back(wave);
    low_energy = high_energy;
  }
  return waves;
}

}  // namespace sim
