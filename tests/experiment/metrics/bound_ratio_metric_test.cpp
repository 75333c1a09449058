// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "shoal/pose_t.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/experiment/metrics/bounded_worlds.hpp"

namespace {

using namespace bounded_worlds;

using testing::HasSubstr;

TEST(BoundRatio, DividesTheErrorOfAnEstimate) {
  BoundedWorld world(std::string(bound_with_clock) +
                     "  - {name: e, type: position_error, vehicle: auv, channel: est, from_s: 1}\n"
                     "  - {name: r, type: bound_ratio, metric: e, bound: b}\n");
  world.run_for(2);
  EXPECT_TRUE(std::isnan(world.figure("r.ratio")));
  shoal::pose_t pose{};
  pose.utime = world.test.world.epoch_us() + world.test.world.now().count();
  pose.pos[1] = 7;
  world.test.send("est", pose);
  world.run_for(1);
  EXPECT_NEAR(world.figure("r.ratio"), world.figure("e.rms_m") / world.figure("b.rms_m"), 1e-12);
  EXPECT_NEAR(world.figure("r.ratio"), 7 / std::sqrt(200.0), 1e-3);
}

TEST(BoundRatio, RefusesErrorsOfAnotherPosition) {
  const auto error = [](const std::string& keys) {
    return test::error_of_world(bounded_world(std::string(bound_with_clock) +
                                              "  - {name: e, type: position_error, channel: est, " + keys +
                                              "}\n"
                                              "  - {name: r, type: bound_ratio, metric: e, bound: b}\n"));
  };
  EXPECT_EQ(error("vehicle: auv, from_s: 1"), "");
  EXPECT_THAT(error("vehicle: boat, from_s: 1"),
              HasSubstr("metric 'r': 'e' and 'b' must be of the same vehicle, got 'boat' and 'auv'"));
  EXPECT_THAT(error("vehicle: auv"), HasSubstr("metric 'r': 'e' and 'b' must have the same 'from_s', got 0 and 1"));
  EXPECT_THAT(error("vehicle: auv, from_s: 1, until_s: 2"),
              HasSubstr("metric 'r': 'e' must not have 'until_s', got 2: the bound covers the whole run"));
  EXPECT_THAT(error("vehicle: auv, from_s: 1, dimensions: 3"),
              HasSubstr("metric 'r': 'e' must have 2 dimensions: the bound is horizontal"));
}

}  // namespace
