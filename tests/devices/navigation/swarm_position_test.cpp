// SPDX-License-Identifier: BSD-3-Clause
#include "shoal/swarm_position_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// r1 at (1, 2) looking north, its sensor 0.2 m above the ground, and boxes as other vehicles.
std::string swarm_world(const std::string& more, const std::string& objects = "") {
  const std::string box =
      ", model: {shoal: 1, vehicle: box, bodies: [{name: b, position_m: [0, 0, 0.2], parts: "
      "[{shape: box, size_m: [0.4, 0.4, 0.4], mass_kg: 5}]}]}}\n";
  return test::rover_world(
             "        - {name: swarm, type: swarm_position, position_m: [0, 0, 0.1], rate_hz: 10" + more + "}\n",
             objects, "    position_m: [1, 2, 0]\n    rpy_deg: [0, 0, 90]\n") +
         "  - {name: near, position_m: [1, 6, 0]" + box + "  - {name: far, position_m: [31, 2, 0]" + box;
}

TEST(SwarmPosition, GivesPositionsInTheSensorFrame) {
  test::TestWorld test(swarm_world(", range_max_m: 100, absolute: true"));
  test::Listener<shoal::swarm_position_t> reports(test, "r1.swarm");
  test.run_for(0.5);
  const auto report = reports.last();
  ASSERT_EQ(report.count, 2);
  EXPECT_EQ(report.vehicle[0], "near");  // 4 m north of a rover that looks north: straight ahead
  EXPECT_NEAR(report.relative_m[0][0], 4, 2e-3);
  EXPECT_NEAR(report.relative_m[0][1], 0, 2e-3);
  EXPECT_EQ(report.vehicle[1], "far");  // 30 m east: to the right
  EXPECT_NEAR(report.relative_m[1][0], 0, 2e-3);
  EXPECT_NEAR(report.relative_m[1][1], -30, 2e-3);
  EXPECT_NEAR(report.absolute_m[1][0], 31, 2e-3);
}

TEST(SwarmPosition, SeesNothingBeyondItsRange) {
  test::TestWorld test(swarm_world(", range_max_m: 29"));
  test::Listener<shoal::swarm_position_t> reports(test, "r1.swarm");
  test.run_for(0.5);
  const auto report = reports.last();
  ASSERT_EQ(report.count, 1);
  EXPECT_EQ(report.vehicle[0], "near");
  EXPECT_TRUE(std::isnan(report.absolute_m[0][0]));  // not asked for
}

TEST(SwarmPosition, AWallHidesAVehicleWhenOcclusionIsOn) {
  const std::string wall =
      "  - {name: wall, fixed: true, position_m: [1, 4, 1], parts: [{shape: box, size_m: [2, 0.1, 2]}]}\n";
  const auto seen = [&](const char* more) {
    test::TestWorld test(swarm_world(std::string(", range_max_m: 100") + more, wall));
    test::Listener<shoal::swarm_position_t> reports(test, "r1.swarm");
    test.run_for(0.5);
    return reports.last().count;
  };
  EXPECT_EQ(seen(", occlusion: false"), 2);
  EXPECT_EQ(seen(", occlusion: true"), 1);
}

TEST(SwarmPosition, NoiseHasTheSpreadAskedFor) {
  test::TestWorld test(swarm_world(", range_max_m: 10, relative_noise: {gaussian_std: 0.3}"));
  test::Listener<shoal::swarm_position_t> reports(test, "r1.swarm");
  test.run_for(100);
  double squares = 0, count = 0;
  for (const auto& report : reports.take_all()) {
    const double error = report.relative_m[0][1];
    squares += error * error;
    ++count;
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.3, 4 * 0.3 / std::sqrt(2 * count));
}

}  // namespace
