// SPDX-License-Identifier: BSD-3-Clause
#include <arpa/inet.h>

#include <array>

#include "bridges/lcm/lcm_reassembly.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Datagrams of LCM's udpm from anyone: raw ones, and fragments whose heads are well-formed.

namespace {

constexpr std::uint32_t short_magic = 0x4c433032, long_magic = 0x4c433033;

void append(sim::Bytes& bytes, const void* from, std::size_t size) {
  const auto* begin = static_cast<const std::byte*>(from);
  bytes.insert(bytes.end(), begin, begin + size);
}
void append32(sim::Bytes& bytes, std::uint32_t value) {
  value = htonl(value);
  append(bytes, &value, sizeof value);
}
void append16(sim::Bytes& bytes, std::uint16_t value) {
  value = htons(value);
  append(bytes, &value, sizeof value);
}

/// Small numbers mostly, for they fit together.
std::uint32_t number(fuzz::Reader& reader) {
  return reader.below(4) == 0 ? reader.number<std::uint32_t>() : reader.byte();
}

sim::Bytes datagram(fuzz::Reader& reader) {
  sim::Bytes bytes;
  const std::size_t kind = reader.below(4);
  if (kind == 1) {
    append32(bytes, short_magic);
    append32(bytes, reader.byte());
  } else if (kind >= 2) {
    append32(bytes, long_magic);
    append32(bytes, reader.byte());                                               // sequence
    append32(bytes, number(reader));                                              // size of the message
    append32(bytes, number(reader));                                              // offset
    append16(bytes, kind == 2 ? reader.byte() : reader.number<std::uint16_t>());  // number of the fragment
    append16(bytes, kind == 2 ? reader.byte() : reader.number<std::uint16_t>());  // how many there are
  }
  const std::size_t size = reader.below(8) == 0 ? reader.number<std::uint16_t>() : reader.byte();
  const fuzz::Input body = reader.bytes(size);
  append(bytes, body.data(), body.size());
  return bytes;
}

}  // namespace

SHOAL_FUZZ_TARGET(datagram) {
  const bridges::LcmReassembly::Limits limits{1000, 300, 4, 2000};
  bridges::LcmReassembly reassembly(limits);
  fuzz::Reader reader(input);
  while (!reader.ended()) {
    const bridges::DatagramSender from{static_cast<std::uint32_t>(reader.below(8)), 7667};
    // In memory of its own: a sanitizer sees each byte that is read behind its end.
    const sim::Bytes bytes = datagram(reader);
    const auto message = reassembly.add(bytes, from, [](std::string_view channel) { return channel != "unwanted"; });
    fuzz::require(reassembly.partial_messages() <= limits.max_partial_messages, "partial messages are bounded");
    fuzz::require(reassembly.partial_bytes() <= limits.max_partial_bytes + limits.max_message_bytes,
                  "memory of partial messages is bounded");
    if (!message) continue;
    fuzz::require(!message->channel.empty() && message->channel.size() <= sim::Bus::max_channel_length &&
                      message->channel.find('\0') == message->channel.npos,
                  "a channel has 1 to 63 characters");
    // Reads all of it.
    const sim::Bytes copy(message->payload.begin(), message->payload.end());
    fuzz::require(copy.size() <= std::max<std::size_t>(limits.max_message_bytes, bytes.size()), "messages are bounded");
  }
}
