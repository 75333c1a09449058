// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace viewer {

/// Counts of the messages on each channel, and of who received from whom.  A vehicle or device receives from another by
/// sound
/// (`sim.sound`, `sim.sound.arrival`) or by radio (`shoal.modem_received_t`).
class TrafficCounts {
 public:
  /// Maximum number of channels, and of pairs; further ones are left out.
  static constexpr std::size_t max_channels = 10'000, max_pairs = 20'000;

  struct Channel {
    std::uint64_t fingerprint = 0;  ///< of the newest message
    std::int64_t count = 0, bytes = 0;
  };
  struct Pair {
    std::int64_t received = 0;
    std::map<std::string, std::int64_t, std::less<>> lost;  ///< by outcome
  };
  /// Acoustic transmissions of a device.
  struct Sender {
    std::int64_t count = 0, bytes = 0;
    std::int64_t sending_us = 0;  ///< sum of the durations
  };
  /// Sender and receiver: devices by sound, vehicles by radio.
  using Names = std::pair<std::string, std::string>;

  /// Counts a message.
  void take(std::string_view channel, std::span<const std::byte> payload);

  const auto& channels() const { return channels_; }
  const std::map<Names, Pair>& pairs() const { return pairs_; }
  /// Returns the senders of sounds, except noise, by the names of the devices.
  const std::map<std::string, Sender>& senders() const { return senders_; }
  /// Returns how many messages a sender has transmitted to a receiver or to all.
  std::int64_t sent(const Names& names) const;
  /// Returns a number that rises with each sound and each radio message.
  std::int64_t link_changes() const { return link_changes_; }

 private:
  friend class TrafficHistory;
  struct TextHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
  };

  void take_sound(std::span<const std::byte> payload);
  void take_arrival(std::span<const std::byte> payload);
  void take_radio_sent(std::string_view channel, std::span<const std::byte> payload);
  void take_radio_received(std::string_view channel, std::span<const std::byte> payload);
  void add_sent(const std::string& from, const std::string& to);
  Pair* pair_of(const std::string& from, const std::string& to);

  std::unordered_map<std::string, Channel, TextHash, std::equal_to<>> channels_;
  std::map<Names, Pair> pairs_;
  std::map<Names, std::int64_t> sent_;  // to: empty for all
  std::map<std::string, Sender> senders_;
  std::int64_t link_changes_ = 0;
};

/// Returns the part of a channel before its first dot: by default the name of its vehicle.
std::string_view prefix_of(std::string_view channel);

}  // namespace viewer
