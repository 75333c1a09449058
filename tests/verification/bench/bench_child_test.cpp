// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/config/diagnostics.hpp"
#include "sim/world/world_state.hpp"
#include "verification/bench/bench_figures.hpp"
#include "verification/bench/bench_run.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using verification::BenchFigures;

const verification::BenchOptions briefly{0.5, 1, {}};

TEST(BenchFigures, AreTheSameWorkInAChildProcess) {
  const BenchFigures here = verification::measure_bench(verification::sea_scene(), 10, 1, briefly);
  const BenchFigures apart = verification::measure_bench_apart(verification::sea_scene(), 10, 1, briefly);
  EXPECT_EQ(apart.run_hash, here.run_hash);
  EXPECT_EQ(apart.messages_per_s, here.messages_per_s);
  EXPECT_EQ(apart.step_s, 0.02);
  EXPECT_GT(apart.cpu_ms_per_vehicle_s, 0);
  EXPECT_GT(apart.real_time_factor, 0);
}

TEST(BenchFigures, WrongSettingIsTheSameErrorFromAChildProcess) {
  const auto error_lines = [](const auto& measure) -> std::vector<std::string> {
    try {
      measure(verification::land_scene(), 10, 1, verification::BenchOptions{0.5, 1, {"physics.step_s=-1"}});
    } catch (const sim::ConfigError& error) {
      return error.lines();
    }
    return {};
  };
  const auto apart = error_lines(verification::measure_bench_apart);
  EXPECT_EQ(apart, error_lines(verification::measure_bench));
  EXPECT_THAT(apart, ElementsAre(HasSubstr("'step_s' must be")));
}

}  // namespace
