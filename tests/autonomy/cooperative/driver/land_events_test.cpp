// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/land_events.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/autonomy/cooperative/driver/land_rovers.hpp"

namespace {

using namespace navigation;
using land_rovers::rovers;

shoal::odometry_t odometry_at(double time_s, double x_m, double y_m, double theta_rad) {
  shoal::odometry_t odometry{};
  odometry.utime = std::llround(1e6 * time_s);
  odometry.x_m = x_m;
  odometry.y_m = y_m;
  odometry.theta_rad = theta_rad;
  return odometry;
}

shoal::swarm_position_t measurement_at(double time_s, const std::string& other, double x_m, double y_m) {
  shoal::swarm_position_t seen{};
  seen.utime = std::llround(1e6 * time_s);
  seen.count = 1;
  seen.vehicle = {other};
  seen.relative_m = {{x_m, y_m, 0}};
  seen.absolute_m = {{0, 0, 0}};
  return seen;
}

NavRecord record_of(std::vector<NavRecord::Item> items) {
  NavRecord record;
  record.team = std::make_shared<NavTeam>(rovers());
  record.items = std::move(items);
  return record;
}

TEST(OdometryTrack, BeginsWithTheStartPose) {
  const NavTeam team = rovers();
  OdometryTrack track(*team.vehicles[0].land);
  track.add(1'000'000, odometry_at(1, 0.5, 0, 0));
  track.add(3'000'000, odometry_at(3, 0.5, 0.4, 0.2));
  track.add(3'000'000, odometry_at(3, 9, 9, 9));
  ASSERT_EQ(track.segments().size(), 2U);
  // It faces north: ahead is north, left is west.
  EXPECT_NEAR(track.segments()[0].v_W.x(), 0, 1e-12);
  EXPECT_NEAR(track.segments()[0].v_W.y(), 0.5, 1e-12);
  EXPECT_NEAR(track.segments()[1].v_W.x(), -0.2, 1e-12);
  EXPECT_NEAR(track.heading_rad(2'000'000), std::numbers::pi / 2 + 0.1, 1e-12);
  // The noise is along the vehicle only.
  EXPECT_NEAR(track.segments()[0].q(1, 1), team.vehicles[0].land->along_density, 1e-15);
  EXPECT_NEAR(track.segments()[0].q(0, 0), 0, 1e-15);
}

TEST(LandEvents, OfASightAreRangeAndBearingFromTheVehicle) {
  const NavRecord record = record_of({{1'000'000, 0, odometry_at(1, 0, 0, 0)},
                                      {500'000, 0, measurement_at(0.5, "rover2", 3, 0)},
                                      {500'000, 0, measurement_at(0.5, "landmark6", 3, 0)}});
  const LandEvents events = land_events_of(record);
  ASSERT_EQ(events.events.size(), 1U);
  const Relative& seen = events.events[0].event.seen;
  EXPECT_EQ(seen.other, 1);
  // 0.2 m ahead and 3 m to the left of a vehicle that faces north.
  EXPECT_NEAR(seen.range_m, std::hypot(3, 0.2), 1e-9);
  EXPECT_NEAR(std::remainder(seen.bearing_rad - std::atan2(0.2, -3), 2 * std::numbers::pi), 0, 1e-9);
  EXPECT_NEAR(seen.bearing_std_rad, 0.1 / seen.range_m, 1e-12);
}

TEST(LandEvents, OfAFixAreThePositionOfTheOriginAndOfAMessageItsSending) {
  shoal::gps_data_t fix{};
  fix.utime = 200'000;
  fix.gps_lock = 3;
  fix.xyz_pos[0] = 10;
  fix.xyz_pos[1] = 20.3;
  shoal::modem_send_t send{};
  send.data = {1, 2, 3};
  shoal::modem_received_t packet{};
  packet.utime = 400'000;
  packet.source = "rover1";
  packet.data = send.data;
  shoal::modem_received_t unknown = packet;
  unknown.data = {9};
  const LandEvents events =
      land_events_of(record_of({{200'000, 0, fix}, {300'000, 0, send}, {400'000, 1, packet}, {400'000, 1, unknown}}));
  ASSERT_EQ(events.events.size(), 3U);
  EXPECT_NEAR(events.events[0].event.p_W.y(), 20, 1e-9);
  EXPECT_EQ(events.events[0].event.std_m, 0.5);
  EXPECT_EQ(events.events[1].event.kind, NavEvent::Kind::payload);
  EXPECT_EQ(events.events[2].event.kind, NavEvent::Kind::received);
  EXPECT_EQ(events.events[2].event.received.payload_time, events.events[1].event.time);
  EXPECT_EQ(events.events[2].event.received.sender, 0);
}

}  // namespace
