// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/bus/message_gate.hpp"
#include "sim/run/lockstep.hpp"

namespace sim {

/// Orders the messages at a gate independently of the network: first the messages that clients list as published, by
/// client name and in the order of the list; then all others.
///
/// The sender of a message is unknown.  Therefore, for each listed message, one unlisted message with the same channel
/// and bytes is dropped: within repeat_windows, because the network may have duplicated it, and within late_windows
/// when the listed message is still in transit.
class ClientMessages {
 public:
  /// `gate` must outlive this.
  explicit ClientMessages(MessageGate& gate) : gate_(gate) {}

  /// Sets the messages that a client lists as published since its previous answer.  Channels without a reader at the
  /// gate are left out.
  void expect(const std::string& client, const std::vector<NamedMessage>& named);
  /// Collects the messages that have arrived. Call it before is_complete().
  void collect();
  bool is_complete(const std::string& client) const;
  /// Index, in the list given to expect(), of the first missing message; -1: none is missing.
  std::int32_t first_missing(const std::string& client) const;
  /// Returns the channels of the missing messages of the list, one for each message.
  std::vector<std::string> missing_channels(const std::string& client) const;
  /// Returns the number of missing messages of the list, and the first: `2 of the 3 messages that it lists were not
  /// received, first 'a.cmd' with CRC-32 1a2b3c4d`.  Empty: none is missing.
  std::string missing_text(const std::string& client) const;
  /// Adds a message of the list that was sent again.  Returns false when it is not the one that was named.  A message
  /// that arrives after the list was complete and admitted is ignored.
  bool add(const std::string& client, std::int32_t place, const std::string& channel, const Bytes& payload);
  /// Returns why add() refuses a message: `sends again 'a.cmd' with CRC-32 ... at place 2, but named ...`.
  std::string why_not(const std::string& client, std::int32_t place, const std::string& channel,
                      const Bytes& payload) const;
  /// Stops waiting for missing messages.
  void give_up(const std::string& client);
  /// Orders the messages of the step that starts; for MessageGate::set_order.
  void order(std::vector<MessageGate::Delivery>& messages);
  /// Discards what has arrived. Messages that clients have listed and that are still in transit are dropped on arrival.
  void clear();
  /// Drops what a client listed for an abandoned tick, even when it arrives later.
  void drop(const std::string& client, const std::vector<NamedMessage>& named);
  /// Drops the unlisted messages that have arrived: they may be from a client without a list, for an abandoned tick.
  void drop_unnamed();
  /// Starts another window; to be called at equal intervals.
  void next_window();
  /// Duplicate of a message of a client, which was dropped.
  struct Repeated {
    std::string client, channel;
  };
  /// Returns the first dropped duplicate since the last call.
  std::optional<Repeated> take_repeated();
  // / Returns the number of dropped duplicates by client.
  const std::map<std::string, std::uint64_t, std::less<>>& repeated() const { return repeated_; }
  /// Messages dropped from full queues before they were admitted.
  std::uint64_t dropped() const { return dropped_; }

  /// Limits of queued unlisted messages: number per channel, and total bytes.
  static constexpr std::size_t max_of_channel = 10'000;
  static constexpr std::size_t max_bytes = 256'000'000;
  static constexpr std::int64_t repeat_windows = 1, late_windows = 10;
  /// Limit of repeated(); further clients are not counted.
  static constexpr std::size_t max_names = 2000;

 private:
  static constexpr std::size_t max_twins = 50'000;

  struct Expected {
    NamedMessage named;
    bool is_read = false;  ///< the channel has a reader
    bool there = false;
    bool sent_again = false;  ///< the first copy may still be in transit
    Bytes payload;
  };
  struct Stray {
    MessageGate::Delivery message;
    std::uint32_t crc;
  };
  using Key = std::pair<std::string, std::uint32_t>;  // channel and CRC-32
  /// Duplicate message to be dropped once, on arrival.
  struct Twin {
    std::string client;
    std::int64_t last_window;
    bool counts;  ///< as repeated; false: its tick was abandoned
  };
  using Strays = std::map<std::uint64_t, Stray>;  // by arrival

  void take(std::vector<MessageGate::Delivery>& messages);
  void match(std::vector<Expected>& list);
  void expect_twin(const std::string& client, const NamedMessage& named, std::int64_t windows, bool counts);
  bool is_twin(const Stray& stray);
  void discard_strays();
  /// Removes and returns a stray message.
  Stray take_out(Strays::iterator stray);
  void drop_oldest(std::uint64_t arrival);

  MessageGate& gate_;
  std::map<std::string, std::vector<Expected>, std::less<>> expected_;
  Strays strays_;  // arrived, not listed by any client yet
  std::map<Key, std::set<std::uint64_t>> by_key_;
  std::map<std::string, std::set<std::uint64_t>, std::less<>> by_channel_;
  std::size_t stray_bytes_ = 0;
  std::uint64_t arrivals_ = 0;
  std::multimap<Key, Twin> twins_;
  std::int64_t window_ = 0;
  std::map<std::string, std::uint64_t, std::less<>> repeated_;
  std::optional<Repeated> first_repeated_;
  std::uint64_t dropped_ = 0;
};

}  // namespace sim
