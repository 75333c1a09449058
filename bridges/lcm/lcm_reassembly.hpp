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

/// First four bytes of a datagram: complete message, "LC02", or fragment of a message, "LC03".
inline constexpr std::uint32_t short_magic = 0x4c433032, fragment_magic = 0x4c433033;

/// Sender of a datagram; two processes of one machine differ in the port.
struct DatagramSender {
  std::uint32_t address = 0;  ///< IPv4, in host byte order
  std::uint16_t port = 0;
};

/// Reassembly of messages from the datagrams of LCM's udpm (format of LCM 1.3.1): a message in one datagram ("LC02"),
/// or in fragments ("LC03").  Validates every field of a datagram; memory is bounded for any input.  No sockets, no
/// clock. At most one fragmented message of a sender is in progress; its next one discards it.  As in liblcm, fragments
/// before the one that names the channel are dropped; other fragments may be reordered within `max_early_bytes`.  The
/// parts of the payload must be consecutive, without gap or overlap; a repeated fragment is ignored.
class LcmReassembly {
 public:
  struct Limits {
    std::size_t max_message_bytes = std::size_t{16} << 20;
    std::size_t max_early_bytes = std::size_t{1}
                                  << 20;  ///< limit of buffered bytes after a missing fragment of a message
    std::size_t max_partial_messages =
        256;  ///< limit over all senders; beyond it, the least recently extended one is dropped
    std::size_t max_partial_bytes = std::size_t{64}
                                    << 20;  ///< memory limit of all partial messages; beyond it, as above
  };
  /// Valid until the next call of add().
  struct Message {
    std::string_view channel;  ///< 1 to 63 bytes, none of them 0
    std::span<const std::byte> payload;
  };
  struct Counts {
    std::uint64_t bad = 0;      ///< datagrams that break the format
    std::uint64_t dropped = 0;  ///< partial messages dropped because of the limits
  };

  LcmReassembly() : LcmReassembly(Limits{}) {}
  explicit LcmReassembly(const Limits& limits) : limits_(limits) {}

  /// Adds a datagram and returns the message that it completes, if any.  `accepts` filters by channel before memory is
  /// allocated for a fragmented message; empty: accepts all.
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
    std::uint64_t touched_at = 0;  ///< number of the last datagram
    std::size_t bytes() const;
    void add(std::span<const std::byte> part);  ///< appends the part of fragment `next`
  };
  using Partials = std::map<std::uint64_t, Partial>;  // by sender

  std::optional<Message> add_short(std::span<const std::byte> datagram);
  std::optional<Message> add_fragment(std::span<const std::byte> datagram, std::uint64_t sender,
                                      const std::function<bool(std::string_view)>& accepts);
  Partials::iterator start_message(std::uint64_t sender, std::string_view channel, const Fragment& fragment);
  /// Returns false when the fragment contradicts the others of its message.
  bool append(Partial& partial, const Fragment& fragment);
  bool keep_early(Partial& partial, const Fragment& fragment);
  void drop(Partials::iterator partial);
  /// Drops messages other than `keep` until the limits are met.
  void make_room(std::uint64_t keep);
  std::nullopt_t bad();

  Limits limits_;
  Partials partial_;
  std::size_t partial_bytes_ = 0;  // total of partial_
  std::uint64_t datagrams_ = 0;
  std::string channel_;  // channel of the last fragmented message
  sim::Bytes payload_;
  Counts counts_;
};

}  // namespace bridges
