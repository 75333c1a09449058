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

/// Reason of the refusal of an unsigned message that must be signed.
inline constexpr const char* needs_key_text =
    "this run can only be controlled with its key: use --run DIR, or set SHOAL_RUN_KEY; see "
    "docs/guides/access_control.md";

/// Entry point of the messages that control a run: unwraps signed messages, and verifies their senders when the run
/// has a key.  One for all buses of a run: a message is accepted once, from the bus on which it arrives first.
///   Not part of the state of the world: a rewind must not make a captured message valid again.
class ControlGuard {
 public:
  struct Opened {
    sim::Bytes content;        ///< enclosed message
    std::string signer;        ///< sender, verified with the key of the run; empty: not signed, or not checked
    std::string refusal;       ///< reason of the refusal; empty: it may be executed
    bool came_before = false;  ///< refused as a repetition, by a sender or the network
  };
  /// Maximum number of senders whose counters are stored; the least recently seen one is replaced.
  static constexpr std::size_t max_senders = 10'000;

  /// Requires a signature: from now on only messages signed with this key are executed.
  void require(const RunKey& key) { key_ = key; }
  bool requires_key() const { return key_.has_value(); }

  /// Unwraps and verifies a message.  Throws shoal::MessageError when the envelope cannot be read.
  Opened open(std::string_view channel, std::span<const std::byte> payload);

 private:
  using Name = std::pair<std::string, std::int64_t>;  // sender and session
  struct Sender {
    std::map<std::string, std::int64_t, std::less<>> counters;  // last counter by channel
    std::list<Name>::iterator place;
  };

  /// Returns why a message is refused; empty when it is new.  Records its counter.
  std::string refusal_of(const SignedMessage& message, std::string_view channel, bool& came_before);
  void make_room();

  std::optional<RunKey> key_;
  std::map<Name, Sender> senders_;
  std::list<Name> by_age_;  // least recently seen first
  std::int64_t floor_ = 0;  // largest counter of all replaced senders
};

}  // namespace bridges
