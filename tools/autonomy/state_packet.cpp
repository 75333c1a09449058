#include "tools/autonomy/state_packet.hpp"

#include <cmath>
#include <cstdlib>

namespace autonomy {

std::optional<shoal::modem_send_t> to_everybody(const AcousticState& state) {
  const auto bytes = acoustic_frame::encode(state);
  if (!bytes) return std::nullopt;
  shoal::modem_send_t message;
  message.utime = state.utime;
  message.size = static_cast<std::int32_t>(bytes->size());
  message.data.assign(bytes->begin(), bytes->end());
  return message;
}

std::optional<AcousticState> state_in(const shoal::acoustic_received_t& packet) {
  constexpr std::int64_t oldest_us = 60'000'000;
  auto state = acoustic_frame::decode(packet.data, packet.sent_utime);
  if (!state || std::llabs(state->utime - packet.sent_utime) > oldest_us) return std::nullopt;
  return state;
}

Vector2d position_at(const AcousticState& state, std::int64_t utime) {
  const Motion motion = motion_of(state);
  return motion.p_W + motion.v_W * (static_cast<double>(utime - state.utime) * 1e-6);
}

Motion motion_of(const AcousticState& state) {
  return {state.utime, {state.east_m, state.north_m}, turned({state.speed_mps, 0}, state.course_rad)};
}

}  // namespace autonomy
