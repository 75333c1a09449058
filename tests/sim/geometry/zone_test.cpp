// SPDX-License-Identifier: BSD-3-Clause
#include "sim/geometry/zone.hpp"

#include <gtest/gtest.h>

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

}  // namespace
