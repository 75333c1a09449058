// SPDX-License-Identifier: BSD-3-Clause
#include "sim/geometry/zone.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shoal/gps_data_t.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "sim/director/condition_watch.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using sim::Vector3d;
using sim::Zone;
using sim::ZoneConfig;
using sim::ZoneShape;

TEST(Zone, ABoxTurnedByFortyFiveDegreesReachesItsCorner) {
  ZoneConfig config;
  config.shape = ZoneShape::box;
  config.position_m = {10, 0, 1};
  config.rpy_rad = {0, 0, sim::degrees_to_radians(45)};
  config.size_m = {2, 2, 2};
  const Zone zone(config);
  // The corner is at sqrt(2) = 1.414 m along world x; unturned the box would end at 1 m.
  EXPECT_TRUE(zone.contains({11.41, 0, 1}));
  EXPECT_FALSE(zone.contains({11.42, 0, 1}));
  EXPECT_FALSE(zone.contains({10.9, 0.9, 1}));
  EXPECT_TRUE(zone.contains({10, 0, 2}));
  EXPECT_FALSE(zone.contains({10, 0, 2.001}));
}

TEST(Zone, ASphereEndsAtItsRadius) {
  ZoneConfig config;
  config.shape = ZoneShape::sphere;
  config.position_m = {1, 2, 3};
  config.radius_m = 5;
  const Zone zone(config);
  EXPECT_TRUE(zone.contains({4, 6, 3}));  // 3, 4, 5
  EXPECT_FALSE(zone.contains({4, 6, 3.1}));
}

TEST(Zone, ACylinderStandsAlongItsOwnZ) {
  ZoneConfig config;
  config.shape = ZoneShape::cylinder;
  config.rpy_rad = {0, sim::degrees_to_radians(90), 0};  // it lies along x
  config.radius_m = 1;
  config.height_m = 10;
  const Zone zone(config);
  EXPECT_TRUE(zone.contains({4.9, 0, 0.9}));
  EXPECT_FALSE(zone.contains({5.1, 0, 0}));
  EXPECT_FALSE(zone.contains({0, 0, 1.1}));
}

TEST(Zone, APolygonMayBeHollow) {
  ZoneConfig config;
  config.shape = ZoneShape::polygon;
  // An L: the square of 2 m without its upper right quarter.
  config.points_m = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  config.low_m = -3;
  config.high_m = 0;
  const Zone zone(config);
  EXPECT_TRUE(zone.contains({0.5, 1.5, -1}));
  EXPECT_TRUE(zone.contains({1.5, 0.5, -1}));
  EXPECT_FALSE(zone.contains({1.5, 1.5, -1}));
  EXPECT_FALSE(zone.contains({0.5, 0.5, 0.1}));
  EXPECT_FALSE(zone.contains({0.5, 0.5, -3.1}));
}

TEST(Zones, DenyOnlyWhatTheySay) {
  ZoneConfig tunnel;
  tunnel.name = "tunnel";
  tunnel.shape = ZoneShape::sphere;
  tunnel.gps_denied = true;
  const sim::Zones zones({tunnel});
  EXPECT_TRUE(zones.denied(sim::ZoneFlag::gps_denied, Vector3d::Zero()));
  EXPECT_FALSE(zones.denied(sim::ZoneFlag::radio_denied, Vector3d::Zero()));
  EXPECT_FALSE(zones.denied(sim::ZoneFlag::gps_denied, {2, 0, 0}));
  EXPECT_EQ(zones.index_of("tunnel"), 0);
  EXPECT_EQ(zones.index_of("cave"), -1);
}

TEST(Zones, DenyGpsUntilItHasBeenAcquiredAgain) {
  test::TestWorld test(test::rover_world("        - {name: gps, type: gps, rate_hz: 10, phase_s: 0.05, "
                                         "reacquisition_s: 0.5}\n") +
                       "zones:\n  - {name: roof, shape: sphere, radius_m: 2, gps_denied: true}\n"
                       "events:\n  - {name: a, at: 1, do: [{move: {name: r1, position_m: [5, 0, 0]}}]}\n");
  test::Listener<shoal::gps_data_t> fixes(test, "r1.gps");
  test.run_for(1);
  for (const auto& fix : fixes.take_all()) EXPECT_EQ(fix.gps_lock, 0);
  test.run_for(1);
  const auto all = fixes.take_all();
  ASSERT_EQ(all.size(), 10u);
  // Denied last at 0.95 s, so that there is no fix up to 1.45 s: that is five samples from 1.05 s.
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].gps_lock, i < 5 ? 0 : 1) << i;
}

TEST(Zones, DenyRadioToSenderAndReceiver) {
  const std::string model =
      "    model: {shoal: 1, vehicle: v, bodies: [{name: b, parts: [{shape: sphere, radius_m: 0.1, "
      "mass_kg: 1}]}], devices: [{name: modem, type: modem, rate_hz: 100}]}\n";
  for (const double zone_x : {0.0, 5.0, 20.0}) {
    test::TestWorld test("shoal: 1\nphysics: {gravity_mps2: 0}\nvehicles:\n  - name: a\n" + model +
                         "  - name: b\n    position_m: [5, 0, 0]\n" + model +
                         "zones:\n  - {name: cave, shape: sphere, radius_m: 1, radio_denied: true, position_m: [" +
                         std::to_string(zone_x) + ", 0, 0]}\n");
    test::Listener<shoal::modem_received_t> received(test, "b.modem");
    shoal::modem_send_t message{};
    message.size = 3;
    message.data = {1, 2, 3};
    test.send("a.modem.cmd", message);
    test.run_for(1);
    EXPECT_EQ(received.take_all().size(), zone_x == 20.0 ? 1u : 0u) << zone_x;
  }
}

}  // namespace
