// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/signal_receiver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/record_hash.hpp"

namespace sim {

namespace {

/// Fraction of a sound's power in the band of another.
inline double share_in_band(const PresentSound& of, const PresentSound& band) {
  if (of.centre_Hz == band.centre_Hz && of.bandwidth_Hz == band.bandwidth_Hz) return 1;
  const double low_Hz = std::max(of.centre_Hz - of.bandwidth_Hz / 2, band.centre_Hz - band.bandwidth_Hz / 2);
  const double high_Hz = std::min(of.centre_Hz + of.bandwidth_Hz / 2, band.centre_Hz + band.bandwidth_Hz / 2);
  return std::clamp((high_Hz - low_Hz) / of.bandwidth_Hz, 0.0, 1.0);
}

}  // namespace

void PresentSound::visit_state(StateArchive& archive) {
  // In 64 bits; a number that does not fit does not exist either, which flights_are_below() finds.
  std::int64_t number = flight.number;
  archive(number, centre_Hz, bandwidth_Hz, power, ended, message);
  if (archive.restoring())
    flight = {static_cast<int>(std::clamp<std::int64_t>(number, -1, std::numeric_limits<int>::max()))};
}

SignalReceiver::Others SignalReceiver::others(const PresentSound& but, Time at) const {
  Others sum;
  for (const PresentSound& sound : present()) {
    if (sound.flight == but.flight || sound.ended <= at) continue;
    const PowerRatio power = share_in_band(sound, but) * sound.power;
    sum.all += power;
    if (sound.message) sum.messages += power;
  }
  return sum;
}

bool SignalReceiver::is_detectable(const TakenSignal& signal, PowerRatio needed) const {
  const PowerRatio still = signal.noise + signal.disturbing;
  PowerRatio sum{0};
  // A sum of powers never decreases, rounded or not, so that the loop can end as soon as it is too large.
  constexpr std::size_t check_interval = 8;
  const std::span<const PresentSound> sounds = present();
  for (std::size_t i = 0; i < sounds.size();) {
    const std::size_t end = std::min(i + check_interval, sounds.size());
    for (; i < end; ++i) {
      const PresentSound& sound = sounds[i];
      if (sound.flight != signal.sound.flight && sound.ended > signal.started)
        sum += share_in_band(sound, signal.sound) * sound.power;
    }
    if (!(signal.sound.power / (still + sum) >= needed)) return false;
  }
  return signal.sound.power / (still + sum) >= needed;
}

void SignalReceiver::count_bits(Time until) {
  for (Taken& taken : taken_) count_bits(taken, until);
}

void SignalReceiver::count_bits(Taken& taken, Time until) const {
  if (until <= taken.counted_until) return;
  const TakenSignal& signal = taken.signal;
  const double span = to_seconds(std::min(until, signal.ended) - taken.counted_until);
  const double whole = to_seconds(signal.ended - signal.started);
  const Others other = others(signal.sound, taken.counted_until);
  taken.counted_until = until;
  const PowerRatio alone = signal.sound.power / (signal.noise + signal.disturbing);
  const PowerRatio sinr = signal.sound.power / (signal.noise + signal.disturbing + other.all);
  if (sinr < taken.worst_sinr) taken.worst_sinr = sinr;
  if (signal.bits == 0 || whole <= 0 || span <= 0) return;
  const double bits = static_cast<double>(signal.bits) * span / whole;
  const PowerRatio code = to_power(Decibels{signal.coding_gain_dB});
  const auto log_right = [&](PowerRatio snr) {
    const PowerRatio EbN0 = energy_per_bit(snr, signal.sound.bandwidth_Hz, signal.bit_rate_bps) * code;
    return bits * std::log1p(-bit_error_probability(signal.modulation, EbN0));
  };
  const bool drowned = signal.sound.power < signal.protection * other.messages;
  taken.log_success += drowned ? bits * std::log(0.5) : log_right(sinr);
  taken.log_success_alone += log_right(alone);
}

void SignalReceiver::begin(const PresentSound& sound, Time at) {
  count_bits(at);
  present_.push_back(sound);
  present_sum_ += hash_of(sound);
}

SignalLoss SignalReceiver::take(const TakenSignal& signal, const Rules& rules, FlightId& displaced) {
  displaced = {};
  // Test detection against noise, then against other sounds.
  const PowerRatio needed = to_power(Decibels{rules.detection_dB});
  const PowerRatio still = signal.noise + signal.disturbing;
  if (signal.sound.power / still < needed) return SignalLoss::noise;
  const bool detected = is_detectable(signal, needed);
  // Find the reception in the same band.
  auto rival = taken_.end();
  for (auto each = taken_.begin(); each != taken_.end(); ++each) {
    // A signal that ends when this one starts is not a rival.
    if (each->signal.ended <= signal.started || share_in_band(each->signal.sound, signal.sound) <= 0) continue;
    if (rival != taken_.end()) return SignalLoss::busy;
    rival = each;
  }
  // Capture the receiver, or lock on to the signal.
  if (rival != taken_.end()) {
    const PowerRatio stronger = signal.sound.power / rival->signal.sound.power;
    if (!detected || stronger < to_power(Decibels{rules.capture_dB})) return SignalLoss::busy;
    displaced = rival->signal.sound.flight;
    taken_.erase(rival);
  } else if (!detected) {
    return SignalLoss::interference;
  }
  taken_.push_back({signal, signal.started, 0, 0, signal.sound.power / still});
  return SignalLoss::none;
}

void SignalReceiver::set_noise(FlightId flight, PowerRatio noise, Time at) {
  for (Taken& taken : taken_)
    if (taken.signal.sound.flight == flight) {
      count_bits(taken, at);
      taken.signal.noise = noise;
    }
}

bool SignalReceiver::flights_are_below(std::size_t count) const {
  const auto below = [&](const PresentSound& sound) {
    return sound.flight.valid() && static_cast<std::size_t>(sound.flight.number) < count;
  };
  return std::all_of(present().begin(), present().end(), below) &&
         std::all_of(taken_.begin(), taken_.end(), [&](const Taken& taken) { return below(taken.signal.sound); });
}

bool SignalReceiver::takes(FlightId flight) const {
  return std::any_of(taken_.begin(), taken_.end(),
                     [&](const Taken& taken) { return taken.signal.sound.flight == flight; });
}

void SignalReceiver::silence(FlightId flight, Time at) {
  count_bits(at);
  for (PresentSound& sound : present()) {
    if (sound.flight != flight) continue;
    present_sum_ -= hash_of(sound);
    sound.power = PowerRatio{0};
    present_sum_ += hash_of(sound);
  }
  for (Taken& taken : taken_)
    if (taken.signal.sound.flight == flight) taken.signal.sound.power = taken.signal.disturbing = PowerRatio{0};
}

bool SignalReceiver::end(FlightId flight, Time at, Outcome& outcome) {
  count_bits(at);
  const auto taken =
      std::find_if(taken_.begin(), taken_.end(), [&](const Taken& each) { return each.signal.sound.flight == flight; });
  const bool was_taken = taken != taken_.end();
  if (was_taken) {
    outcome = {std::exp(taken->log_success), std::exp(taken->log_success_alone), taken->worst_sinr};
    taken_.erase(taken);
  }
  const std::span<PresentSound> sounds = present();
  const auto removed =
      std::find_if(sounds.begin(), sounds.end(), [&](const PresentSound& each) { return each.flight == flight; });
  if (removed == sounds.end()) return was_taken;
  present_sum_ -= hash_of(*removed);
  std::move_backward(sounds.begin(), removed, removed + 1);
  ++first_;
  if (4 * first_ >= present_.size()) drop_ended();
  return was_taken;
}

FlightId SignalReceiver::drop() {
  if (taken_.empty()) return {};
  const FlightId flight = taken_.back().signal.sound.flight;
  taken_.pop_back();
  return flight;
}

void SignalReceiver::drop_ended() {
  present_.erase(present_.begin(), present_.begin() + static_cast<std::ptrdiff_t>(first_));
  first_ = 0;
}

void SignalReceiver::visit_state(StateArchive& archive) {
  drop_ended();
  archive(present_, taken_);
  if (!archive.restoring()) return;
  present_sum_ = 0;
  for (const PresentSound& sound : present_) present_sum_ += hash_of(sound);
}

void SignalReceiver::add_content(StateArchive& hash) {
  auto sounds = static_cast<std::uint64_t>(present().size());
  hash(sounds, present_sum_, taken_);
}

std::uint64_t SignalReceiver::hash_of(const PresentSound& sound) {
  return record_hash({static_cast<std::uint64_t>(sound.flight.number), static_cast<std::uint64_t>(sound.ended.count()),
                      word_of(sound.power.linear()), word_of(sound.centre_Hz), word_of(sound.bandwidth_Hz),
                      static_cast<std::uint64_t>(sound.message)});
}

}  // namespace sim
