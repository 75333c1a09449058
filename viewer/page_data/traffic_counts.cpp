// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/traffic_counts.hpp"

#include <algorithm>

#include "shoal/message_codec.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/sim_sound_arrival_t.hpp"
#include "shoal/sim_sound_t.hpp"

namespace viewer {

namespace {

template <typename Message>
bool is_of_type(std::uint64_t fingerprint) {
  static const auto own = static_cast<std::uint64_t>(Message::getHash());
  return fingerprint == own;
}

}  // namespace

std::string_view prefix_of(std::string_view channel) {
  const std::size_t dot = channel.find('.');
  return dot == std::string_view::npos ? std::string_view() : channel.substr(0, dot);
}

void TrafficCounts::take(std::string_view channel, std::span<const std::byte> payload) {
  const auto fingerprint = static_cast<std::uint64_t>(shoal::fingerprint(payload));
  auto place = channels_.find(channel);
  if (place == channels_.end()) {
    if (channels_.size() >= max_channels) return;
    place = channels_.emplace(std::string(channel), Channel{}).first;
  }
  place->second.fingerprint = fingerprint;
  ++place->second.count;
  place->second.bytes += static_cast<std::int64_t>(payload.size());
  try {
    if (channel == "sim.sound")
      take_sound(payload);
    else if (channel == "sim.sound.arrival")
      take_arrival(payload);
    else if (is_of_type<shoal::modem_send_t>(fingerprint))
      take_radio_sent(channel, payload);
    else if (is_of_type<shoal::modem_received_t>(fingerprint))
      take_radio_received(channel, payload);
  } catch (const shoal::MessageError&) {  // invalid: counted as a message only
  }
}

void TrafficCounts::take_sound(std::span<const std::byte> payload) {
  const auto sound = shoal::decode<shoal::sim_sound_t>(payload, shoal::Finite::any);
  if (sound.kind == "noise") return;
  // Every receiver in range gets a result, whoever is meant.
  add_sent(sound.source, "");
  if (senders_.size() >= max_pairs && !senders_.contains(sound.source)) return;
  Sender& sender = senders_[sound.source];
  ++sender.count;
  sender.bytes += sound.bytes;
  // A damaged log must not overflow the sum.
  constexpr std::int64_t max_duration_us = 3'600'000'000;
  sender.sending_us += std::clamp<std::int64_t>(sound.duration_us, 0, max_duration_us);
}

void TrafficCounts::take_arrival(std::span<const std::byte> payload) {
  const auto arrival = shoal::decode<shoal::sim_sound_arrival_t>(payload, shoal::Finite::any);
  Pair* pair = pair_of(arrival.source, arrival.receiver);
  if (pair == nullptr) return;
  constexpr std::size_t max_outcomes = 32;
  if (arrival.outcome == "received")
    ++pair->received;
  else if (pair->lost.size() < max_outcomes || pair->lost.contains(arrival.outcome))
    ++pair->lost[arrival.outcome];
}

void TrafficCounts::take_radio_sent(std::string_view channel, std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::modem_send_t>(payload, shoal::Finite::any);
  add_sent(std::string(prefix_of(channel)), message.destination);
}

void TrafficCounts::take_radio_received(std::string_view channel, std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::modem_received_t>(payload, shoal::Finite::any);
  if (Pair* pair = pair_of(message.source, std::string(prefix_of(channel)))) ++pair->received;
}

void TrafficCounts::add_sent(const std::string& from, const std::string& to) {
  Names names{from, to};
  ++link_changes_;
  if (sent_.size() < max_pairs || sent_.contains(names)) ++sent_[std::move(names)];
}

TrafficCounts::Pair* TrafficCounts::pair_of(const std::string& from, const std::string& to) {
  Names names{from, to};
  ++link_changes_;
  if (pairs_.size() >= max_pairs && !pairs_.contains(names)) return nullptr;
  return &pairs_[std::move(names)];
}

std::int64_t TrafficCounts::sent(const Names& names) const {
  const auto to_all = sent_.find({names.first, ""});
  const auto to_one = names.second.empty() ? sent_.end() : sent_.find(names);
  return (to_all == sent_.end() ? 0 : to_all->second) + (to_one == sent_.end() ? 0 : to_one->second);
}

}  // namespace viewer
