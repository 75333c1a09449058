// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "autonomy/cooperative/estimator/estimator.hpp"

namespace navigation {

/// Frame of `shoal-nav`, big-endian, always as long as the frames of the run are, filled with zeros:
///
///     0      78, the mark of these frames
///     1      sender, its index in the team
///     2-3    time for which make_payload() was called, ms modulo 65536, by the sender's clock
///     4-6    depth of the sender's modem, cm
///     7      length of the payload
///     8..    payload
///     then, where there is room,
///            number of relative measurements
///            each: index of the vehicle, its age at the time above (2, ms), displacement east and north (3 each, cm)
///     the last two  CRC-16/CCITT-FALSE of the bytes before
struct NavFrame {
  /// Relative measurement of a vehicle by the sender.
  struct RelativePosition {
    int other = 0;
    Time age = 0;                   ///< from the relative measurement to `payload_time`
    Vector2 d_W = Vector2::Zero();  ///< from the sender's modem at `payload_time` to that of the vehicle at the
                                    ///< relative measurement
  };
  int sender = 0;
  Time payload_time = 0;
  double depth_m = 0;
  Bytes payload;
  std::vector<RelativePosition> relatives = {};
};

inline constexpr std::size_t frame_overhead_bytes = 10;
inline constexpr std::size_t max_frame_bytes = 255;

/// Returns how many bytes of payload a frame has; 0: it is too short or too long for any.
std::size_t payload_room(std::size_t frame_bytes);
/// Encodes a frame of `frame_bytes`, with as many relative measurements as there is room for.  Throws
/// std::invalid_argument when the payload is longer than payload_room().
Bytes encode_frame(const NavFrame& frame, std::size_t frame_bytes);
/// Returns the length of the payload in a frame that encode_frame() made.
std::size_t payload_length(const Bytes& frame);
/// Decodes a frame that was transmitted at `tol`, by the sender's clock, whose payload_time is within 30 s of it.
/// Returns std::nullopt for other bytes.
std::optional<NavFrame> decode_frame(std::span<const std::uint8_t> bytes, Time tol);

}  // namespace navigation
