// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace autonomy {

/// Reason why a vehicle refuses an order.
enum class OrderRefusal {
  none = 0,
  too_deep = 1,
  too_fast = 2,
};
/// Returns a phrase such as `too deep`; `reason 7` for a number unknown to this program.
std::string to_text(OrderRefusal refusal);

/// State that a vehicle sends to the others over an acoustic modem.
struct AcousticState {
  int sender = 0;          ///< 0 to 255
  std::int64_t utime = 0;  ///< time of the state by the sender's clock, us
  double east_m = 0;       ///< of its transducer, in the frame of the world
  double north_m = 0;
  double depth_m = 0;     ///< below the still surface, positive down
  double east_std_m = 0;  ///< standard deviations of the position, and their correlation
  double north_std_m = 0;
  double correlation = 0;
  double speed_mps = 0;   ///< over ground
  double course_rad = 0;  ///< direction of the speed, counter-clockwise from east
  int order = 0;          ///< number of the last order that it executed, 1 to 255; 0: none
  /// Later order that was refused; 0: none since.
  int refused_order = 0;
  OrderRefusal refusal = OrderRefusal::none;  ///< reason; set only when `refused_order` is
};

/// Order to move to a position.
struct AcousticOrder {
  int sender = 0;          ///< 0 to 255
  int receiver = 0;        ///< receiver of the order, 0 to 255
  int number = 1;          ///< 1 to 255; a later order has a larger one
  std::int64_t utime = 0;  ///< time of the order by the sender's clock, us
  double east_m = 0;       ///< of the position, in the frame of the world
  double north_m = 0;
  double depth_m = 0;    ///< below the still surface, positive down
  double speed_mps = 0;  ///< through the water; above 0
};

/// Frames for acoustic modems, big-endian.  An AcousticState in 28 bytes (kind 0), in 29 (kind 2) when there is an
/// order to report, or in 31 (kind 3) when there is one that was refused:
///
///     0      version (high four bits) and kind (low four)
///     1      sender
///     2-5    time of the week, ms; weeks begin on Sundays, 0:00 UTC, by the sender's clock
///     6-9    east, cm, signed          10-13  north, cm, signed
///     14-16  depth, cm
///     17-18  east_std, cm, rounded up  19-20  north_std
///     21     correlation, 1/127, signed
///     22-23  speed, cm/s               24-25  course, 1/65536 of a turn
///     26     kinds 2, 3: last order executed; kind 3: 0 for none
///     27     kind 3: order refused     28     kind 3: OrderRefusal
///     the last two  checksum of the bytes before
///
/// An AcousticOrder in 23 bytes (kind 1):
///
///     0      version and kind          1      sender
///     2      receiver                  3      number
///     4-7    time of the week, ms
///     8-11   east, cm, signed          12-15  north, cm, signed
///     16-18  depth, cm                 19-20  speed, cm/s
///     21-22  checksum of the bytes before
///
/// Larger standard deviations than 655.35 m and larger speeds than 655.35 m/s are sent as these limits.
namespace acoustic_frame {

inline constexpr std::size_t state_bytes = 28;
inline constexpr std::size_t order_bytes = 23;
inline constexpr std::size_t executing_state_bytes = 29;
inline constexpr std::size_t refusing_state_bytes = 31;
inline constexpr int version = 1;
inline constexpr int state_kind = 0;
inline constexpr int order_kind = 1;
inline constexpr int executing_state_kind = 2;
inline constexpr int refusing_state_kind = 3;

using Bytes = std::vector<std::uint8_t>;

/// Encodes a state.  Returns std::nullopt if the state is out of range: a sender outside of 0 to 255, a depth outside
/// of -0.005 m to 167 km (a small negative one is 0), a position beyond 21 000 km, a standard deviation or speed below
/// 0, an order outside of 0 to 255, a refused one without a reason or a reason without one, or NaN or infinity.
std::optional<Bytes> encode(const AcousticState& state);

/// Decodes a state.  Returns std::nullopt for a wrong length, version, kind or checksum, standard deviations of zero,
/// or values that encode() would not send.  `near_utime`: a time within half a week of the sender's, which completes
/// the time of the week.
std::optional<AcousticState> decode(std::span<const std::uint8_t> bytes, std::int64_t near_utime);

/// Encodes an order.  Returns std::nullopt if sender, receiver, number, position or depth are out of their ranges as
/// above, the speed is outside of 0.01 to 655.35 m/s, or a value is NaN or infinite.
std::optional<Bytes> encode(const AcousticOrder& order);

/// Decodes an order, as decode() does a state.
std::optional<AcousticOrder> decode_order(std::span<const std::uint8_t> bytes, std::int64_t near_utime);

/// Returns the CRC-16/CCITT-FALSE: polynomial 0x1021, initial value 0xffff.  Detects every error of up to three bits in
/// a frame of this length.
std::uint16_t checksum(std::span<const std::uint8_t> bytes);

}  // namespace acoustic_frame

}  // namespace autonomy
