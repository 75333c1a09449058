// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "bridges/signing/run_key.hpp"
#include "bridges/signing/signed_message.hpp"
#include "sim/bus/bus.hpp"

namespace bridges {

/// How a message is refused that must be signed and is not.
inline constexpr const char* needs_key_text =
    "this run can only be controlled with its key: use --run DIR, or set SHOAL_RUN_KEY; see "
    "docs/guides/access_control.md";

/// Entry point of the messages that control a run: unwraps signed messages, and verifies their senders when the run
/// has a key.  One for all buses of a run: a message is accepted once, from the bus on which it arrives first.
///   Not part of the state of the world: a rewind must not make a captured message valid again.
class ControlGuard {
 public:
  struct Opened {
    sim::Bytes content;        ///< the message itself
    std::string signer;        ///< who sent it, with the key of the run; empty: not signed, or not checked
    std::string refusal;       ///< why it must not be executed; empty: it may
    bool came_before = false;  ///< rejected as a repetition, by a sender or the network
  };
  /// Senders whose counters are kept; the least recently seen one is replaced.
  static constexpr std::size_t max_senders = 10'000;

  /// From now on only messages that are signed with this key are to be executed.
  void require(const RunKey& key) { key_ = key; }
  bool requires_key() const { return key_.has_value(); }

  /// Throws shoal::MessageError when the envelope cannot be read.
  Opened open(std::string_view channel, std::span<const std::byte> payload);

 private:
  using Name = std::pair<std::string, std::int64_t>;  // sender and session
  struct Sender {
    std::map<std::string, std::int64_t, std::less<>> counters;  // the last, by channel
    std::list<Name>::iterator place;
  };

  /// Why it is refused; empty: it is new.  Notes the counter.
  std::string refusal_of(const SignedMessage& message, std::string_view channel, bool& came_before);
  void make_room();

  std::optional<RunKey> key_;
  std::map<Name, Sender> senders_;
  std::list<Name> by_age_;  // received the longest time ago first
  std::int64_t floor_ = 0;  // no sender that made room had a greater counter
};

}  // namespace bridges
