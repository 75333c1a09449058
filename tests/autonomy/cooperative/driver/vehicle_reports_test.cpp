// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/vehicle_reports.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "autonomy/cooperative/driver/nav_team.hpp"
#include "tests/autonomy/cooperative/driver/nav_team_fixture.hpp"

namespace {

using namespace nav_team_fixture;
using namespace navigation;

TEST(VehicleReports, NavigatesTheModemAndReportsTheOrigin) {
  const auto team = std::make_shared<const NavTeam>(
      team_with("{name: dvl, type: dvl}, {name: ahrs, type: ahrs}, {name: gps, type: gps, position_m: [-1, 0, 0.3]}"));
  VehicleReports reports(team, 0, {});
  shoal::ins_t north{};
  north.utime = 1'000'000;
  north.quat[0] = north.quat[3] = std::sqrt(0.5);  // x axis to the north
  reports.receive(north);
  shoal::gps_data_t fix{};
  fix.utime = 1'000'000;
  fix.gps_lock = 1;
  fix.xyz_pos[0] = 10;
  fix.xyz_pos[1] = 20;
  EXPECT_FALSE(reports.setup());
  EXPECT_TRUE(reports.receive(fix).empty());
  ASSERT_TRUE(reports.setup());
  // The antenna is 1 m behind the origin, the modem half a meter ahead.
  EXPECT_NEAR(reports.setup()->position_W.x(), 10, 1e-9);
  EXPECT_NEAR(reports.setup()->position_W.y(), 21.5, 1e-9);
  Estimate estimate;
  estimate.p_W << 10, 21.5;
  EXPECT_NEAR(reports.message(estimate).position_m[1], 21, 1e-9);
  // It turns to the east about the DVL, at the origin: the modem moves by (0.5, -0.5) m in 1 s.
  shoal::dvl_t dvl{};
  dvl.utime = 1'500'000;
  dvl.bottom_lock = 1;
  reports.receive(dvl);
  shoal::ins_t east{};
  east.utime = 2'500'000;
  east.quat[0] = 1;
  reports.receive(east);
  dvl.utime = 2'500'000;
  const auto events = reports.receive(dvl);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_NEAR(events[0].v_W.x(), 0.5, 1e-9);
  EXPECT_NEAR(events[0].v_W.y(), -0.5, 1e-9);
}

TEST(VehicleReports, MovesByTheMeanOfTheVelocitiesAtBothEnds) {
  const auto team = std::make_shared<const NavTeam>(
      team_with("{name: dvl, type: dvl}, {name: ahrs, type: ahrs}, {name: gps, type: gps}"));
  VehicleReports reports(team, 0, {});
  shoal::ins_t east{};
  east.utime = 1'000'000;
  east.quat[0] = 1;
  reports.receive(east);
  shoal::gps_data_t fix{};
  fix.utime = 1'000'000;
  fix.gps_lock = 1;
  reports.receive(fix);
  const auto speed_used = [&](std::int64_t utime, double speed_mps) {
    shoal::dvl_t dvl{};
    dvl.utime = utime;
    dvl.bottom_lock = 1;
    dvl.velocity_mps[0] = speed_mps;
    return reports.receive(dvl).at(0).v_W.x();
  };
  EXPECT_NEAR(speed_used(1'500'000, 1), 1, 1e-9);  // the first
  EXPECT_NEAR(speed_used(2'000'000, 2), 1.5, 1e-9);
  for (int i = 0; i < 14; ++i) reports.step();
  EXPECT_NEAR(speed_used(9'000'000, 3), 3, 1e-9);  // after silence
}

TEST(VehicleReports, GoOnWhenTheClockIsSet) {
  const auto team = std::make_shared<const NavTeam>(team_with("{name: pressure, type: pressure}"));
  VehicleReports reports(team, 0, {});
  shoal::pressure_t pressure{};
  for (const Time set_us : {0, 100'000'000, -50'000'000}) {
    const Time before = reports.time();
    reports.step();
    pressure.utime += 500'000 + set_us;
    reports.receive(pressure);
    // Up to a period is uncertain.
    EXPECT_GE(reports.time(), before) << set_us;
    EXPECT_LE(reports.time(), before + 500'000) << set_us;
    EXPECT_EQ(reports.message({}).utime, pressure.utime);
  }
}

TEST(VehicleReports, PlansTheTransmissionOfASynchronousModem) {
  const auto team = std::make_shared<const NavTeam>(team_with("{name: pressure, type: pressure}"));
  VehicleReports reports(team, 0, {});
  shoal::pressure_t pressure{};
  pressure.utime = 4'200'000;
  reports.receive(pressure);
  EXPECT_EQ(reports.transmission(), 6'000'000);
  pressure.utime = 6'000'000;
  reports.receive(pressure);
  EXPECT_EQ(reports.transmission(), 6'000'000);
}

VehicleReports reports_after_fix(const std::shared_ptr<const NavTeam>& team) {
  VehicleReports reports(team, 0, {});
  shoal::gps_data_t fix{};
  fix.utime = 9'000'000;
  fix.gps_lock = 1;
  reports.receive(fix);
  return reports;
}

/// Packet that took 0.2 s.
shoal::acoustic_received_t packet_of_b() {
  shoal::acoustic_received_t packet{};
  packet.source = "b";
  packet.utime = 10'200'000;
  packet.sent_utime = 10'000'000;
  packet.travel_time_s = 0.2;
  return packet;
}

NavFrame frame_of_b() {
  NavFrame frame;
  frame.sender = 1;
  frame.payload_time = 10'000'000;
  return frame;
}

TEST(VehicleReports, RangesHaveTheErrorsOfClocksAndDepths) {
  const auto team = std::make_shared<const NavTeam>(team_of_text(R"(
shoal: 1
name: two
medium: {water: {sound_speed_mps: 1500}}
vehicles:
  - {name: a, model: {shoal: 1, bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}],
     clock: {resolution_s: 0.001}, devices: [{name: modem, type: acoustic_modem}, {name: gps, type: gps},
     {name: pressure, type: pressure, pressure_noise: {gaussian_std: 20110}}]}}
  - {name: b, model: {shoal: 1, bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}],
     devices: [{name: modem, type: acoustic_modem}]}}
)"));
  VehicleReports reports = reports_after_fix(team);
  shoal::acoustic_received_t packet = packet_of_b();
  NavFrame frame = frame_of_b();
  // Stamps rounded down to 1 ms: 1500 m/s * 1 ms / sqrt(12).
  const double stamps_m = 1.5 / std::sqrt(12.0);
  EXPECT_NEAR(reports.range_event(packet, frame)->received.std_m, stamps_m, 1e-3);
  // 300 m away and 150 m above: half of the own error of depth, 20110 Pa or 2 m.
  frame.depth_m = 150;
  EXPECT_NEAR(reports.range_event(packet, frame)->received.std_m, std::hypot(stamps_m, 0.5 * 2), 1e-3);
}

/// The craft at 10 s: it heads north at 2 m/s, and measured the AUV 48 m ahead of the USBL, and 40 m below.
struct Sighting {
  explicit Sighting(const NavTeam& of, double ahead_m = 48, double below_m = 40)
      : team(std::make_shared<const NavTeam>(of)) {
    shoal::ins_t north{};
    north.utime = 9'000'000;
    north.quat[0] = north.quat[3] = std::sqrt(0.5);
    craft.receive(north);
    shoal::gps_data_t fix{};
    fix.utime = 9'000'000;
    fix.gps_lock = 1;
    fix.speed = 2;
    craft.receive(fix);
    auv.receive(fix);
    fix.utime = 10'000'000;
    craft.receive(fix);
    shoal::usbl_t relative{};
    relative.utime = 10'000'000;
    relative.target = "auv/transponder";
    relative.position_m[0] = ahead_m;
    relative.position_m[2] = -below_m;
    events = craft.receive(relative);
    shoal::pressure_t pressure{};
    pressure.utime = 10'000'000;
    pressure.depth_m = 40;
    auv.receive(pressure);
  }
  /// What the AUV makes of a frame that the craft sends at this time, by its clock, which is ahead.
  std::optional<NavEvent> sent_at(Time time, Time ahead = 0) {
    shoal::acoustic_received_t packet{};
    packet.source = "craft";
    packet.sent_utime = time;
    packet.utime = time - ahead + 50'000;
    packet.travel_time_s = 0.05;
    return auv.bearing_by(packet, craft.frame(time, {7}));
  }

  std::shared_ptr<const NavTeam> team;
  VehicleReports craft{team, 0, {}}, auv{team, 1, {}};
  std::vector<NavEvent> events;
};

TEST(VehicleReports, USBLMeasuresARangeAndADirectionFromModemToModem) {
  const Sighting sighting(usbl_team());
  ASSERT_EQ(sighting.events.size(), 1U);
  const Relative& seen = sighting.events[0].seen;
  EXPECT_EQ(seen.other, 1);
  EXPECT_FALSE(seen.by_other);
  // The USBL is 2 m ahead of the modem: 50 m to the north.
  EXPECT_NEAR(seen.range_m, 50, 1e-9);
  EXPECT_NEAR(seen.bearing_rad, M_PI / 2, 1e-9);
  // The direction turns by 0.04 across it, the heading by 0.03 about the vertical; an error across makes the level
  // longer.
  const double away_m = std::hypot(50, 40), across_m = std::hypot(0.04 * away_m, 0.03 * 50, 0.1);
  EXPECT_NEAR(seen.bearing_std_rad, across_m / 50, 1e-9);
  EXPECT_NEAR(seen.range_std_m,
              std::sqrt(std::pow(50 / away_m * 0.5, 2) + std::pow(40 * 0.02, 2) + 0.1 * 0.1 +
                        std::pow(std::hypot(50, across_m) - 50, 2)),
              1e-9);
}

TEST(VehicleReports, USBLAboveItsTransponderIsUncertainAllAround) {
  // The USBL is 2 m ahead of the modem.
  const Sighting sighting(usbl_team("{}"), -2, 200);
  ASSERT_EQ(sighting.events.size(), 1U);
  const Relative& below = sighting.events[0].seen;
  // 0.04 across and 0.02 along at 200 m; the level, 0 here, is as long as the error across.
  EXPECT_NEAR(below.range_m, 0, 1e-9);
  EXPECT_NEAR(below.bearing_std_rad, 8, 0.01);
  EXPECT_NEAR(below.range_std_m, std::hypot(8, 4), 0.01);
}

TEST(VehicleReports, AFrameTellsTheVehicleWhereItWasSeen) {
  Sighting sighting(usbl_team());
  // In the 0.4 s until the frame the craft went 0.8 m: the AUV was 49.2 m ahead of where it then is.
  const auto event = sighting.sent_at(10'400'000);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->kind, NavEvent::Kind::bearing);
  EXPECT_EQ(event->time, 10'000'000);
  EXPECT_EQ(event->payload, Bytes{7});
  EXPECT_EQ(event->seen.payload_time, 10'400'000);
  EXPECT_EQ(event->seen.other, 0);
  EXPECT_TRUE(event->seen.by_other);
  EXPECT_NEAR(event->seen.range_m, 49.2, 1e-9);
  EXPECT_NEAR(event->seen.bearing_rad, -M_PI / 2, 1e-9);
  // The same relative measurement again is not new.
  EXPECT_FALSE(sighting.sent_at(11'400'000));
}

TEST(VehicleReports, AnOldSightIsNotSent) {
  Sighting sighting(usbl_team());
  EXPECT_FALSE(sighting.sent_at(15'100'000));
  EXPECT_TRUE(sighting.sent_at(14'900'000));
}

TEST(VehicleReports, ASightByAClockThatIsFarAheadIsNotUsed) {
  Sighting sighting(usbl_team());
  constexpr Time hour = 3'600'000'000;
  EXPECT_FALSE(sighting.sent_at(10'400'000, hour));
  EXPECT_FALSE(sighting.sent_at(10'400'000, -hour));
  // And does not keep a right one from being used.
  EXPECT_TRUE(sighting.sent_at(10'400'000));
}

TEST(VehicleReports, FramesThatAreNotARangeToTheirSenderAreNotHeard) {
  const auto team = std::make_shared<const NavTeam>(team_of_text(R"(
shoal: 1
name: two
medium: {water: {}}
vehicles:
  - {name: a, model: {shoal: 1, bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}],
     devices: [{name: modem, type: acoustic_modem}, {name: gps, type: gps}]}}
  - {name: b, model: {shoal: 1, bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}],
     devices: [{name: modem, type: acoustic_modem}]}}
)"));
  VehicleReports reports = reports_after_fix(team);
  shoal::acoustic_received_t packet = packet_of_b();
  NavFrame frame = frame_of_b();
  const auto event = reports.range_event(packet, frame);
  ASSERT_TRUE(event);
  EXPECT_NEAR(event->received.range_m, 0.2 * team->sound.mean_speed_mps(0, 0), 1e-9);
  EXPECT_EQ(event->received.std_m, VehicleReports::min_range_std_m);
  frame.payload_time = 9'000'000;  // said a second before
  EXPECT_FALSE(reports.range_event(packet, frame));
  frame.payload_time = 10'000'000;
  packet.source = "gateway";
  EXPECT_FALSE(reports.range_event(packet, frame));
  packet.source = "b";
  packet.travel_time_s = 61;
  EXPECT_FALSE(reports.range_event(packet, frame));
  packet.travel_time_s = 0.2;
  frame.sender = 0;
  EXPECT_FALSE(reports.range_event(packet, frame));
}

}  // namespace
