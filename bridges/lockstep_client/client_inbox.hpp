// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/lcm/lcm_listener.hpp"
#include "shoal/sim_due_t.hpp"
#include "shoal/sim_payload_t.hpp"

namespace bridges {

/// Inbox of a lockstep client: holds messages until a tick names them, and handles them in the order of its list.
class ClientInbox {
 public:
  using Handle = std::function<void(const std::string& channel, std::span<const std::byte> payload)>;
  struct Counts {
    std::uint64_t requested = 0;  ///< messages that arrived only after a request
    std::uint64_t repeated = 0;   ///< duplicate messages, which were dropped
    std::uint64_t unnamed = 0;    ///< messages that no tick named, from senders that the simulator does not receive
  };

  /// Returns whether ticks list the messages of a channel: all channels except those of the handshake and its reports.
  static bool is_named(std::string_view channel);
  /// Adds a channel whose messages ticks name by its index.
  void add_channel(const std::string& channel);
  const std::vector<std::string>& channels() const { return names_; }
  /// Holds a message.  Returns false when it is on none of these channels; it is then unchanged.
  bool hold(Received& message);

  /// Sets the list of a tick.  Returns false when it names an unknown channel; nothing has then changed.
  bool expect(const shoal::sim_due_t& due);
  /// Returns whether all messages that the tick names have arrived.
  bool complete();
  /// Returns the index of the first missing message in the list of the tick.
  std::int32_t first_missing() const;
  /// Adds messages of the list, from index `first` on, that were sent again.
  void add(std::int32_t first, const std::vector<shoal::sim_payload_t>& messages);
  /// Handles the messages that the tick names, then those that no tick has named for several ticks.
  void hand_over(const Handle& handle);

  /// Discards messages that no tick has listed.
  void drop_held();
  /// Discards all messages, and the memory of handled ones, which may then arrive again.
  void discard();
  const Counts& counts() const { return counts_; }

 private:
  struct Held {
    std::uint32_t crc;
    sim::Bytes payload;
    int ticks = 0;  ///< number of ticks that did not name it
  };
  struct Named {
    std::size_t channel;
    std::uint32_t crc;
    bool there = false;
    sim::Bytes payload;
  };
  using Key = std::pair<std::size_t, std::uint32_t>;  // channel and CRC-32

  void hand_over_unnamed(const Handle& handle);
  void remember(const Key& key);

  std::vector<std::string> names_;
  std::map<std::string, std::size_t, std::less<>> places_;
  std::vector<std::deque<Held>> held_;  // by channel
  std::vector<Named> named_;            // messages named by the tick, in its order
  std::set<Key> recent_;                // handled a short time ago
  std::deque<Key> recent_order_;
  std::set<Key> early_;  // recent ones that were handled although no tick had named them
  Counts counts_;
};

}  // namespace bridges
