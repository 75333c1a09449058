// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/nav_frame.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "autonomy/acomms/acoustic_frame.hpp"
#include "autonomy/cooperative/estimator/payload.hpp"

namespace navigation {

namespace {

constexpr std::uint64_t frame_mark = 78;
constexpr Time cycle_ms = 65536;
constexpr std::size_t payload_length_at = 7;
constexpr std::size_t relative_bytes = 9;
constexpr double displacement_step_m = 0.01;

/// Rounds towards minus infinity.
Time milliseconds_of(Time time_us) {
  return time_us >= 0 ? time_us / 1000 : -((-time_us + 999) / 1000);
}

}  // namespace

std::size_t payload_room(std::size_t frame_bytes) {
  return frame_bytes < frame_overhead_bytes || frame_bytes > max_frame_bytes ? 0 : frame_bytes - frame_overhead_bytes;
}

Bytes encode_frame(const NavFrame& frame, std::size_t frame_bytes) {
  const std::size_t room = payload_room(frame_bytes);
  if (frame.payload.size() > room)
    throw std::invalid_argument("a frame of " + std::to_string(frame_bytes) + " bytes has room for " +
                                std::to_string(room) + " bytes of payload, got " +
                                std::to_string(frame.payload.size()));
  Bytes bytes;
  PayloadWriter writer(bytes);
  writer.whole(frame_mark, 1);
  writer.whole(static_cast<std::uint64_t>(frame.sender), 1);
  const Time ms = milliseconds_of(frame.payload_time) % cycle_ms;
  writer.whole(static_cast<std::uint64_t>(ms < 0 ? ms + cycle_ms : ms), 2);
  writer.whole(static_cast<std::uint64_t>(std::llround(100 * std::clamp(frame.depth_m, 0.0, 1e5))), 3);
  writer.whole(frame.payload.size(), 1);
  bytes.insert(bytes.end(), frame.payload.begin(), frame.payload.end());
  const std::size_t left = room - frame.payload.size();
  const std::size_t relatives = left == 0 ? 0 : std::min(frame.relatives.size(), (left - 1) / relative_bytes);
  if (relatives > 0) {
    writer.whole(relatives, 1);
    for (const NavFrame::RelativePosition& relative : std::span(frame.relatives).first(relatives)) {
      writer.whole(static_cast<std::uint64_t>(relative.other), 1);
      writer.whole(static_cast<std::uint64_t>(std::max<Time>(milliseconds_of(relative.age), 0)), 2);
      for (const double d_m : relative.d_W) writer.fixed(d_m, displacement_step_m, 3);
    }
  }
  bytes.resize(frame_bytes - 2);
  writer.whole(autonomy::acoustic_frame::checksum(bytes), 2);
  return bytes;
}

std::size_t payload_length(const Bytes& frame) {
  return frame.at(payload_length_at);
}

std::optional<NavFrame> decode_frame(std::span<const std::uint8_t> bytes, Time tol) {
  if (bytes.size() < frame_overhead_bytes || bytes.size() > max_frame_bytes) return std::nullopt;
  PayloadReader reader(bytes);
  if (reader.whole(1) != frame_mark) return std::nullopt;
  NavFrame frame;
  frame.sender = static_cast<int>(reader.whole(1));
  // The time nearest to that of the transmission.
  const Time tol_ms = milliseconds_of(tol);
  Time since_ms = (static_cast<Time>(reader.whole(2)) - tol_ms) % cycle_ms;
  if (since_ms < -cycle_ms / 2) since_ms += cycle_ms;
  if (since_ms >= cycle_ms / 2) since_ms -= cycle_ms;
  frame.payload_time = 1000 * (tol_ms + since_ms);
  frame.depth_m = 0.01 * static_cast<double>(reader.whole(3));
  const auto size = static_cast<std::size_t>(reader.whole(1));
  PayloadReader end(bytes.last(2));
  if (size > payload_room(bytes.size()) ||
      end.whole(2) != autonomy::acoustic_frame::checksum(bytes.first(bytes.size() - 2)))
    return std::nullopt;
  const auto payload = bytes.subspan(frame_overhead_bytes - 2, size);
  frame.payload.assign(payload.begin(), payload.end());
  PayloadReader rest(bytes.subspan(frame_overhead_bytes - 2 + size, payload_room(bytes.size()) - size));
  const std::uint64_t relatives = rest.whole(1);
  for (std::uint64_t i = 0; i < relatives; ++i) {
    NavFrame::RelativePosition relative;
    relative.other = static_cast<int>(rest.whole(1));
    relative.age = 1000 * static_cast<Time>(rest.whole(2));
    for (double& d_m : relative.d_W) d_m = rest.fixed(displacement_step_m, 3);
    if (!rest.ok()) return std::nullopt;
    frame.relatives.push_back(relative);
  }
  return frame;
}

}  // namespace navigation
