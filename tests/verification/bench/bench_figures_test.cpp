// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/bench_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "sim/config/diagnostics.hpp"
#include "sim/world/world_state.hpp"
#include "verification/bench/bench_run.hpp"

namespace {

using testing::HasSubstr;
using testing::StartsWith;
using verification::BenchFigures;

const verification::BenchOptions briefly{0.5, 1, {}};

TEST(BenchFigures, HaveTheHashOfTheRunWithoutMeasurement) {
  verification::BenchRun run(verification::land_scene(), 10);
  run.run_for(1.5);
  EXPECT_EQ(verification::measure_bench(verification::land_scene(), 10, 1, briefly).run_hash,
            run.world().state().run_hash());
}

TEST(BenchFigures, CountRaysAndMessages) {
  const BenchFigures land = verification::measure_bench(verification::land_scene(), 10, 1, briefly);
  EXPECT_NEAR(land.rays_per_s, 1800, 1);    // 180 rays at 10 Hz
  EXPECT_NEAR(land.messages_per_s, 30, 1);  // scan, odometry and command, 10 Hz each
  EXPECT_GE(land.contacts, 2.5);            // wheels and caster, which a bump may lift
  EXPECT_EQ(land.hearers_per_s, 0);
}

TEST(BenchFigures, PartsAddUpToTheTimeOfAStep) {
  // Of different seconds of the run, in which other programs may use the caches: then they are measured again.
  double parts = 0;
  for (int i = 0; i < 10 && !(parts > 0.5 && parts < 2); ++i) {
    const BenchFigures land = verification::measure_bench(verification::land_scene(), 100, 1, {0.5, 4, {}});
    parts = std::accumulate(land.part_ms.begin(), land.part_ms.end(), 0.0) / land.cpu_ms_per_vehicle_s;
  }
  EXPECT_GT(parts, 0.5);
  EXPECT_LT(parts, 2);
}

TEST(BenchFigures, NameTheLargestPartsFirst) {
  BenchFigures figures;
  figures.part_ms[static_cast<std::size_t>(sim::StepStage::physics)] = 6;
  figures.part_ms[static_cast<std::size_t>(sim::StepStage::rays)] = 3;
  figures.part_ms.back() = 1;
  EXPECT_EQ(verification::largest_parts(figures), "physics 60 %, rays 30 %, programs 10 %");
}

TEST(BenchFigures, FillEachColumnOfTheCsv) {
  const auto columns = [](const std::string& line) { return std::count(line.begin(), line.end(), ',') + 1; };
  BenchFigures figures;
  figures.vehicles = 10;
  figures.run_hash = 0xabc;
  const std::string line = verification::bench_csv_line(verification::land_scene(), figures);
  EXPECT_EQ(columns(line), columns(verification::bench_csv_head()));
  EXPECT_THAT(verification::bench_csv_head(), StartsWith("scene,vehicles,threads,step_s,load_s,cpu_ms_per_vehicle_s,"));
  EXPECT_THAT(line, StartsWith("land,10,1,"));
  EXPECT_THAT(line, HasSubstr(",0000000000000abc,"));
}

}  // namespace
