// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace bridges {

/// Bytes that are not packets of MOOS, or a MOOSDB that refuses the client; the text has the reason.
class MoosError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Purpose of a message: its character on the wire.
enum class MoosType : char {
  notify = 'N',
  subscribe = 'R',
  unsubscribe = 'U',
  subscribe_pattern = '*',
  data = 'i',
  welcome = 'W',
  poison = 'K',
  timing = 'T',
  null = '.',
};

/// Message of MOOS: the value of a variable, or an order between a client and the MOOSDB.
struct MoosMessage {
  MoosType type = MoosType::notify;
  char value_type = 'D';  ///< D: `number`, S: `text`, B: bytes in `text`
  std::string key;        ///< the variable
  double number = 0;
  std::string text;
  double time_s = 0;  ///< wall time since 1970, multiplied by the time warp
  std::string source, source_aux, community;
  std::int32_t id = -1;
};

/// Returns a packet of these messages in the protocol of MOOS 10, uncompressed and little-endian.
std::vector<std::byte> encode_moos_packet(std::span<const MoosMessage> messages);

/// First bytes of each connection of a client: the name of the protocol, padded with zeros.
inline constexpr std::size_t moos_greeting_bytes = 32;
inline constexpr std::string_view moos_greeting = "ELKS CAN'T DANCE 2/8/10";

/// Splitter of a byte stream into messages.  Memory is bounded for any input.
class MoosPacketReader {
 public:
  /// Longest packet that is accepted.
  static constexpr std::int32_t max_packet_bytes = 16 << 20;

  /// Returns the messages of the packets that are complete.  Throws MoosError for bytes that cannot be part of a
  /// packet, after which the stream has no further meaning.
  std::vector<MoosMessage> add(std::span<const std::byte> bytes);

 private:
  std::vector<std::byte> waiting_;
};

}  // namespace bridges
