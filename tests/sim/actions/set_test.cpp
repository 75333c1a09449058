// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/planar_lidar_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

TEST(Events, SetTheRangeOfALidarAgainAndAgain) {
  test::TestWorld test(
      test::rover_world("        - {name: lidar, type: lidar, beams: 3, fov_deg: 1, range_max_m: 10, rate_hz: 10, "
                        "position_m: [0, 0, 0.4]}\n") +
      "events:\n  - {name: a, at: 1, do: [{set: {device: r1/lidar, values: {range_max_m: 4}}}]}\n"
      "  - {name: b, at: 2, do: [{set: {device: r1/lidar, values: {rate_hz: 20}}}]}\n");
  test::Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
  test.run_for(1);
  EXPECT_EQ(scans.last().ranges[1], 10);
  test.run_for(1);
  EXPECT_EQ(scans.last().ranges[1], 4);
  test.run_for(1);
  const auto all = scans.take_all();
  EXPECT_EQ(all.back().ranges[1], 4);  // the first change outlives the second
  EXPECT_NEAR(static_cast<double>(all.size()), 20, 1);
}

}  // namespace
