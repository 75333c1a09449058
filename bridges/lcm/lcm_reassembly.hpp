// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/bus/bus.hpp"

namespace bridges {

/// The first four bytes of a datagram: a message in one, "LC02", or a fragment of one, "LC03".
inline constexpr std::uint32_t short_magic = 0x4c433032, fragment_magic = 0x4c433033;

/// Who sent a datagram; two processes of one machine differ in the port.
struct DatagramSender {
  std::uint32_t address = 0;  ///< IPv4, in host byte order
  std::uint16_t port = 0;
};

/// Makes messages of the datagrams of LCM's udpm (format of LCM 1.3.1): a message in one datagram ("LC02"), or in
/// fragments ("LC03").  Validates every field of a datagram; memory is bounded for any input.  No sockets, no clock.
///
/// A sender has at most one message under way; its next one ends it.  As in liblcm, fragments before the one that
/// names the channel are dropped; other fragments may be reordered within `max_early_bytes`.  The parts of
/// the payload must follow each other without gap or overlap; a repeated fragment is ignored.
class LcmReassembly {
 public:
  struct Limits {
    std::size_t max_message_bytes = std::size_t{16} << 20;
    std::size_t max_early_bytes = std::size_t{1} << 20;  ///< of a message, ahead of a fragment that is missing
    std::size_t max_partial_messages = 256;              ///< of all senders; then the one longest untouched is dropped
    std::size_t max_partial_bytes = std::size_t{64} << 20;  ///< memory of all partial messages; then likewise
  };
  /// Valid until the next call of add().
  struct Message {
    std::string_view channel;  ///< 1 to 63 bytes, none of them 0
    std::span<const std::byte> payload;
  };
  struct Counts {
    std::uint64_t bad = 0;      ///< datagrams that break the format
    std::uint64_t dropped = 0;  ///< partial messages that gave place to others
  };

  LcmReassembly() : LcmReassembly(Limits{}) {}
  explicit LcmReassembly(const Limits& limits) : limits_(limits) {}

  /// The message that this datagram completes.  `wanted` filters by channel before memory is used for a fragmented
  /// message; empty: accepts all.
  std::optional<Message> add(std::span<const std::byte> datagram, const DatagramSender& from,
                             const std::function<bool(std::string_view)>& accepts = {});

  const Counts& counts() const { return counts_; }
  std::size_t partial_messages() const { return partial_.size(); }
  std::size_t partial_bytes() const { return partial_bytes_; }

 private:
  struct Fragment {
    std::uint32_t sequence, message_bytes, offset;
    std::uint16_t number, count;
    std::span<const std::byte> part;  ///< fragment 0: without the channel
  };
  struct Early {
    std::uint32_t offset = 0;
    sim::Bytes part;
  };
  struct Partial {
    std::string channel;
    std::uint32_t sequence = 0, message_bytes = 0;
    std::uint16_t next = 0, count = 0;  ///< `next`: number of the fragment that continues the payload
    sim::Bytes payload;
    std::map<std::uint16_t, Early> early;
    std::size_t early_bytes = 0;
    std::uint64_t touched_at = 0;  ///< number of the datagram
    std::size_t bytes() const;
    void add(std::span<const std::byte> part);  ///< of fragment `next`
  };
  using Partials = std::map<std::uint64_t, Partial>;  // by sender

  std::optional<Message> add_short(std::span<const std::byte> datagram);
  std::optional<Message> add_fragment(std::span<const std::byte> datagram, std::uint64_t sender,
                                      const std::function<bool(std::string_view)>& accepts);
  Partials::iterator start_message(std::uint64_t sender, std::string_view channel, const Fragment& fragment);
  /// False when the fragment contradicts the others of its message.
  bool append(Partial& partial, const Fragment& fragment);
  bool keep_early(Partial& partial, const Fragment& fragment);
  void drop(Partials::iterator partial);
  /// Drops messages other than `keep` until the limits are met.
  void make_room(std::uint64_t keep);
  std::nullopt_t bad();

  Limits limits_;
  Partials partial_;
  std::size_t partial_bytes_ = 0;  // of all in partial_
  std::uint64_t datagrams_ = 0;
  std::string channel_;  // of the last message in fragments
  sim::Bytes payload_;
  Counts counts_;
};

}  // namespace bridges
