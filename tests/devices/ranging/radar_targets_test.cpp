// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/radar_targets.hpp"

#include <gtest/gtest.h>

#include "tests/devices/world_fixture.hpp"

namespace {

using devices::RadarTargets;

/// A crate of 2 m, 100 m ahead and half of it in the water, an object with a plane, and a vehicle.
const std::string world_text = R"(
shoal: 1
medium: {water: {}}
objects:
  - {name: crate, fixed: true, position_m: [101, 0, 0], parts: [{shape: box, size_m: [2, 2, 2]}]}
  - {name: shore, fixed: true, position_m: [0, 0, -50], parts: [{shape: plane}]}
vehicles:
  - {name: r1, position_m: [0, 0, 1], model: {shoal: 1, bodies: [{name: hull, parts: [{shape: sphere, mass_kg: 1}]}]}}
)";

devices::RadarLook look_from(double height_m, double heading_deg) {
  devices::RadarLook look;
  look.X_WS.translation() = sim::Vector3d(0, 0, height_m);
  look.heading_rad = sim::degrees_to_radians(heading_deg);
  look.height_m = height_m;
  return look;
}

TEST(RadarTargets, AreAllOthersWithTheirCrossSections) {
  test::TestWorld test(world_text);
  RadarTargets targets;
  const devices::RadarCrossSection rcs[] = {{"crate", 7}};
  targets.update(test.world, test.world.find_vehicle("r1")->group(), rcs);
  ASSERT_EQ(targets.all().size(), 2u);
  const auto& crate = targets.all()[0];
  EXPECT_EQ(crate.rcs_m2, 7);
  EXPECT_FALSE(crate.land);
  EXPECT_TRUE(targets.all()[1].land);
  EXPECT_FALSE(targets.all()[1].rcs_m2);
  EXPECT_EQ(targets.of_group(crate.group), 0);
  EXPECT_EQ(targets.of_group(test.world.find_vehicle("r1")->group()), -1);
  EXPECT_EQ(targets.of_group(-1), -1);
}

TEST(RadarTargets, TheOutlineIsWhatIsAboveTheSea) {
  test::TestWorld test(world_text);
  RadarTargets targets;
  targets.update(test.world, -1, {});
  const auto& crate = targets.all()[1];  // behind the vehicle
  const auto outline = crate.outline(look_from(5, 0));
  ASSERT_TRUE(outline);
  EXPECT_NEAR(outline->left_rad, std::atan(1 / 100.0), 1e-12);
  EXPECT_NEAR(outline->right_rad, -std::atan(1 / 100.0), 1e-12);
  EXPECT_NEAR(outline->bottom_rad, -std::atan(5 / std::hypot(100, 1)), 1e-12);  // the sea at its front
  EXPECT_NEAR(outline->top_rad, -std::atan(4 / std::hypot(102, 1)), 1e-12);
  EXPECT_NEAR(outline->near_m, std::hypot(100, 1, 4), 1e-12);
  auto submerged = look_from(5, 0);
  submerged.surface_m = 2;
  EXPECT_FALSE(crate.outline(submerged));
}

TEST(RadarTargets, AreWithinTheBeamOrNot) {
  test::TestWorld test(world_text);
  RadarTargets targets;
  targets.update(test.world, -1, {});
  const auto& crate = targets.all()[1];
  const double beam_rad = sim::degrees_to_radians(4);
  EXPECT_TRUE(crate.may_be_within(look_from(5, 0), beam_rad, 200));
  EXPECT_TRUE(crate.may_be_within(look_from(5, 4.5), beam_rad, 200));  // its edge; it is 2 degrees wide
  EXPECT_FALSE(crate.may_be_within(look_from(5, 6), beam_rad, 200));
  EXPECT_FALSE(crate.may_be_within(look_from(5, 180), beam_rad, 200));
  EXPECT_FALSE(crate.may_be_within(look_from(5, 0), beam_rad, 90));
}

}  // namespace
