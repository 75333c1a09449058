// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/land_events.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "autonomy/cooperative/driver/land_team.hpp"

namespace {

using namespace navigation;
using testing::HasSubstr;

/// Two rovers; the first is at (10, 20) and faces north, with a sensor 0.2 m ahead that looks to the left.
NavTeam rovers() {
  return land_team_of(world_of_text(R"(
shoal: 1
name: yard
vehicles:
  - name: rover1
    position_m: [10, 20, 0]
    rpy_deg: [0, 0, 90]
    model: &rover
      shoal: 1
      bodies:
        - {name: base, parts: [{shape: box, size_m: [0.5, 0.3, 0.1], mass_kg: 10, position_m: [0, 0, 0.2]}]}
        - {name: l, position_m: [0, 0.2, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}
        - {name: r, position_m: [0, -0.2, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}
      joints:
        - {name: left, type: hinge, bodies: [base, l], axis: [0, 1, 0]}
        - {name: right, type: hinge, bodies: [base, r], axis: [0, 1, 0]}
      devices:
        - {name: wheels, type: odometry, left_joint: left, right_joint: right, rate_hz: 10, noise: {gaussian_std: 0.01}}
        - {name: eye, type: swarm_position, position_m: [0.2, 0, 0], rpy_deg: [0, 0, 90],
           relative_noise: {gaussian_std: 0.1}}
        - {name: gps, type: gps, position_m: [0.3, 0, 0],
           horizontal_noise: {gaussian_std: 0.5, gauss_markov_std: 2, gauss_markov_time_s: 60}}
        - {name: radio, type: modem}
  - {name: rover2, model: *rover}
  - name: crate
    model: {shoal: 1, bodies: [{name: box, parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]}],
            devices: [{name: clock, type: clock}]}
)"));
}

shoal::odometry_t odometry_at(double time_s, double x_m, double y_m, double theta_rad) {
  shoal::odometry_t odometry{};
  odometry.utime = std::llround(1e6 * time_s);
  odometry.x_m = x_m;
  odometry.y_m = y_m;
  odometry.theta_rad = theta_rad;
  return odometry;
}

shoal::swarm_position_t sight_at(double time_s, const std::string& other, double x_m, double y_m) {
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

TEST(LandTeam, HasTheVehiclesWithOdometryAndTheErrorsOfTheirDevices) {
  const NavTeam team = rovers();
  ASSERT_EQ(team.vehicles.size(), 2U);
  EXPECT_EQ(team.index_of("crate"), std::nullopt);
  const NavVehicle& rover = team.vehicles[0];
  EXPECT_EQ(rover.land->odometry.channel, "rover1.wheels");
  EXPECT_EQ(rover.modem_command, "rover1.radio.cmd");
  EXPECT_EQ(rover.land->seen_std_m, 0.1);
  EXPECT_EQ(rover.fix_std_m, 0.5);
  EXPECT_EQ(rover.errors.slow_fix_m, 2);
  EXPECT_EQ(rover.errors.slow_fix_time_s, 60);
  // 0.1 m radius and 0.01 rad at 10 Hz: each wheel has 0.001 m sqrt(10) in 1 s, and the wheels are 0.4 m apart.
  EXPECT_NEAR(rover.land->along_density, 0.001 * 0.001 * 10 / 2, 1e-12);
  EXPECT_NEAR(rover.errors.heading_walk_radprts, 0.001 * std::sqrt(2 * 10) / 0.4, 1e-9);
}

TEST(LandTeam, OfADataSetHasTheErrorsOfItsRobotsWhichDoNotSlideSideways) {
  const NavTeam team = land_team_of(world_of_text(
      "shoal: 1\nname: mrclam\nvehicles:\n  - {name: robot1, model: {shoal: 1, bodies: [{name: base, kinematic: true, "
      "parts: [{shape: cylinder, radius_m: 0.17, length_m: 0.1}]}]}}\n"));
  ASSERT_EQ(team.vehicles.size(), 1U);
  const NavVehicle& robot = team.vehicles[0];
  EXPECT_EQ(robot.land->odometry.channel, "robot1.odometry");
  // In 1 s 6 cm along the track, 3 mm across.
  EXPECT_NEAR(std::sqrt(robot.land->along_density), 0.06, 1e-12);
  EXPECT_NEAR(std::sqrt(robot.land->across_density), 0.003, 1e-12);
  EXPECT_EQ(robot.errors.heading_walk_radprts, 0.06);
}

TEST(LandTeam, OfNoVehicleItCanNavigateIsAnError) {
  try {
    land_team_of(
        world_of_text("shoal: 1\nname: store\nvehicles:\n  - name: crate\n    model: {shoal: 1, bodies: [{name: "
                      "box, parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]}], devices: [{name: clock, "
                      "type: clock}]}\n"));
    FAIL() << "it has a team";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("world 'store' has no vehicle that shoal-nav can navigate: vehicle 'crate'"));
  }
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
                                      {500'000, 0, sight_at(0.5, "rover2", 3, 0)},
                                      {500'000, 0, sight_at(0.5, "landmark6", 3, 0)}});
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
