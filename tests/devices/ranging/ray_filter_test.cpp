// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/planar_lidar_t.hpp"
#include "tests/devices/ranging/lidar_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace lidar_fixture;

TEST(Lidar, DoesNotSeeItsOwnVehicleUnlessAsked) {
  const auto ahead = [](const char* more) {
    // Inside the hull's height, from behind its front face.
    test::TestWorld test(test::rover_world(
        "        - {name: lidar, type: lidar, position_m: [-0.5, 0, 0.03], beams: 1" + std::string(more) + "}\n"));
    test::Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
    test.run_for(0.5);
    return scans.last().ranges[0];
  };
  EXPECT_EQ(ahead(""), 30.0f);
  EXPECT_NEAR(ahead(", sees_own_vehicle: true"), 0.3, 1e-3);  // the hull's rear face at x = -0.2
}

TEST(Lidar, LooksThroughTheCategoriesItIsCommandedTo) {
  const std::string glass =
      "  - {name: pane, fixed: true, position_m: [2, 0, 1], parts: [{shape: box, size_m: [0.02, 4, 2], category: "
      "glass}]}\n";
  const auto ahead = [&](const char* more) {
    test::TestWorld test(test::rover_world(lidar(more), glass + wall) + "\ncategories: [glass]\n");
    test::Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
    test.run_for(0.5);
    return scans.last().ranges[90];
  };
  EXPECT_NEAR(ahead(""), 1.99, 0.005);
  EXPECT_NEAR(ahead(", see_through: [glass]"), 5.0, 0.005);
}

}  // namespace
