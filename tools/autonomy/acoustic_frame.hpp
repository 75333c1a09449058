#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace autonomy {

/// What a vehicle tells the others of its state over an acoustic modem.
struct AcousticState {
  int sender = 0;          ///< 0 to 255
  std::int64_t utime = 0;  ///< of the state, by the sender's clock, us
  double east_m = 0;       ///< of its transducer, in the frame of the world
  double north_m = 0;
  double depth_m = 0;     ///< below the still surface, positive down
  double east_std_m = 0;  ///< standard deviations of the position, and their correlation
  double north_std_m = 0;
  double correlation = 0;
  double speed_mps = 0;   ///< over ground
  double course_rad = 0;  ///< direction of the speed, counter-clockwise from east
};

/// An AcousticState in 28 bytes, big-endian:
///
///     0      version (high four bits) and kind (low four)
///     1      sender
///     2-5    time of the week, ms; weeks begin on Sundays, 0:00 UTC, by the sender's clock
///     6-9    east, cm, signed          10-13  north, cm, signed
///     14-16  depth, cm
///     17-18  east_std, cm, rounded up  19-20  north_std
///     21     correlation, 1/127, signed
///     22-23  speed, cm/s               24-25  course, 1/65536 of a turn
///     26-27  checksum of the bytes before
///
/// Standard deviations of more than 655.35 m and speeds of more than 655.35 m/s are sent as these.
namespace acoustic_frame {

inline constexpr std::size_t size_bytes = 28;
inline constexpr int version = 1;
inline constexpr int state_kind = 0;

using Bytes = std::array<std::uint8_t, size_bytes>;

/// Nothing when the state does not fit: a sender outside of 0 to 255, a depth outside of -0.005 m to 167 km (a small
/// negative one is 0), a position beyond 21 000 km, a standard deviation or speed below 0, or what is no number.
std::optional<Bytes> encode(const AcousticState& state);

/// Nothing when it is no such frame: the length, version, kind or checksum is another, or the standard deviations are
/// zero.  `near_utime`: a time within half a week of the sender's, which makes a full time of the time of the week.
std::optional<AcousticState> decode(std::span<const std::uint8_t> bytes, std::int64_t near_utime);

/// CRC-16/CCITT-FALSE: polynomial 0x1021, from 0xffff.  Finds every error of up to three bits in a frame of this
/// length.
std::uint16_t checksum(std::span<const std::uint8_t> bytes);

}  // namespace acoustic_frame

}  // namespace autonomy
