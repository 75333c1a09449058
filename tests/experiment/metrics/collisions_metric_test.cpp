// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "tests/experiment/score/metric_worlds.hpp"

namespace {

using namespace metric_worlds;

TEST(Collisions, CountContactsThatBeginButNotWithTheGround) {
  MetricWorld world(
      "  - {name: all, type: collisions}\n"
      "  - {name: crate, type: collisions, vehicle: r1, with: crate}\n"
      "  - {name: ground, type: collisions, vehicle: r1, with: ground}\n"
      "  - {name: late, type: collisions, vehicle: r1, from_s: 1000}\n");
  world.run_for(1);
  EXPECT_EQ(world.figure("all.count"), 0);
  EXPECT_TRUE(std::isnan(world.figure("all.first_s")));
  EXPECT_EQ(world.figure("ground.count"), 1);  // named, planes count as well
  world.drive(1);
  world.run_for(5);  // 2.8 m to the crate
  EXPECT_EQ(world.figure("all.count"), 1);
  EXPECT_EQ(world.figure("crate.count"), 1);
  EXPECT_GT(world.figure("crate.first_s"), 1 + 2.8 / 1.0);
  world.drive(-1);
  world.run_for(2);
  world.drive(1);
  world.run_for(5);
  EXPECT_EQ(world.figure("crate.count"), 2);
  EXPECT_TRUE(std::isnan(world.figure("late.count"))) << "nothing was counted before from_s";
}

TEST(Collisions, DoNotChangeTheRun) {
  MetricWorld with("  - {name: all, type: collisions}\n");
  MetricWorld without("  - {name: distance, type: distance, vehicle: r1}\n");
  for (MetricWorld* world : {&with, &without}) {
    world->drive(1);
    world->run_for(4);
  }
  EXPECT_EQ(with.figure("all.count"), 1);
  EXPECT_EQ(with.test.world.state().run_hash(), without.test.world.state().run_hash());
}

}  // namespace
