// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/true_state.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/world_file/world_config.hpp"

namespace bridges::nmea {

void TrueState::receive(const shoal::sim_info_t& info) {
  if (geodesy_) return;
  sim::Diagnostics diagnostics;
  const sim::ConfigNode world = sim::parse_config_text(info.resolved_config, "sim.info", diagnostics);
  sim::OriginConfig origin;
  if (const sim::ConfigNode* node = world.find("origin")) {
    sim::ParamReader in(*node, "origin", diagnostics);
    origin.read(in);
  }
  diagnostics.throw_if_any();
  geodesy_.emplace(origin.position);
}

bool TrueState::receive(const shoal::sim_state_t& state) {
  const auto own = std::find(state.vehicle.begin(), state.vehicle.end(), vehicle_);
  if (!geodesy_ || own == state.vehicle.end()) return false;
  state_ = state;
  own_ = static_cast<std::size_t>(own - state.vehicle.begin());
  return true;
}

shoal::gps_data_t TrueState::gps() const {
  return gps_of(own_);
}

shoal::gps_data_t TrueState::gps_of(std::size_t i) const {
  const sim::Vector3d p_WV(state_.position_m[i].data()), v_WV_W(state_.velocity_mps[i].data());
  const sim::GeodeticPosition position = geodesy_->to_geodetic(p_WV);
  const sim::Vector3d v_E = geodesy_->local_axes_W(p_WV).transpose() * v_WV_W;  // east, north, up at this place
  shoal::gps_data_t gps{};
  gps.utime = state_.utime;
  gps.gps_lock = 1;
  gps.latitude = position.latitude_deg;
  gps.longitude = position.longitude_deg;
  gps.elev = position.height_m;
  gps.speed = std::hypot(v_E.x(), v_E.y());
  gps.heading = std::atan2(v_E.x(), v_E.y());
  gps.gps_time = static_cast<double>(state_.utime) * 1e-6;
  return gps;
}

sim::Quaterniond TrueState::q_WV(std::size_t i) const {
  const auto& q = state_.orientation[i];
  return {q[0], q[1], q[2], q[3]};
}

shoal::ins_t TrueState::ins() const {
  shoal::ins_t ins{};
  ins.utime = state_.utime;
  std::copy_n(state_.orientation[own_].begin(), 4, ins.quat);
  const sim::Vector3d w_V = q_WV(own_).inverse() * sim::Vector3d(state_.angular_velocity_radps[own_].data());
  for (int i = 0; i < 3; ++i) ins.gyro[i] = w_V[i];
  return ins;
}

std::vector<shoal::ais_t> TrueState::ais(std::int64_t utime) {
  constexpr std::int64_t name_every_us = 60'000'000;
  std::vector<shoal::ais_t> messages;
  for (std::size_t i = 0; geodesy_ && i < state_.vehicle.size(); ++i) {
    if (i == own_) continue;
    Ship& ship = ships_[state_.vehicle[i]];
    if (ship.mmsi == 0) ship.mmsi = 200'000'000 + static_cast<std::int32_t>(ships_.size());
    const shoal::gps_data_t gps = gps_of(i);
    shoal::ais_t message{};
    message.utime = state_.utime;
    message.type = 1;
    message.mmsi = ship.mmsi;
    message.latitude = gps.latitude;
    message.longitude = gps.longitude;
    message.speed_mps = gps.speed;
    message.course_rad = gps.heading;
    message.heading_rad = std::numbers::pi / 2 - sim::yaw_of(q_WV(i).toRotationMatrix());
    message.turn_radps = -state_.angular_velocity_radps[i][2];
    messages.push_back(message);
    if (ship.named_utime && utime - *ship.named_utime < name_every_us) continue;
    ship.named_utime = utime;
    message.type = 5;
    message.name = state_.vehicle[i];
    messages.push_back(message);
  }
  return messages;
}

}  // namespace bridges::nmea
