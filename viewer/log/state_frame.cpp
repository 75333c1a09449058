// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/state_frame.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace viewer {

namespace {

static_assert(std::endian::native == std::endian::little, "frames are little-endian");

constexpr std::size_t head_bytes = 32;
constexpr std::uint8_t state_kind = 1;
constexpr std::uint8_t paused_flag = 1, jump_flag = 2, past_flag = 4;

/// Offsets in the head.
enum HeadAt : std::size_t {
  kind_at = 0,
  flags_at = 1,
  sequence_at = 4,
  time_at = 8,
  branch_at = 16,
  revision_at = 20,
  count_at = 24,
  speed_at = 28
};

}  // namespace

template <typename Number>
void StateFrame::put(std::size_t at, Number number) {
  std::memcpy(bytes_.data() + at, &number, sizeof number);
}

void StateFrame::begin(const Head& head) {
  bytes_.assign(head_bytes, std::byte{0});
  count_ = 0;
  put(kind_at, state_kind);
  put(flags_at, static_cast<std::uint8_t>((head.paused ? paused_flag : 0) | (head.jump ? jump_flag : 0) |
                                          (head.past ? past_flag : 0)));
  put(time_at, head.time_us);
  put(branch_at, head.branch);
  put(revision_at, head.revision);
  put(speed_at, head.speed);
}

void StateFrame::add(const sim::Vector3d& p_W, const sim::Quaterniond& q_WB) {
  const std::size_t at = bytes_.size();
  bytes_.resize(at + body_bytes);
  const float position[3] = {static_cast<float>(p_W.x()), static_cast<float>(p_W.y()), static_cast<float>(p_W.z())};
  std::memcpy(bytes_.data() + at, position, sizeof position);
  // Round without the library, whose calls were half of the cost of a frame.
  const double parts[4] = {q_WB.w(), q_WB.x(), q_WB.y(), q_WB.z()};
  std::int16_t rotation[4];
  for (int i = 0; i < 4; ++i) {
    const double scaled = 32767 * std::clamp(parts[i], -1.0, 1.0);
    rotation[i] = static_cast<std::int16_t>(scaled + std::copysign(0.5, scaled));
  }
  std::memcpy(bytes_.data() + at + sizeof position, rotation, sizeof rotation);
  ++count_;
}

void StateFrame::add(std::span<const std::byte> bodies) {
  bytes_.insert(bytes_.end(), bodies.begin(), bodies.end());
  count_ += static_cast<std::uint32_t>(bodies.size() / body_bytes);
}

void StateFrame::add_unknown() {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  add({unknown, unknown, unknown}, sim::Quaterniond::Identity());
}

std::span<const std::byte> StateFrame::bodies() const {
  return std::span(bytes_).subspan(head_bytes);
}

std::span<const std::byte> StateFrame::end() {
  put(count_at, count_);
  put(sequence_at, ++sequence_);
  return bytes_;
}

}  // namespace viewer
