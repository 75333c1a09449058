// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "verification/bench/bench_run.hpp"

namespace {

using verification::BenchRun;

TEST(BenchScene, RoversOfTheCrowdPushAgainstEachOther) {
  BenchRun run(verification::crowd_scene(), 25);
  run.run_for(3);
  int contacts = 0;
  for (int i = 0; i < 100; ++i) {
    run.step();
    contacts += run.world().physics().last_step().contacts;
  }
  // Wheels and caster make three contacts of each rover with the ground; a push makes at least one more of two rovers.
  EXPECT_GT(contacts / 100.0 / 25, 3.5);
  EXPECT_GT(run.world().physics().quick_steps(), 0);
}

}  // namespace
