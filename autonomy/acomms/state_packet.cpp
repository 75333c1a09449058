// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/state_packet.hpp"

#include <algorithm>
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

Eigen::Matrix2d covariance_of(const AcousticState& state) {
  const double across_m2 = state.correlation * state.east_std_m * state.north_std_m;
  Eigen::Matrix2d P;
  P << squared(state.east_std_m), across_m2, across_m2, squared(state.north_std_m);
  return P;
}

shoal::estimate_t estimate_message(std::int64_t utime, const Vector2d& p_W, const Vector2d& v_W,
                                   const Eigen::Matrix2d& P) {
  shoal::estimate_t estimate{};
  estimate.utime = utime;
  for (int i = 0; i < 2; ++i) {
    estimate.position_m[i] = p_W[i];
    estimate.velocity_mps[i] = v_W[i];
    for (int j = 0; j < 2; ++j) estimate.covariance_m2[3 * i + j] = P(i, j);
  }
  return estimate;
}

void set_depth(shoal::estimate_t& estimate, double depth_m) {
  constexpr double pressure_std_m = 0.1;
  estimate.position_m[2] = -depth_m;
  estimate.covariance_m2[8] = squared(pressure_std_m);
}

AcousticState state_of(const shoal::estimate_t& estimate, int sender) {
  const auto& P = estimate.covariance_m2;
  const Vector2d v_W(estimate.velocity_mps[0], estimate.velocity_mps[1]);
  AcousticState state;
  state.sender = sender;
  state.utime = estimate.utime;
  state.east_m = estimate.position_m[0];
  state.north_m = estimate.position_m[1];
  state.depth_m = std::max(0.0, -estimate.position_m[2]);
  state.east_std_m = std::sqrt(P[0]);
  state.north_std_m = std::sqrt(P[4]);
  state.correlation = std::clamp(P[1] / std::sqrt(P[0] * P[4]), -1.0, 1.0);
  state.speed_mps = v_W.norm();
  state.course_rad = std::atan2(v_W.y(), v_W.x());
  return state;
}

}  // namespace autonomy
