// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "messages/yaml/message_writer.hpp"
#include "shoal/pose_t.hpp"
#include "tests/experiment/score/metric_worlds.hpp"

namespace {

using namespace metric_worlds;

TEST(BytesPerMeter, NeedsAnErrorThatBecameSmaller) {
  const std::string metrics =
      "  - {name: with, type: position_error, vehicle: r1, channel: est}\n"
      "  - {name: without, type: position_error, vehicle: r1, channel: est2}\n"
      "  - {name: cost, type: bytes_per_metre, metric: with, against: without}\n";
  MetricWorld world(metrics);
  world.run_for(0.1);
  world.estimate({3, 0, 0}, some_covariance());
  shoal::pose_t pose{};
  pose.utime = world.test.world.epoch_us() + world.test.world.now().count();
  pose.pos[0] = 1 + 8;
  pose.pos[1] = 2;
  world.test.send("est2", pose);
  world.run_for(0.01);
  EXPECT_NEAR(world.figure("cost.reduction_m"), 5, creep_m);
  EXPECT_EQ(world.figure("cost.bytes_per_metre"), 0);  // no one sent anything
  for (int i = 0; i < 9; ++i) world.estimate({30, 0, 0}, some_covariance());
  world.run_for(0.01);
  EXPECT_LT(world.figure("cost.reduction_m"), 0);
  EXPECT_TRUE(std::isnan(world.figure("cost.bytes_per_metre")));
}

}  // namespace
