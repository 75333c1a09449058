// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/receiver_search.hpp"

#include <algorithm>
#include <limits>

namespace sim {

namespace {

/// Validity of the grid, and the distance that no transducer moves farther in this time or while a sound travels.
constexpr double valid_s = 1;
constexpr double max_motion_m = 150;

}  // namespace

double ReceiverSearch::update_range(const Signal& signal, Time now) {
  const bool anew = searched_at_s_ < 0 || to_seconds(now) - searched_at_s_ > valid_s;
  std::vector<Neighborhood::Member> members;
  if (anew) {
    lowest_m_ = std::numeric_limits<double>::infinity();
    transducers_.for_each([&](const Transducer& each) {
      members.push_back({each.number(), each.p_W(now)});
      lowest_m_ = std::min(lowest_m_, members.back().p_W.z());
    });
    examined_ += transducers_.count();
    searched_at_s_ = to_seconds(now);
  }
  const double deepest_m = medium_.highest_surface_m() - lowest_m_ + max_motion_m;
  const double range_m = propagation_.audible_range_m(signal, min_level(signal.centre_Hz), deepest_m);
  if (anew) places_.build(members, range_m);
  return range_m + max_motion_m;
}

const std::vector<Transducer*>& ReceiverSearch::receivers(const Transmission& transmission, double range_m) {
  places_.near(transmission.p_W, range_m, near_);
  examined_ += static_cast<std::int64_t>(near_.size());
  receivers_.clear();
  for (const int number : near_) {
    Transducer* const to = transducers_.at(number);
    if (to != nullptr && to != transmission.from && (to->p_W(transmission.sent) - transmission.p_W).norm() <= range_m)
      receivers_.push_back(to);
  }
  return receivers_;
}

Decibels ReceiverSearch::min_level(double frequency_Hz) {
  for (const auto& [known_Hz, below] : min_levels_)
    if (known_Hz == frequency_Hz) return below;
  const Decibels below = compute_min_level(frequency_Hz);
  constexpr std::size_t max_frequencies = 64;
  if (min_levels_.size() < max_frequencies) min_levels_.emplace_back(frequency_Hz, below);
  return below;
}

/// Margin below the noise within which a signal can affect a receiver.
Decibels ReceiverSearch::compute_min_level(double frequency_Hz) {
  examined_ += transducers_.count();
  double below_dB = config_.negligible_dB;
  transducers_.for_each([&](const Transducer& each) {
    below_dB = std::max(below_dB, each.noise_reduction(frequency_Hz).dB() - each.config().detection_dB);
  });
  double gain_dB = 0;
  for (const LinkConfig& link : config_.links) gain_dB += std::max(0.0, -link.extra_loss_dB);
  // Margin for fading: exceeded by at most one signal in fifty.
  if (config_.fading.type == FadingConfig::Type::rayleigh) gain_dB += 6;
  if (config_.fading.type == FadingConfig::Type::log_normal) gain_dB += 2 * config_.fading.std_dB;
  return Decibels{below_dB + gain_dB};
}

void ReceiverSearch::visit_state(StateArchive& archive) {
  archive.unhashed(places_, searched_at_s_);
  if (!archive.hashing()) archive.not_only_finite(lowest_m_);  // infinity: without a receiver
}

void ReceiverSearch::check(const StateArchive& archive) const {
  // Numbers of removed transducers stay in the grid until it is rebuilt, which a negative time requests.
  const bool in_use = !(searched_at_s_ < 0);
  if (in_use && !places_.numbers_are_below(transducers_.all().size())) archive.fail("a neighbor that does not exist");
}

}  // namespace sim
