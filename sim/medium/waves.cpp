// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/waves.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/config/message_text.hpp"

// The loops over waves are written for vectorization: without branches and calls, with sums by lanes, in an order that
// does not depend on the vector width of the processor.

namespace sim {

namespace {

constexpr std::size_t lanes = 8;
constexpr std::size_t max = (WavesConfig::max_components + lanes - 1) / lanes * lanes;
constexpr double round_magic = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer

/// Sine of pi u for |u| <= 1/2 (Taylor; error below 1e-11).
inline double sin_pi(double u) {
  const double x = std::numbers::pi * u, x2 = x * x;
  double p = -1.0 / 1307674368000.0;
  p = p * x2 + 1.0 / 6227020800.0;
  p = p * x2 - 1.0 / 39916800.0;
  p = p * x2 + 1.0 / 362880.0;
  p = p * x2 - 1.0 / 5040.0;
  p = p * x2 + 1.0 / 120.0;
  p = p * x2 - 1.0 / 6.0;
  return x * (p * x2 + 1.0);
}

/// Cosine of pi u for |u| <= 1/2 (Taylor; error below 1e-12).
inline double cos_pi(double u) {
  const double x = std::numbers::pi * u, x2 = x * x;
  double p = 1.0 / 20922789888000.0;
  p = p * x2 - 1.0 / 87178291200.0;
  p = p * x2 + 1.0 / 479001600.0;
  p = p * x2 - 1.0 / 3628800.0;
  p = p * x2 + 1.0 / 40320.0;
  p = p * x2 - 1.0 / 720.0;
  p = p * x2 + 1.0 / 24.0;
  p = p * x2 - 0.5;
  return p * x2 + 1.0;
}

/// e^-x for x >= 0 (relative error below 1e-10); x is limited to 700, where the value is negligible.
inline double exp_minus(double x) {
  const double t = -std::numbers::log2e * (x < 700 ? x : 700);
  const double shifted = t + round_magic;
  const double r = std::numbers::ln2 * (t - (shifted - round_magic));  // within 0.35
  double p = 1.0 / 3628800.0;
  p = p * r + 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  p = p * r + 1.0;
  p = p * r + 1.0;
  // The integer part is in the low bits of `shifted`; add it to the exponent.
  return std::bit_cast<double>(std::bit_cast<std::int64_t>(p) + (std::bit_cast<std::int64_t>(shifted) << 52));
}

using Lanes = std::array<double, lanes>;

inline double sum_of(const Lanes& sums) {
  return ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
}

/// Fraction of a turn, in [-1/2, 1/2].
inline double wrapped(double turns) {
  return turns - ((turns + round_magic) - round_magic);
}

/// Throws ConfigError for waves above the breaking limit: a regular wave by Miche 1944, H / L = 0.142 tanh(k h); a sea
/// by DNV-RP-C205, 3.5.4, 2 pi Hs / (g Tp^2) = 1/15.
void check_steepness(const WavesConfig& config, double gravity_mps2) {
  const double depth_m = config.water_depth_m.value_or(std::numeric_limits<double>::infinity());
  const auto fail = [&](const std::string& text) { throw_config_error(config.place, "medium: waves", text); };
  if (!(gravity_mps2 > 0)) fail("waves need 'gravity_mps2' above 0, got " + number_text(gravity_mps2));
  if (config.type == WavesConfig::Type::regular) {
    const double k = wave_number(2 * std::numbers::pi / config.period_s, gravity_mps2, depth_m);
    const double highest_m = 0.142 * std::tanh(k * depth_m) * 2 * std::numbers::pi / k;
    if (config.height_m > highest_m)
      fail("'height_m' " + number_text(config.height_m) + " is above the breaking limit of a wave of " +
           number_text(config.period_s) + " s, " + number_text(std::floor(highest_m * 1000) / 1000) + " m");
    return;
  }
  const double highest_m = gravity_mps2 * config.tp_s * config.tp_s / (2 * std::numbers::pi * 15);
  if (config.hs_m > highest_m)
    fail("'hs_m' " + number_text(config.hs_m) + " is above the breaking limit of a sea with 'tp_s' " +
         number_text(config.tp_s) + ", " + number_text(std::floor(highest_m * 1000) / 1000) + " m");
  if (config.water_depth_m && config.hs_m > 0.6 * depth_m)
    fail("'hs_m' " + number_text(config.hs_m) + " is above the breaking limit in water of 'water_depth_m' " +
         number_text(depth_m) + ", 0.6 of the depth");
}

}  // namespace

Waves::Waves(const WavesConfig& config, double gravity_mps2, std::uint64_t seed)
    : depth_m_(config.water_depth_m.value_or(std::numeric_limits<double>::infinity())) {
  check_steepness(config, gravity_mps2);
  // Draw the components.
  Random random(seed, "medium/waves");
  random.begin_step(0);
  components_ = make_waves(config, gravity_mps2, random);
  // Store them by lanes, with precomputed factors.
  const std::size_t padded = (components_.size() + lanes - 1) / lanes * lanes;
  const double per_turn = 1 / (2 * std::numbers::pi);
  for (std::size_t i = 0; i < padded; ++i) {
    WaveComponent wave = components_[std::min(i, components_.size() - 1)];
    if (i >= components_.size()) wave.amplitude_m = 0;
    const double east = std::cos(wave.direction_rad), north = std::sin(wave.direction_rad);
    const double speed = wave.amplitude_m * wave.omega_radps, acceleration = speed * wave.omega_radps;
    const double fade = std::exp(-2 * wave.k_radpm * depth_m_);
    kx_.push_back(wave.k_radpm * east * per_turn);
    ky_.push_back(wave.k_radpm * north * per_turn);
    k_.push_back(wave.k_radpm);
    amplitude_.push_back(wave.amplitude_m);
    highest_m_ += std::abs(wave.amplitude_m);
    speed_.push_back(speed);
    speed_x_.push_back(speed * east);
    speed_y_.push_back(speed * north);
    acceleration_.push_back(acceleration);
    acceleration_x_.push_back(acceleration * east);
    acceleration_y_.push_back(acceleration * north);
    two_k_depth_.push_back(2 * wave.k_radpm * depth_m_);
    by_sinh_.push_back(1 / (1 - fade));
    by_cosh_.push_back(1 / (1 + fade));
  }
  advance_to(Time{0});
}

void Waves::set_turns(Time at, Column& turns) const {
  turns.resize(k_.size());
  const double now_s = to_seconds(at);
  const double per_turn = 1 / (2 * std::numbers::pi);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const WaveComponent& wave = components_[std::min(i, components_.size() - 1)];
    const double angle = (wave.omega_radps * now_s - wave.phase_rad) * per_turn;
    turns[i] = angle - std::floor(angle);
  }
}

void Waves::advance_to(Time now) {
  set_turns(now, turns_);
}

double Waves::elevation_of(double x_m, double y_m, const Column& turns) const {
  Lanes sums{};
  const double *kx = kx_.data(), *ky = ky_.data(), *now = turns.data(), *amplitude = amplitude_.data();
  for (std::size_t i = 0; i < k_.size(); i += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double s = sin_pi(wrapped(kx[i + lane] * x_m + ky[i + lane] * y_m - now[i + lane]));
      sums[lane] += amplitude[i + lane] * (1 - 2 * s * s);
    }
  return sum_of(sums);
}

double Waves::elevation_m(double x_m, double y_m) const {
  return elevation_of(x_m, y_m, turns_);
}

double Waves::elevation_m(double x_m, double y_m, Time at) const {
  Column turns;
  set_turns(at, turns);
  return elevation_of(x_m, y_m, turns);
}

WaveMotion Waves::at(double x_m, double y_m, double z_m) const {
  alignas(64) double cosines[max], sines[max];
  const std::size_t count = k_.size();
  WaveMotion motion;
  // Phases and elevation.
  Lanes elevation{};
  {
    const double *kx = kx_.data(), *ky = ky_.data(), *now = turns_.data(), *amplitude = amplitude_.data();
    for (std::size_t i = 0; i < count; i += lanes)
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const double half = wrapped(kx[i + lane] * x_m + ky[i + lane] * y_m - now[i + lane]);
        const double s = sin_pi(half), c = cos_pi(half);
        cosines[i + lane] = 1 - 2 * s * s;
        sines[i + lane] = 2 * s * c;
        elevation[lane] += amplitude[i + lane] * cosines[i + lane];
      }
  }
  motion.elevation_m = sum_of(elevation);
  double below_m = std::max(0.0, motion.elevation_m - z_m);
  const bool deep = std::isinf(depth_m_);
  // Wheeler stretching: map the depth between bottom and instantaneous surface to that of still water.
  if (!deep) below_m = std::min(below_m * depth_m_ / std::max(1e-3, depth_m_ + motion.elevation_m), depth_m_);
  // Skip waves too short to reach this depth: e^-25 is 1e-11.
  std::size_t reach = count;
  if (deep && below_m > 0) {
    const auto end = std::upper_bound(k_.begin(), k_.end(), 25 / below_m);
    reach = (static_cast<std::size_t>(end - k_.begin()) + lanes - 1) / lanes * lanes;
  }
  Lanes head{}, vx{}, vy{}, vz{}, ax{}, ay{}, az{};
  const double *k = k_.data(), *amplitude = amplitude_.data();
  const double *two_kh = two_k_depth_.data(), *by_sinh = by_sinh_.data(), *by_cosh = by_cosh_.data();
  const double *v = speed_.data(), *v_x = speed_x_.data(), *v_y = speed_y_.data();
  const double *a = acceleration_.data(), *a_x = acceleration_x_.data(), *a_y = acceleration_y_.data();
  // Decay of the motion with depth.
  alignas(64) double cosh_by_sinh[max], sinh_by_sinh[max], cosh_by_cosh[max];
  if (deep) {
    for (std::size_t i = 0; i < reach; ++i) sinh_by_sinh[i] = exp_minus(k[i] * below_m);
  } else {
    for (std::size_t i = 0; i < reach; ++i) {
      const double down = exp_minus(k[i] * below_m), up = exp_minus(two_kh[i] - k[i] * below_m);
      cosh_by_sinh[i] = (down + up) * by_sinh[i];
      sinh_by_sinh[i] = (down - up) * by_sinh[i];
      cosh_by_cosh[i] = (down + up) * by_cosh[i];
    }
  }
  // Sum pressure, velocity and acceleration over the waves.
  const double *level = deep ? sinh_by_sinh : cosh_by_sinh, *push = deep ? sinh_by_sinh : cosh_by_cosh;
  for (std::size_t i = 0; i < reach; i += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t n = i + lane;
      const double c = cosines[n] * level[n], s = sines[n] * level[n];
      head[lane] += amplitude[n] * push[n] * cosines[n];
      vx[lane] += v_x[n] * c;
      vy[lane] += v_y[n] * c;
      // The phase decreases with time: w = d(elevation)/dt = amplitude omega sin.
      vz[lane] += v[n] * sinh_by_sinh[n] * sines[n];
      ax[lane] += a_x[n] * s;
      ay[lane] += a_y[n] * s;
      az[lane] -= a[n] * sinh_by_sinh[n] * cosines[n];
    }
  motion.head_m = sum_of(head);
  motion.velocity_W = {sum_of(vx), sum_of(vy), sum_of(vz)};
  motion.acceleration_W = {sum_of(ax), sum_of(ay), sum_of(az)};
  return motion;
}

}  // namespace sim
