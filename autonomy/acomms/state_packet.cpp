// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/state_packet.hpp"

#include <cmath>
#include <cstdlib>
#include <utility>

namespace autonomy {

namespace {

template <class Content>
std::optional<shoal::modem_send_t> broadcast(const Content& content) {
  auto bytes = acoustic_frame::encode(content);
  if (!bytes) return std::nullopt;
  shoal::modem_send_t message{};
  message.utime = content.utime;
  message.size = static_cast<std::int32_t>(bytes->size());
  message.data = std::move(*bytes);
  return message;
}

template <class Content>
std::optional<Content> unless_stale(std::optional<Content> content, std::int64_t sent_utime) {
  constexpr std::int64_t oldest_us = 60'000'000;
  if (content && std::llabs(content->utime - sent_utime) > oldest_us) content.reset();
  return content;
}

}  // namespace

std::optional<shoal::modem_send_t> to_everybody(const AcousticState& state) {
  return broadcast(state);
}

std::optional<shoal::modem_send_t> to_everybody(const AcousticOrder& order) {
  return broadcast(order);
}

std::optional<AcousticState> state_in(const shoal::acoustic_received_t& packet) {
  return unless_stale(acoustic_frame::decode(packet.data, packet.sent_utime), packet.sent_utime);
}

std::optional<AcousticState> state_in(const shoal::modem_received_t& packet) {
  return unless_stale(acoustic_frame::decode(packet.data, packet.sent_utime), packet.sent_utime);
}

std::optional<AcousticOrder> order_in(const shoal::acoustic_received_t& packet) {
  return unless_stale(acoustic_frame::decode_order(packet.data, packet.sent_utime), packet.sent_utime);
}

bool DirectStates::is_direct(const shoal::acoustic_received_t& packet, const AcousticState& state) {
  if (std::abs(static_cast<double>(packet.sent_utime - state.utime)) > newest_s * 1e6) return false;
  return vehicles_.try_emplace(state.sender, packet.source).first->second == packet.source;
}

Vector2d position_at(const AcousticState& state, std::int64_t utime) {
  const Motion motion = motion_of(state);
  return motion.p_W + motion.v_W * (static_cast<double>(utime - state.utime) * 1e-6);
}

Motion motion_of(const AcousticState& state) {
  return {state.utime, {state.east_m, state.north_m}, turned({state.speed_mps, 0}, state.course_rad)};
}

}  // namespace autonomy
