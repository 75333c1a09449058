// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "experiment/study/study_config.hpp"
#include "sim/config/config_node.hpp"
#include "tests/project_paths.hpp"

namespace {

/// Hashes of a version of the benchmark, by case: lines `HASH CASE`, and comments.
std::map<std::string, std::string> frozen(const std::string& path) {
  std::map<std::string, std::string> hashes;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::string hash, name;
    if (line.starts_with('#') || !(std::istringstream(line) >> hash >> name)) continue;
    hashes[name] = hash;
  }
  return hashes;
}

TEST(FrozenBenchmark, WorldsAreThoseOfItsVersion) {
  const experiment::LoadedStudy study =
      experiment::load_study(test_support::source_path("worlds/studies/benchmark.yaml"));
  std::map<std::string, std::string> left = frozen(test_support::source_path("worlds/benchmark/v1.txt"));
  ASSERT_FALSE(left.empty());
  for (std::size_t i = 0; i < study.config.cases.size(); ++i) {
    const std::string& name = study.config.cases[i].name;
    EXPECT_EQ(study.world_hashes[i], left[name])
        << "case '" << name << "' of the benchmark, " << study.config.cases[i].world
        << ": changed since worlds/benchmark/v1.txt; a change needs a new version, docs/guides/benchmark.md";
    left.erase(name);
  }
  for (const auto& [name, hash] : left) ADD_FAILURE() << "case '" << name << "' of v1.txt is not in the benchmark";
}

TEST(FrozenBenchmark, HashesHaveNoPathOfAMachine) {
  const experiment::LoadedStudy study =
      experiment::load_study(test_support::source_path("worlds/studies/benchmark.yaml"));
  for (std::size_t i = 0; i < study.worlds.size(); ++i)
    EXPECT_EQ(sim::to_yaml(study.worlds[i].resolved).find(test_support::source_path("")), std::string::npos)
        << study.config.cases[i].name;
}

}  // namespace
