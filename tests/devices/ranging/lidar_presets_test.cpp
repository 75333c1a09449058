// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/planar_lidar_t.hpp"
#include "shoal/point_cloud_t.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"

namespace {

using shoal::planar_lidar_t;
using shoal::point_cloud_t;
using test::first_truth;
using test::ranging_world;
using test::wall_at;

TEST(LaserReturn, PresetsHaveTheBeamsOfTheirDataSheets) {
  const auto scan = [](const std::string& preset) {
    return first_truth<planar_lidar_t>(ranging_world("type: lidar, preset: " + preset, wall_at(200)));
  };
  EXPECT_EQ(scan("lms200").nranges, 181);
  EXPECT_NEAR(scan("lms200").radstep, sim::degrees_to_radians(1), 1e-7);
  EXPECT_FLOAT_EQ(scan("lms200").ranges[0], 8.191f);
  EXPECT_EQ(scan("lms291").nranges, 181);
  EXPECT_EQ(scan("utm30lx").nranges, 1081);
  EXPECT_NEAR(scan("utm30lx").radstep, sim::degrees_to_radians(0.25), 1e-7);
}

TEST(Lidar3d, PresetsHaveTheRingsAndColumnsOfTheirDataSheets) {
  const std::string room =
      "  - {name: shell, fixed: true, parts: [{shape: sphere, radius_m: 20, material: nothing_special}]}\n";
  for (const auto& [preset, beams] : {std::pair{"vlp16", 16 * 1800}, {"os1_32", 32 * 1024}}) {
    std::string yaml = ranging_world(std::string("type: lidar3d, preset: ") + preset, room);
    yaml.replace(yaml.find("rate_hz: 100"), 12, "rate_hz: 10");
    test::TestWorld test(yaml);
    test::Listener<point_cloud_t> clouds(test, "r1.s");
    test.run_for(0.2);
    EXPECT_EQ(clouds.last().count, beams);  // from inside a solid, every beam ends where it leaves it
  }
}

}  // namespace
