// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/stage_times.hpp"

#include <gtest/gtest.h>

namespace {

TEST(StageTimes, WorkIsAddedToTheStageThatEnds) {
  sim::StageTimes times;
  {
    sim::StageClock clock(&times);
    clock.end(sim::StepStage::messages);
    const double until_s = sim::StageClock::now_s() + 2e-3;
    while (sim::StageClock::now_s() < until_s) {
    }
    clock.end(sim::StepStage::physics);
    clock.count_rays(7);
  }
  const auto of = [&](sim::StepStage stage) { return times.cpu_s[static_cast<std::size_t>(stage)]; };
  // Less what reading the clock takes.
  EXPECT_GT(of(sim::StepStage::physics), 2e-3 - 10 * times.clock_s - 1e-4);
  EXPECT_LT(of(sim::StepStage::messages), of(sim::StepStage::physics));
  EXPECT_EQ(of(sim::StepStage::hash), 0);
  EXPECT_EQ(times.steps, 1);
  EXPECT_EQ(times.rays, 7);
  EXPECT_GT(times.clock_s, 0);
}

TEST(StageTimes, WithoutThemTheClockDoesNothing) {
  sim::StageClock clock(nullptr);
  clock.end(sim::StepStage::hash);
  clock.count_rays(1);
}

TEST(StageTimes, EachStageHasAName) {
  EXPECT_STREQ(sim::step_stage_names[static_cast<std::size_t>(sim::StepStage::messages)], "messages");
  EXPECT_STREQ(sim::step_stage_names[static_cast<std::size_t>(sim::StepStage::rays)], "rays");
  EXPECT_STREQ(sim::step_stage_names[static_cast<std::size_t>(sim::StepStage::hash)], "hash");
}

}  // namespace
