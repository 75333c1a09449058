// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "bridges/signing/run_key.hpp"
#include "sim/bus/bus.hpp"

namespace bridges {

/// Content of a shoal.sim_signed_t.
struct SignedMessage {
  std::int64_t session = 0;
  std::string sender;
  std::int64_t counter = 0;
  sim::Bytes content;
  Mac mac{};
};

/// Returns whether the payload has the fingerprint of shoal.sim_signed_t.
bool is_signed(std::span<const std::byte> payload);
/// Decodes a signed message.  Checks neither MAC nor counter.  Throws shoal::MessageError.
SignedMessage read_signed(std::span<const std::byte> payload);
/// Returns the message itself, whether it is signed or not.  Checks neither MAC nor counter.  Throws
/// shoal::MessageError.
sim::Bytes content_of(std::span<const std::byte> payload);
/// Returns whether the MAC of a signed payload is valid for this key and channel.
bool has_mac_of(const RunKey& key, std::string_view channel, std::span<const std::byte> payload);

/// Returns whether signed messages replace plain ones on this channel: the channels by which programs control a run.
bool is_control_channel(std::string_view channel);

/// Signer of the messages of one program.
class MessageSigner {
 public:
  /// `sender`: name of the program, truncated to 60 bytes.
  MessageSigner(const RunKey& key, std::string_view sender);
  /// Returns the payload to publish on `channel` in place of `content`.  It differs in every call, also for equal
  /// messages.
  sim::Bytes sign(std::string_view channel, std::span<const std::byte> content);

 private:
  RunKey key_;
  std::string sender_;
  std::int64_t session_;
  std::int64_t counter_;
};

}  // namespace bridges
