// SPDX-License-Identifier: BSD-3-Clause
#include "sim/clock/oscillator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/config/presets.hpp"

namespace sim {

const Presets& oscillator_presets();  // oscillator_presets.yaml

namespace {

/// Limit of the frequency error, beyond any real oscillator, so that the clock never runs backwards.
constexpr double max_rate = 0.1;

}  // namespace

void ClockConfig::read(ParamReader& in) {
  oscillator_presets().read(in, *this, {"perfect"},
                            "a kind of oscillator, see docs/models/clocks.md; the keys below win over it");
  // Initial offset and drift.
  constexpr double year_s = 31557600;
  in.read("offset_s", offset_s, between(-year_s, year_s), "reading minus true time at the start");
  in.read("offset_std_s", offset_std_s, between(0, 1e6),
          "standard deviation of a further offset, drawn once per vehicle");
  in.read("drift_ppm", drift_ppm, between(-1e4, 1e4), "constant error of the frequency; 1 ppm gains 3.6 ms in an hour");
  in.read("drift_std_ppm", drift_std_ppm, between(0, 1e3),
          "standard deviation of a further drift, drawn once per vehicle");
  // Random variation of the frequency.
  in.read("white_fm", white_fm, between(0, 1e-4), "Allan deviation at 1 s by white noise of the frequency");
  in.read("random_walk_fm", random_walk_fm, between(0, 1e-6),
          "random walk of the frequency in 1 s, 1/sqrt(s); an Allan deviation of this times sqrt(tau / 3)");
  in.read("flicker_floor", flicker_floor, between(0, 1e-4), "flat part of the Allan deviation");
  // Temperature dependence.
  in.read("temperature_ppm_per_C", temperature_ppm_per_C, between(-100, 100),
          "change of the frequency with the temperature of the water at the vehicle");
  in.read("reference_temperature_C", reference_temperature_C, between(-50, 100),
          "temperature without an effect; also that of the clock in air");
  // Update interval and resolution.
  in.read("update_s", update_s, between(0.01, 3600), "interval at which the random parts advance; linear in between");
  in.read("resolution_s", resolution_s, between(1e-6, 60),
          "tick: the reading is rounded down to a multiple of it, and to whole microseconds");
}

bool ClockConfig::wanders() const {
  return white_fm > 0 || random_walk_fm > 0 || flicker_floor > 0 || temperature_ppm_per_C != 0;
}

bool ClockConfig::perfect() const {
  const bool set = offset_s == 0 && offset_std_s == 0 && drift_ppm == 0 && drift_std_ppm == 0;
  return set && !wanders() && resolution_s <= 1e-6;
}

double flicker_process_std() {
  return std::sqrt(std::numbers::ln10 / (2 * std::numbers::ln2));
}

const std::vector<double>& flicker_times_s() {
  static const std::vector<double> times = {1, 10, 100, 1e3, 1e4, 1e5};
  return times;
}

Oscillator::Oscillator(const ClockConfig& config, std::uint64_t seed, const std::string& name)
    : config_(config), random_(seed, name) {
  offset_s_ = config.offset_s + config.offset_std_s * random_.gaussian();
  drift_ = 1e-6 * (config.drift_ppm + config.drift_std_ppm * random_.gaussian());
  drift_ = std::clamp(drift_, -max_rate, max_rate);
  if (config.flicker_floor <= 0) return;
  // Drawn from the stationary distribution, as of an oscillator that has run for a long time.
  for (std::size_t i = 0; i < flicker_times_s().size(); ++i)
    flicker_.push_back(config.flicker_floor * flicker_process_std() * random_.gaussian());
}

void Oscillator::advance(std::optional<double> temperature_C) {
  random_.begin_step(intervals_++);
  const double dt_s = config_.update_s;
  const double root_s = std::sqrt(dt_s);
  // Random walk of the frequency, and white noise.
  double gained_s = walk_ * dt_s;
  if (config_.white_fm > 0) gained_s += config_.white_fm * root_s * random_.gaussian();
  if (config_.random_walk_fm > 0) {
    // Joint draw of the walk and its integral over the interval, with variances q^2 dt and q^2 dt^3 / 3.
    const double first = random_.gaussian(), second = random_.gaussian();
    walk_ += config_.random_walk_fm * root_s * first;
    gained_s += config_.random_walk_fm * dt_s * root_s * (first / 2 + second / std::sqrt(12.0));
  }
  // Flicker noise: exact Gauss-Markov steps, integrated by the trapezoidal rule.
  for (std::size_t i = 0; i < flicker_.size(); ++i) {
    const double times = dt_s / flicker_times_s()[i];
    const double fresh = config_.flicker_floor * flicker_process_std() * std::sqrt(-std::expm1(-2 * times));
    const double before = flicker_[i];
    flicker_[i] = std::exp(-times) * before + fresh * random_.gaussian();
    gained_s += (before + flicker_[i]) / 2 * dt_s;
  }
  // Temperature, and limits of the rate.
  if (temperature_C)
    gained_s += 1e-6 * config_.temperature_ppm_per_C * (*temperature_C - config_.reference_temperature_C) * dt_s;
  walk_ = std::clamp(walk_, -max_rate, max_rate);
  wander_s_ += std::clamp(gained_s, -max_rate * dt_s, max_rate * dt_s);
}

void Oscillator::visit_state(StateArchive& archive) {
  archive(offset_s_, drift_, intervals_, wander_s_, walk_);
  archive.expect_count(flicker_.size(), "parts of the flicker noise of a clock");
  for (double& part : flicker_) archive(part);
}

}  // namespace sim
