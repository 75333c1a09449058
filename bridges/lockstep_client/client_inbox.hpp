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

/// What comes for a lockstep client, until a tick names it: then it is handled in the order of that list.
class ClientInbox {
 public:
  using Handle = std::function<void(const std::string& channel, std::span<const std::byte> payload)>;
  struct Counts {
    std::uint64_t asked_for = 0;  ///< messages that arrived only after a request
    std::uint64_t repeated = 0;   ///< messages that came again, and were dropped
    std::uint64_t unnamed = 0;    ///< messages that no tick named: of senders that the simulator does not receive
  };

  /// Not a channel of the handshake, or of what reports it.
  static bool is_named(std::string_view channel);
  /// A channel whose messages ticks name; they do so by its place.
  void add_channel(const std::string& channel);
  const std::vector<std::string>& channels() const { return names_; }
  /// False: on none of these channels, and left as it is.
  bool hold(Received& message);

  /// A tick came.  False: it names an unknown channel, and changes nothing.
  bool expect(const shoal::sim_due_t& due);
  /// All that the tick names has come.
  bool complete();
  /// Place in the list of the tick.
  std::int32_t first_missing() const;
  /// Messages of the list from `first` on, which were sent again.
  void add(std::int32_t first, const std::vector<shoal::sim_payload_t>& messages);
  /// Handles what the tick names, then what no tick has named for a while.
  void hand_over(const Handle& handle);

  /// Discards messages that no tick has listed.
  void drop_held();
  /// Also forgets the handled messages: they may arrive again.
  void discard();
  const Counts& counts() const { return counts_; }

 private:
  struct Held {
    std::uint32_t crc;
    sim::Bytes payload;
    int ticks = 0;  ///< that did not name it
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
  std::vector<Named> named_;            // by the tick, in its order
  std::set<Key> recent_;                // handled a short time ago
  std::deque<Key> recent_order_;
  std::set<Key> early_;  // of those: handled although no tick had named them
  Counts counts_;
};

}  // namespace bridges
