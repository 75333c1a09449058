// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "autonomy/acomms/state_packet.hpp"
#include "autonomy/behaviors/make_behavior.hpp"
#include "autonomy/missions/marine/coop_auv.hpp"
#include "sim/random/random.hpp"

/// Reports of a surface craft's and an AUV's devices, and an AUV that lives on them.
namespace voyage_test {

using autonomy::AcousticState;
using autonomy::CoopAuv;
using autonomy::make_route;
using autonomy::Vector2d;

inline constexpr std::int64_t second = 1'000'000;
inline constexpr std::int64_t epoch = 1'767'225'600 * second;  // a multiple of 20 s
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double pi = std::numbers::pi;

inline shoal::gps_data_t fix_at(std::int64_t utime, const Vector2d& p_W, double std_m = 0.5) {
  shoal::gps_data_t fix{};
  fix.utime = utime;
  fix.gps_lock = 1;
  fix.horizontal_accuracy = std_m;
  fix.xyz_pos[0] = p_W.x();
  fix.xyz_pos[1] = p_W.y();
  return fix;
}

inline shoal::dvl_t dvl_at(std::int64_t utime, double ahead_mps) {
  shoal::dvl_t dvl{};
  dvl.utime = utime;
  dvl.bottom_lock = 1;
  dvl.velocity_mps[0] = ahead_mps;
  return dvl;
}

inline shoal::compass_t compass_at(std::int64_t utime, double yaw_rad) {
  shoal::compass_t compass{};
  compass.utime = utime;
  compass.heading_true_rad = 0.5 * pi - yaw_rad;
  return compass;
}

inline shoal::pressure_t depth_at(std::int64_t utime, double depth_m) {
  shoal::pressure_t pressure{};
  pressure.utime = utime;
  pressure.depth_m = depth_m;
  return pressure;
}

/// A frame from a beacon at rest.
inline shoal::acoustic_received_t packet(const Vector2d& beacon_W, std::int64_t sent, std::int64_t arrival,
                                         int sender = 1) {
  AcousticState state;
  state.sender = sender;
  state.utime = sent - second / 5;
  state.east_m = beacon_W.x();
  state.north_m = beacon_W.y();
  state.depth_m = 1;
  state.east_std_m = state.north_std_m = 0.5;
  const shoal::modem_send_t sent_message = *autonomy::to_everybody(state);
  shoal::acoustic_received_t received{};
  received.utime = arrival;
  received.sent_utime = sent;
  received.travel_time_s = static_cast<double>(arrival - sent) * 1e-6;
  received.source = "boat" + std::to_string(sender);
  received.size = sent_message.size;
  received.data = sent_message.data;
  return received;
}

/// An AUV that goes east at 1.5 m/s with a compass that is 4 degrees off, between two beacons that send each 10 s; a
/// packet takes 3 s, and is reported when it is complete.
struct Voyage {
  explicit Voyage(const CoopAuv::Params& params) : auv(params, make_route({{5000, 0}}, 1.5, false)) {}

  void run(int seconds) {
    sim::Random random(1, "voyage");
    for (int i = 1; i <= 5 * seconds; ++i) {
      t += second / 5;
      random.begin_step(i);
      const std::int64_t own = t + clock_error_us;
      const bool submerged = decision.helm && decision.helm->depth_m > 0;
      if (submerged) p_W.x() += 0.3;
      if (has_heading) auv.receive(compass_at(own, 0.07 + 0.02 * random.gaussian()));
      auv.receive(depth_at(own, submerged ? 20 : 0));
      auv.receive(dvl_at(own, submerged ? 1.5 : 0));
      if (!submerged && i % 5 == 0) auv.receive(fix_at(own, p_W));
      if (i % 50 == 0) receive_state(beacons[static_cast<std::size_t>(i / 50 % 2)], own, random.gaussian());
      while (!waiting.empty() && waiting.front().utime + 3 * second <= own) {
        auv.receive(waiting.front());
        waiting.erase(waiting.begin());
      }
      if (i % 2 == 0) decision = auv.step();
    }
  }
  void receive_state(const Vector2d& beacon_W, std::int64_t own, double noise_m) {
    const double depth_m = decision.helm && decision.helm->depth_m > 0 ? 19 : -1;
    const double range_m = std::hypot((p_W + modem_W - beacon_W).norm(), depth_m) + noise_m;
    const bool first = beacon_W == beacons[0];
    waiting.push_back(packet(first ? beacon_W + wrong_by_W : beacon_W,
                             own - clock_error_us - std::llround(range_m / 1500 * 1e6), own, first ? 1 : 2));
  }
  double error_m() const { return (auv.cooperative()->position_at(t + clock_error_us) - p_W).norm(); }
  double reckoned_error_m() const { return (auv.dead_reckoning()->position_at(t + clock_error_us) - p_W).norm(); }

  CoopAuv auv;
  CoopAuv::Decision decision;
  std::int64_t t = epoch;
  std::int64_t clock_error_us = 0;
  Vector2d p_W = Vector2d::Zero();
  Vector2d modem_W = Vector2d::Zero();
  Vector2d wrong_by_W = Vector2d::Zero();  ///< what the first beacon says of itself
  bool has_heading = true;
  std::array<Vector2d, 2> beacons = {Vector2d(300, 300), Vector2d(900, -250)};
  std::vector<shoal::acoustic_received_t> waiting;
};

inline CoopAuv::Params auv_params() {
  CoopAuv::Params params;
  params.name = "auv";
  params.depth_m = 20;
  params.filter.heading_bias_std_rad = 0.07;
  return params;
}

}  // namespace voyage_test
