// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "sim/acoustics/channel.hpp"
#include "sim/world/world_state.hpp"
#include "verification/bench/bench_run.hpp"

namespace {

using verification::BenchRun;

/// A test for each scene; named after it.
class BenchScenes : public testing::TestWithParam<verification::BenchScene> {};

INSTANTIATE_TEST_SUITE_P(All, BenchScenes, testing::ValuesIn(verification::bench_scenes()),
                         [](const auto& scene) { return scene.param.name; });

constexpr int some = 20;  // vehicles; two of each kind of the scene `mixed` at least

std::uint64_t hash_after_2_s(const verification::BenchScene& scene, int threads) {
  BenchRun run(scene, some, {}, threads);
  run.run_for(2);
  return run.world().state().run_hash();
}

TEST_P(BenchScenes, HasAsManyVehiclesAsRequested) {
  for (const int vehicles : {1, 2, some, 101})
    EXPECT_EQ(BenchRun(GetParam(), vehicles).world().vehicles().size(), static_cast<std::size_t>(vehicles));
}

TEST_P(BenchScenes, HasTheSameHashWithAnyNumberOfThreads) {
  const std::uint64_t one = hash_after_2_s(GetParam(), 1);
  EXPECT_EQ(hash_after_2_s(GetParam(), 2), one);
  EXPECT_EQ(hash_after_2_s(GetParam(), 3), one);
}

TEST_P(BenchScenes, MovesEveryVehicle) {
  BenchRun run(GetParam(), some);
  std::vector<sim::Vector3d> begin;
  for (const auto& vehicle : run.world().vehicles()) begin.push_back(vehicle->X_WV().translation());
  std::set<std::string> at_rest;
  run.run_for(6);  // wanderers may have to turn first
  for (std::size_t i = 0; i < begin.size(); ++i)
    if ((run.world().vehicles()[i]->X_WV().translation() - begin[i]).norm() < 0.02)
      at_rest.insert(run.world().vehicles()[i]->name());
  EXPECT_THAT(at_rest, testing::SizeIs(testing::Le(some / 10)));
}

TEST(BenchScene, NamesAreDifferentAndFound) {
  std::set<std::string> names;
  for (const verification::BenchScene& scene : verification::bench_scenes()) {
    EXPECT_TRUE(names.insert(scene.name).second) << scene.name;
    EXPECT_EQ(verification::find_bench_scene(scene.name), &scene);
  }
  EXPECT_EQ(verification::find_bench_scene("moon"), nullptr);
}

}  // namespace
