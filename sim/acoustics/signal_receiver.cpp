#include "sim/acoustics/signal_receiver.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// The part of a sound's power that falls into the band of another.
double share_in_band(const PresentSound& of, const PresentSound& band) {
  const double low_Hz = std::max(of.centre_Hz - of.bandwidth_Hz / 2, band.centre_Hz - band.bandwidth_Hz / 2);
  const double high_Hz = std::min(of.centre_Hz + of.bandwidth_Hz / 2, band.centre_Hz + band.bandwidth_Hz / 2);
  return std::clamp((high_Hz - low_Hz) / of.bandwidth_Hz, 0.0, 1.0);
}

}  // namespace

PowerRatio SignalReceiver::others(const PresentSound& but) const {
  PowerRatio sum{0};
  for (const PresentSound& sound : present_)
    if (sound.flight != but.flight) sum += share_in_band(sound, but) * sound.power;
  return sum;
}

void SignalReceiver::count_bits(Time until) {
  if (!taking() || until <= counted_until_) return;
  const TakenSignal& taken = taken_;
  const double span = to_seconds(std::min(until, taken.ended) - counted_until_);
  const double whole = to_seconds(taken.ended - taken.begun);
  counted_until_ = until;
  const PowerRatio alone = taken.sound.power / (taken.noise + taken.disturbing);
  const PowerRatio sinr = taken.sound.power / (taken.noise + taken.disturbing + others(taken.sound));
  if (sinr < worst_sinr_) worst_sinr_ = sinr;
  if (taken.bits == 0 || whole <= 0 || span <= 0) return;
  const double bits = static_cast<double>(taken.bits) * span / whole;
  const PowerRatio code = to_power(Decibels{taken.coding_gain_dB});
  const auto log_right = [&](PowerRatio snr) {
    const PowerRatio EbN0 = energy_per_bit(snr, taken.sound.bandwidth_Hz, taken.bit_rate_bps) * code;
    return bits * std::log1p(-bit_error_probability(taken.modulation, EbN0));
  };
  log_success_ += log_right(sinr);
  log_success_alone_ += log_right(alone);
}

void SignalReceiver::begin(const PresentSound& sound, Time at) {
  count_bits(at);
  present_.push_back(sound);
}

SignalLoss SignalReceiver::take(const TakenSignal& signal, const Rules& rules, std::int64_t& displaced) {
  displaced = -1;
  const PowerRatio needed = to_power(Decibels{rules.detection_dB});
  const PowerRatio still = signal.noise + signal.disturbing;
  if (signal.sound.power / still < needed) return SignalLoss::noise;
  const bool noticed = signal.sound.power / (still + others(signal.sound)) >= needed;
  if (taking()) {
    const PowerRatio stronger = signal.sound.power / taken_.sound.power;
    if (!noticed || stronger < to_power(Decibels{rules.capture_dB})) return SignalLoss::busy;
    displaced = taken_.sound.flight;
  } else if (!noticed) {
    return SignalLoss::interference;
  }
  taken_ = signal;
  counted_until_ = signal.begun;
  log_success_ = log_success_alone_ = 0;
  worst_sinr_ = signal.sound.power / still;
  return SignalLoss::none;
}

bool SignalReceiver::end(std::int64_t flight, Time at, Outcome& outcome) {
  count_bits(at);
  const bool was_taken = taken_.sound.flight == flight;
  if (was_taken) {
    outcome = {std::exp(log_success_), std::exp(log_success_alone_), worst_sinr_};
    taken_ = {};
  }
  std::erase_if(present_, [&](const PresentSound& sound) { return sound.flight == flight; });
  return was_taken;
}

std::int64_t SignalReceiver::drop() {
  const std::int64_t flight = taken_.sound.flight;
  taken_ = {};
  return flight;
}

void SignalReceiver::hash_state(StateHash& hash) const {
  hash.add(static_cast<std::uint64_t>(present_.size()));
  for (const PresentSound& sound : present_) {
    hash.add(sound.flight);
    hash.add(sound.power.linear());
  }
  hash.add(taken_.sound.flight);
  hash.add(static_cast<std::int64_t>(counted_until_.count()));
  hash.add(log_success_);
  hash.add(log_success_alone_);
}

}  // namespace sim
