// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/multipath.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {
namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

void image_paths(double source_depth_m, double receiver_depth_m, double horizontal_m, double water_depth_m,
                 int max_bounces, std::vector<ImagePath>& out) {
  out.clear();
  const auto add = [&](double vertical_m, int surface, int bottom, bool upwards) {
    out.push_back({std::hypot(horizontal_m, vertical_m), surface, bottom,
                   std::atan2(std::abs(vertical_m), horizontal_m), upwards});
  };
  add(receiver_depth_m - source_depth_m, 0, 0, receiver_depth_m < source_depth_m);
  const double D = water_depth_m, zs = source_depth_m, zr = receiver_depth_m;
  for (int n = 1; n <= max_bounces; ++n) {
    // Unfolded, a path that starts upwards rises by zs, crosses the water n - 1 times, and ends at the receiver; one
    // that starts downwards is its mirror image.
    const int more = (n + 1) / 2, less = n / 2;
    if (!std::isfinite(D)) {
      add(zs + zr, 1, 0, true);
      break;
    }
    if (n % 2 == 1) {
      add((n - 1) * D + zs + zr, more, less, true);
      add((n + 1) * D - zs - zr, less, more, false);
    } else {
      add(n * D + zs - zr, more, less, true);
      add(n * D - zs + zr, less, more, false);
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const ImagePath& a, const ImagePath& b) { return a.length_m < b.length_m; });
}

void BottomConfig::read(ParamReader& in) {
  in.read("loss_dB", loss_dB, between(0, 200), "loss of each bounce, at any angle; unset: by the sediment below");
  in.read("density_ratio", density_ratio, above_to(0, 10),
          "density ratio of sediment over water; sand 1.9, silt 1.5, clay 1.3");
  in.read("speed_ratio", speed_ratio, between(0.5, 5),
          "speed ratio of sound in sediment over water; sand 1.1, clay 0.99");
  in.read("attenuation_dB_per_wavelength", attenuation_dB_per_wavelength, between(0, 20), "in the sediment");
  if (in.has("loss_dB"))
    for (const char* key : {"density_ratio", "speed_ratio", "attenuation_dB_per_wavelength"})
      if (in.has(key)) in.error(key, "'" + std::string(key) + "' and 'loss_dB' exclude each other");
}

void MultipathConfig::read(ParamReader& in) {
  in.read("max_bounces", max_bounces, between(0, 20), "at surface and bottom together; 0: the direct path alone");
  in.read("window_s", window_s, between(0, 10), "echoes later than this after the first arrival are interference");
  in.read("water_depth_m", water_depth_m, above_to(0, 12000),
          "depth of a flat bottom; unset: the terrain below the middle of the path; without terrain there is no "
          "bottom echo");
  in.read("surface_loss_dB", surface_loss_dB, between(0, 200), "surface loss of each bounce; unset: by the roughness");
  in.read("surface_roughness_m", surface_roughness_m, between(0, 20),
          "rms height of the waves; unset: that of a fully developed sea under the wind");
  in.read("bottom", bottom, "reflection of sound by the bottom");
  in.read_choice("phases", phases, {{"random", Phases::random}, {"geometric", Phases::geometric}},
                 "random: each path has its own phase for each packet; geometric: by the lengths");
  if (in.has("surface_loss_dB") && in.has("surface_roughness_m"))
    in.error("surface_roughness_m", "'surface_roughness_m' and 'surface_loss_dB' exclude each other");
}

double wind_sea_roughness_m(double wind_mps) {
  return 0.21 * wind_mps * wind_mps / 9.81 / 4;
}

double surface_reflection(double wave_number_pm, double roughness_m, double grazing_rad) {
  const double phase = wave_number_pm * roughness_m * std::sin(grazing_rad);
  return -std::exp(-2 * phase * phase);
}

std::complex<double> bottom_reflection(const BottomConfig& bottom, double grazing_rad) {
  if (bottom.loss_dB) return std::pow(10.0, -*bottom.loss_dB / 20);
  // Attenuation makes the speed of sound complex: alpha dB per wavelength adds an imaginary part of alpha / (40 pi
  // log10 e) of the wave number.  The physical root decays away from the boundary: its imaginary part is positive.
  const double loss = bottom.attenuation_dB_per_wavelength / (40 * pi * std::numbers::log10e);
  const std::complex<double> n = std::complex<double>(1, loss) / bottom.speed_ratio;
  const double sine = std::sin(grazing_rad), cosine = std::cos(grazing_rad);
  std::complex<double> below = std::sqrt(n * n - cosine * cosine);
  if (below.imag() < 0) below = -below;
  const double m = bottom.density_ratio;
  if (m * sine == 0 && std::abs(below) == 0) return -1;
  return (m * sine - below) / (m * sine + below);
}

void path_gains(const std::vector<ImagePath>& paths, const MultipathConfig& config, const MultipathMedium& medium,
                std::vector<PathGain>& out) {
  out.clear();
  const double k = 2 * pi * medium.frequency_Hz / medium.sound_speed_mps;
  const double roughness_m = config.surface_roughness_m.value_or(wind_sea_roughness_m(medium.wind_mps));
  for (const ImagePath& path : paths) {
    PathGain gain;
    gain.delay_s = path.length_m / medium.sound_speed_mps;
    gain.gain =
        -spreading_loss(path.length_m, medium.spreading) - absorption_loss(path.length_m, medium.absorption_dBpkm);
    gain.phase_rad = std::fmod(k * path.length_m, 2 * pi);
    const Decibels surface = config.surface_loss_dB
                                 ? Decibels(-*config.surface_loss_dB)
                                 : pressure_level(surface_reflection(k, roughness_m, path.grazing_rad));
    // Avoid 0 times minus infinity.
    if (path.surface_bounces > 0) gain.gain += path.surface_bounces * surface;
    gain.phase_rad += path.surface_bounces * pi;
    if (path.bottom_bounces > 0) {
      const std::complex<double> bottom = bottom_reflection(config.bottom, path.grazing_rad);
      gain.gain += path.bottom_bounces * pressure_level(std::abs(bottom));
      gain.phase_rad += path.bottom_bounces * std::arg(bottom);
    }
    out.push_back(gain);
  }
}

void randomize_phases(std::vector<PathGain>& gains, Random& random) {
  for (std::size_t i = 1; i < gains.size(); ++i) gains[i].phase_rad = 2 * pi * random.uniform();
}

MultipathSum combine(const std::vector<PathGain>& gains, double window_s) {
  MultipathSum sum;
  if (gains.empty()) return sum;
  // Find the first arrival.
  sum.first_s = gains[0].delay_s;
  for (const PathGain& each : gains) sum.first_s = std::min(sum.first_s, each.delay_s);
  // Add pressures inside the window, powers after it.
  std::complex<double> pressure = 0;
  double power = 0, first_moment = 0, second_moment = 0;
  for (const PathGain& each : gains) {
    const double late_s = each.delay_s - sum.first_s, p = to_power(each.gain).linear();
    if (late_s <= window_s)
      pressure += std::polar(std::sqrt(p), each.phase_rad);
    else
      sum.interference += PowerRatio(p);
    power += p;
    first_moment += p * late_s;
    second_moment += p * late_s * late_s;
  }
  // Standard deviation of the delays.
  sum.signal = PowerRatio(std::norm(pressure));
  if (power > 0) {
    const double mean_s = first_moment / power;
    sum.spread_s = std::sqrt(std::max(0.0, second_moment / power - mean_s * mean_s));
  }
  return sum;
}

Echoes echoes(const MultipathConfig& config, const MultipathMedium& medium, const LinkDepths& depths, Random* random,
              Decibels direct_left) {
  const double water_m = std::max(0.0, depths.water_m);
  std::vector<ImagePath> paths;
  image_paths(std::clamp(depths.source_m, 0.0, water_m), std::clamp(depths.receiver_m, 0.0, water_m),
              depths.horizontal_m, water_m, config.max_bounces, paths);
  std::vector<PathGain> gains;
  path_gains(paths, config, medium, gains);
  // Relative to the direct path from here on, which also works at ranges where its power is below the smallest number.
  const Decibels direct = gains[0].gain;
  for (PathGain& gain : gains) gain.gain -= direct;
  const double direct_s = gains[0].delay_s;
  gains[0].gain += direct_left;
  if (std::isinf(direct_left.dB())) gains.erase(gains.begin());
  Echoes result;
  const bool drawn = config.phases == MultipathConfig::Phases::random;
  if (drawn && random != nullptr) randomize_phases(gains, *random);
  const MultipathSum sum = combine(gains, config.window_s);
  result.signal = sum.signal;
  result.late = sum.interference;
  result.spread_s = sum.spread_s;
  if (!gains.empty()) result.later_s = std::max(0.0, sum.first_s - direct_s);
  if (drawn && random == nullptr) {
    PowerRatio inside;
    for (const PathGain& gain : gains)
      if (gain.delay_s - sum.first_s <= config.window_s) inside += to_power(gain.gain);
    result.signal = inside;
  }
  return result;
}

}  // namespace sim
