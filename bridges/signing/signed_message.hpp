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

/// The content of a shoal.sim_signed_t.
struct SignedMessage {
  std::int64_t session = 0;
  std::string sender;
  std::int64_t counter = 0;
  sim::Bytes content;
  Mac mac{};
};

/// Whether the payload claims to be a shoal.sim_signed_t, by its fingerprint.
bool is_signed(std::span<const std::byte> payload);
/// Reads one.  Checks neither MAC nor counter.  Throws shoal::MessageError.
SignedMessage read_signed(std::span<const std::byte> payload);
/// The message itself, whether it is signed or not.  Checks neither MAC nor counter.  Throws shoal::MessageError.
sim::Bytes content_of(std::span<const std::byte> payload);
/// Whether the MAC of a payload that read_signed() takes is that of this key and channel.
bool has_mac_of(const RunKey& key, std::string_view channel, std::span<const std::byte> payload);

/// Whether this channel carries signed messages in place of others: those of programs that control a run.
bool is_control_channel(std::string_view channel);

/// Signs what one program sends.
class MessageSigner {
 public:
  /// `sender`: how the program calls itself; cut to 60 bytes.
  MessageSigner(const RunKey& key, std::string_view sender);
  /// The payload to publish on `channel` in place of `content`.  Each call gives another one, also for equal messages.
  sim::Bytes sign(std::string_view channel, std::span<const std::byte> content);

 private:
  RunKey key_;
  std::string sender_;
  std::int64_t session_;
  std::int64_t counter_;
};

}  // namespace bridges
