// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/acoustic_frame.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sim/base/math.hpp"

namespace autonomy {

std::string to_text(OrderRefusal refusal) {
  switch (refusal) {
    case OrderRefusal::none:
      return "not refused";
    case OrderRefusal::too_deep:
      return "too deep";
    case OrderRefusal::too_fast:
      return "too fast";
  }
  return "reason " + std::to_string(static_cast<int>(refusal));
}

namespace acoustic_frame {

namespace {

constexpr std::int64_t week_ms = 7LL * 24 * 3600 * 1000;
constexpr std::int64_t first_sunday_ms = 3LL * 24 * 3600 * 1000;  // the epoch was a Thursday
constexpr double turn = 65536;

class Writer {
 public:
  explicit Writer(int kind) { put(version << 4 | kind, 1); }
  /// Appends the low `count` bytes of a number, the highest first.
  void put(std::int64_t value, int count) {
    for (int shift = 8 * (count - 1); shift >= 0; shift -= 8)
      bytes_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> shift));
  }
  /// Returns the whole frame, with its checksum.
  Bytes finish() {
    put(checksum(bytes_), 2);
    return std::move(bytes_);
  }

 private:
  Bytes bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::int64_t unsigned_number(int count) {
    std::int64_t value = 0;
    for (int i = 0; i < count; ++i) value = value * 256 + bytes_[used_++];
    return value;
  }
  std::int64_t signed_number(int count) {
    const std::int64_t value = unsigned_number(count);
    const std::int64_t half = std::int64_t{1} << (8 * count - 1);
    return value < half ? value : value - 2 * half;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t used_ = 0;
};

std::int64_t floor_modulo(std::int64_t a, std::int64_t b) {
  const std::int64_t rest = a % b;
  return rest < 0 ? rest + b : rest;
}

std::int64_t floor_ms(std::int64_t utime) {
  return (utime - floor_modulo(utime, 1000)) / 1000;
}

/// Rounds up, limited to 65535.
std::int64_t saturated_up(double value) {
  return static_cast<std::int64_t>(std::min(std::ceil(value - 1e-9), 65535.0));
}

constexpr double max_m = 2.1e7;
constexpr double deepest_m = 167'000;

bool is_byte(int number) {
  return number >= 0 && number <= 255;
}

bool fits(const AcousticState& s) {
  for (const double number :
       {s.east_m, s.north_m, s.depth_m, s.east_std_m, s.north_std_m, s.correlation, s.speed_mps, s.course_rad})
    if (!std::isfinite(number)) return false;
  const int reason = static_cast<int>(s.refusal);
  if (!is_byte(s.refused_order) || !is_byte(reason) || (s.refused_order == 0) != (reason == 0)) return false;
  return is_byte(s.sender) && is_byte(s.order) && std::abs(s.east_m) < max_m && std::abs(s.north_m) < max_m &&
         s.depth_m > -0.005 && s.depth_m < deepest_m && s.east_std_m >= 0 && s.north_std_m >= 0 && s.speed_mps >= 0 &&
         std::abs(s.correlation) <= 1;
}

bool fits(const AcousticOrder& o) {
  return is_byte(o.sender) && is_byte(o.receiver) && is_byte(o.number) && o.number > 0 && std::abs(o.east_m) < max_m &&
         std::abs(o.north_m) < max_m && o.depth_m > -0.005 && o.depth_m < deepest_m && o.speed_mps >= 0.01 &&
         o.speed_mps <= 655.35;
}

std::int64_t of_week_ms(std::int64_t utime) {
  return floor_modulo(floor_ms(utime) - first_sunday_ms, week_ms);
}

/// Completes a time of the week, within half a week of another time.
std::int64_t full_utime(std::int64_t time_of_week_ms, std::int64_t near_utime) {
  const std::int64_t ahead_ms =
      floor_modulo(time_of_week_ms - of_week_ms(near_utime) + week_ms / 2, week_ms) - week_ms / 2;
  return (floor_ms(near_utime) + ahead_ms) * 1000;
}

bool has_good_checksum(std::span<const std::uint8_t> bytes) {
  Reader in(bytes.last(2));
  return in.unsigned_number(2) == checksum(bytes.first(bytes.size() - 2));
}

std::int64_t centimeters(double meters) {
  return std::llround(100 * meters);
}

/// Each length corresponds to one kind.
std::optional<int> kind_of_state(std::size_t bytes) {
  if (bytes == state_bytes) return state_kind;
  if (bytes == executing_state_bytes) return executing_state_kind;
  if (bytes == refusing_state_bytes) return refusing_state_kind;
  return std::nullopt;
}

}  // namespace

std::uint16_t checksum(std::span<const std::uint8_t> bytes) {
  std::uint32_t remainder = 0xffff;
  for (const std::uint8_t byte : bytes) {
    remainder ^= static_cast<std::uint32_t>(byte) << 8;
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder << 1) ^ ((remainder & 0x8000) != 0 ? 0x1021u : 0u);
    remainder &= 0xffff;
  }
  return static_cast<std::uint16_t>(remainder);
}

std::optional<Bytes> encode(const AcousticState& state) {
  if (!fits(state)) return std::nullopt;
  const int kind = state.refused_order != 0 ? refusing_state_kind
                   : state.order != 0       ? executing_state_kind
                                            : state_kind;
  Writer out(kind);
  out.put(state.sender, 1);
  out.put(of_week_ms(state.utime), 4);
  out.put(centimeters(state.east_m), 4);
  out.put(centimeters(state.north_m), 4);
  out.put(std::max<std::int64_t>(0, centimeters(state.depth_m)), 3);
  // Never zero, because no position is known exactly.
  out.put(std::max<std::int64_t>(1, saturated_up(100 * state.east_std_m)), 2);
  out.put(std::max<std::int64_t>(1, saturated_up(100 * state.north_std_m)), 2);
  out.put(std::llround(127 * state.correlation), 1);
  out.put(std::min<std::int64_t>(centimeters(std::min(state.speed_mps, 1000.0)), 65535), 2);
  out.put(std::llround(std::remainder(state.course_rad, 2 * std::numbers::pi) / (2 * std::numbers::pi) * turn), 2);
  if (kind != state_kind) out.put(state.order, 1);
  if (kind == refusing_state_kind) {
    out.put(state.refused_order, 1);
    out.put(static_cast<int>(state.refusal), 1);
  }
  return out.finish();
}

std::optional<AcousticState> decode(std::span<const std::uint8_t> bytes, std::int64_t near_utime) {
  // Check kind, version and checksum.
  const std::optional<int> kind = kind_of_state(bytes.size());
  if (!kind) return std::nullopt;
  Reader in(bytes);
  if (in.unsigned_number(1) != (version << 4 | *kind) || !has_good_checksum(bytes)) return std::nullopt;
  // Scale the fields to SI units.
  AcousticState state;
  state.sender = static_cast<int>(in.unsigned_number(1));
  const std::int64_t time_of_week_ms = in.unsigned_number(4);
  state.east_m = 0.01 * static_cast<double>(in.signed_number(4));
  state.north_m = 0.01 * static_cast<double>(in.signed_number(4));
  state.depth_m = 0.01 * static_cast<double>(in.unsigned_number(3));
  state.east_std_m = 0.01 * static_cast<double>(in.unsigned_number(2));
  state.north_std_m = 0.01 * static_cast<double>(in.unsigned_number(2));
  state.correlation = static_cast<double>(in.signed_number(1)) / 127;
  state.speed_mps = 0.01 * static_cast<double>(in.unsigned_number(2));
  state.course_rad = sim::wrap_angle(static_cast<double>(in.unsigned_number(2)) / turn * 2 * std::numbers::pi);
  if (*kind != state_kind) state.order = static_cast<int>(in.unsigned_number(1));
  if (*kind == refusing_state_kind) {
    state.refused_order = static_cast<int>(in.unsigned_number(1));
    state.refusal = static_cast<OrderRefusal>(in.unsigned_number(1));
    if (state.refused_order == 0 || state.refusal == OrderRefusal::none) return std::nullopt;
  }
  // Reject values out of range.
  if (time_of_week_ms >= week_ms || state.east_std_m <= 0 || state.north_std_m <= 0 ||
      std::abs(state.correlation) > 1 || (*kind == executing_state_kind && state.order == 0))
    return std::nullopt;
  if (!fits(state)) return std::nullopt;
  state.utime = full_utime(time_of_week_ms, near_utime);
  return state;
}

std::optional<Bytes> encode(const AcousticOrder& order) {
  if (!fits(order)) return std::nullopt;
  Writer out(order_kind);
  out.put(order.sender, 1);
  out.put(order.receiver, 1);
  out.put(order.number, 1);
  out.put(of_week_ms(order.utime), 4);
  out.put(centimeters(order.east_m), 4);
  out.put(centimeters(order.north_m), 4);
  out.put(std::max<std::int64_t>(0, centimeters(order.depth_m)), 3);
  out.put(centimeters(order.speed_mps), 2);
  return out.finish();
}

std::optional<AcousticOrder> decode_order(std::span<const std::uint8_t> bytes, std::int64_t near_utime) {
  if (bytes.size() != order_bytes) return std::nullopt;
  Reader in(bytes);
  // The first byte tells version and kind; frames of others on the same channel end here.
  if (in.unsigned_number(1) != (version << 4 | order_kind) || !has_good_checksum(bytes)) return std::nullopt;
  AcousticOrder order;
  order.sender = static_cast<int>(in.unsigned_number(1));
  order.receiver = static_cast<int>(in.unsigned_number(1));
  order.number = static_cast<int>(in.unsigned_number(1));
  const std::int64_t time_of_week_ms = in.unsigned_number(4);
  order.east_m = 0.01 * static_cast<double>(in.signed_number(4));
  order.north_m = 0.01 * static_cast<double>(in.signed_number(4));
  order.depth_m = 0.01 * static_cast<double>(in.unsigned_number(3));
  order.speed_mps = 0.01 * static_cast<double>(in.unsigned_number(2));
  if (time_of_week_ms >= week_ms || !fits(order)) return std::nullopt;
  order.utime = full_utime(time_of_week_ms, near_utime);
  return order;
}

}  // namespace acoustic_frame

}  // namespace autonomy
