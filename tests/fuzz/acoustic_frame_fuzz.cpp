// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/acoustic_frame.hpp"
#include "autonomy/acomms/state_packet.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Frames that the example programs take from acoustic modems.  The checksum is made right half of the time.

SHOAL_FUZZ_TARGET(acoustic_frame) {
  namespace frame = autonomy::acoustic_frame;
  fuzz::Reader reader(input);
  const bool right = reader.below(2) == 0;
  const auto near_utime = reader.number<std::int64_t>();
  const fuzz::Input rest = reader.rest();
  frame::Bytes bytes(rest.size());
  std::transform(rest.begin(), rest.end(), bytes.begin(), [](std::byte byte) { return std::uint8_t(byte); });
  if (right && bytes.size() >= 2) {
    const std::uint16_t sum = frame::checksum(std::span(bytes).first(bytes.size() - 2));
    bytes[bytes.size() - 2] = static_cast<std::uint8_t>(sum >> 8);
    bytes[bytes.size() - 1] = static_cast<std::uint8_t>(sum);
  }
  constexpr std::int64_t max_us = std::int64_t{1} << 60;  // the caller's own clock
  const std::int64_t near = near_utime % max_us;
  if (const auto state = frame::decode(bytes, near))
    fuzz::require(frame::encode(*state).has_value(), "a state that was received can be sent");
  if (const auto order = frame::decode_order(bytes, near))
    fuzz::require(frame::encode(*order).has_value(), "an order that was received can be sent");
  shoal::acoustic_received_t packet{};
  packet.utime = near;
  packet.size = static_cast<std::int32_t>(bytes.size());
  packet.data.assign(bytes.begin(), bytes.end());
  autonomy::state_in(packet);
  autonomy::order_in(packet);
}
