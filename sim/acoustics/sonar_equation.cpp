// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/sonar_equation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/acoustics/propagation/link_losses.hpp"
#include "sim/acoustics/propagation/sound_path.hpp"
#include "sim/device/fault.hpp"
#include "sim/physics/body.hpp"

namespace sim {

namespace {

/// Gains below this count as zero.
constexpr double lowest_dB = -1000;

}  // namespace

PowerRatio SonarEquation::noise_at(const Transducer& to, const Vector3d& p_W, const Signal& signal) const {
  PowerRatio noise =
      propagation_.ambient_power(signal.centre_Hz, signal.bandwidth_Hz, to.noise_reduction(signal.centre_Hz));
  for (const ContinuousSound* sound : sounds_) {
    if (!sound->on_ || !sound->site_.powered || sound->site_.faults.silent()) continue;
    const Vector3d from_W = sound->site_.body.X_WB() * sound->site_.X_BS.translation();
    if (!medium_.in_water(from_W)) continue;
    const double f = sound->center_Hz_, half_Hz = sound->bandwidth_Hz_ / 2;
    const double low_Hz = std::max(f - half_Hz, signal.centre_Hz - signal.bandwidth_Hz / 2);
    const double high_Hz = std::min(f + half_Hz, signal.centre_Hz + signal.bandwidth_Hz / 2);
    if (high_Hz <= low_Hz) continue;
    Decibels level = sound->source_level_ - propagation_.transmission_loss(from_W, p_W, f);
    level += directivity_gain(to.config().directivity, to.R_WS().transpose() * (from_W - p_W), f,
                              medium_.sound_speed_mps(p_W));
    if (config_.occlusion)
      level += pressure_level(propagation_.free_part(from_W, sound->site_.group, p_W, to.group(), signal.centre_Hz));
    noise += (high_Hz - low_Hz) / sound->bandwidth_Hz_ * to_power(level);
  }
  return noise;
}

Random SonarEquation::stream(const Transducer& to, const Transmission& transmission, bool at_end) const {
  // One stream per pair, so that adding a modem changes no other link.
  Random random(seed_, transmission.source + ">" + to.full_name() + "#sound");
  random.begin_step(2 * transmission.sequence + at_end);
  return random;
}

/// Sets the closing speed, from the directions at both ends.  Returns the ratio of received to transmitted frequency.
double SonarEquation::doppler(Level& at, const Vector3d& leaves_W, double c_mps, const Transducer& to,
                              const Transmission& transmission) const {
  const Vector3d v_to_W = to.v_W();
  if (!at.bent) {
    at.closing_mps = closing_speed_mps(at.arrives_W, transmission.v_W, v_to_W);
    return doppler_factor(at.arrives_W, transmission.v_W, v_to_W, c_mps);
  }
  at.closing_mps = leaves_W.dot(transmission.v_W) - at.arrives_W.dot(v_to_W);
  const double c_from = medium_.sound_speed_mps(transmission.p_W);
  return (1 - at.arrives_W.dot(v_to_W) / c_mps) / (1 - leaves_W.dot(transmission.v_W) / c_from);
}

SonarEquation::Level SonarEquation::level_at(const Transducer& to, const Vector3d& p_W, Time started,
                                             const Transmission& transmission) const {
  Level at;
  const Signal& signal = transmission.signal;
  // Path gain.
  Random random = propagation_.draws() ? stream(to, transmission, false) : Random(0, {});
  Propagation::Gain gain =
      propagation_.gain(transmission.p_W, transmission.group, p_W, to.group(), signal.centre_Hz, random);
  // Directions of the sound at both ends: those of its ray, or of the straight line.
  const Vector3d displacement_W = p_W - transmission.p_W;
  const double range_m = displacement_W.norm();
  const Vector3d direction_W = range_m > 0 ? Vector3d(displacement_W / range_m) : Vector3d(Vector3d::UnitX());
  const Vector3d leaves_W = gain.first ? gain.first->leaves_W : direction_W;
  at.bent = gain.first.has_value();
  at.shadow = gain.first && gain.first->shadow;
  at.arrives_W = gain.first ? gain.first->arrives_W : direction_W;
  const double c_mps = medium_.sound_speed_mps(p_W);
  at.ended = started + from_seconds(to_seconds(signal.duration) / doppler(at, leaves_W, c_mps, to, transmission));

  // Losses of the link.
  Decibels level = signal.source_level - link_losses(config_.links, transmission.source, to.full_name()).loss;
  // Directivity at both ends.
  const auto add_beam = [&](const DirectivityConfig& beam, const auto& direction_S) {
    if (beam.pattern != DirectivityConfig::Pattern::omni)
      level += directivity_gain(beam, direction_S(), signal.centre_Hz, c_mps);
  };
  add_beam(transmission.directivity, [&] { return Vector3d(transmission.R_WS.transpose() * leaves_W); });
  add_beam(to.config().directivity, [&] { return Vector3d(-(to.R_WS().transpose() * at.arrives_W)); });
  at.level = level + gain.signal;
  at.later_s = gain.later_s;
  at.echoes = std::move(gain.echoes);
  at.blocked = gain.blocked && gain.signal.dB() < lowest_dB;
  if (gain.disturbing.linear() > 0) at.disturbing = to_power(level) * gain.disturbing;
  return at;
}

const Propagation::Gain::Echo* SonarEquation::echo_lock(Decibels snr, const Transducer& to,
                                                        const Transmission& transmission,
                                                        const std::vector<Propagation::Gain::Echo>& echoes) const {
  if (echoes.empty()) return nullptr;
  const EchoLockConfig& config = *config_.echo_lock;
  const double over_dB = std::max(0.0, snr.dB() - to.config().detection_dB);
  const double at_most = config.probability * std::exp(-over_dB / config.margin_dB);
  Random random(seed_, transmission.source + ">" + to.full_name() + "#echo");
  random.begin_step(transmission.sequence);
  for (const Propagation::Gain::Echo& echo : echoes) {
    const double luck = random.uniform();
    // Nearer than the resolution of the signal an echo is part of the first arrival.
    const bool resolved = echo.later_s * transmission.signal.bandwidth_Hz >= 1;
    if (resolved && luck < at_most * std::min(1.0, echo.relative.linear())) return &echo;
  }
  return nullptr;
}

SignalLoss SonarEquation::lost(const Transducer& to, const Transmission& transmission,
                               const SignalReceiver::Outcome& outcome, SignalLoss before) const {
  SignalLoss loss = before;
  Random random = stream(to, transmission, true);
  const double luck = random.uniform();
  const double link_luck = random.uniform();
  if (luck > outcome.success) loss = luck > outcome.success_alone ? SignalLoss::noise : SignalLoss::interference;
  const LinkLosses link = link_losses(config_.links, transmission.source, to.full_name());
  if (loss == SignalLoss::none && link_luck < link.probability) loss = SignalLoss::link;
  return loss;
}

}  // namespace sim
