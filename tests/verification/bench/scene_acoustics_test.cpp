// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "verification/bench/bench_run.hpp"

namespace {

using verification::BenchRun;

TEST(BenchScene, EveryModemOfTheAcousticSceneReceivesEveryMessage) {
  BenchRun run(verification::acoustics_scene(), 10);
  const auto flights = [&] { return run.world().acoustics().flights(); };
  run.run_for(10);
  const std::int64_t begin = flights();
  run.run_for(10);  // each of ten sends once, and nine receive it
  EXPECT_EQ(flights() - begin, 90);
}

}  // namespace
