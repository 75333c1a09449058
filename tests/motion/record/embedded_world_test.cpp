// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/embedded_world.hpp"

#include <gmock/gmock.h>

#include "sim/config/config_node.hpp"
#include "tests/project_paths.hpp"

namespace {

using testing::HasSubstr;
using testing::Not;

sim::ConfigNode parsed(const std::string& text) {
  sim::Diagnostics diagnostics;
  sim::ConfigNode node = sim::parse_config_text(text, "world.yaml", diagnostics);
  diagnostics.throw_if_any();
  return node;
}

/// The error of playing a take with this world in it; empty: none.
std::string error_of(const std::string& world) {
  sim::JointMotion take;
  take.recorded.emplace().embedded_world = parsed(world);
  motion::StageOptions stage;
  try {
    EXPECT_TRUE(motion::use_embedded_world(stage, take, "take.yaml"));
    return "";
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
}

TEST(EmbeddedWorld, HoldsTheMotionsOfItsPlayersAndNoFiles) {
  const sim::LoadedWorld loaded = sim::load_world(test_support::source_path("worlds/ers7_seed_studio.yaml"));
  EXPECT_THAT(sim::to_yaml(loaded.resolved), HasSubstr("file: "));
  const std::string world = sim::to_yaml(motion::embeddable_world(loaded.resolved, "ers7_seed_studio"));
  EXPECT_THAT(world, Not(HasSubstr("file: ")));
  EXPECT_THAT(world, HasSubstr("motion: push_ups"));
  EXPECT_EQ(error_of(world), "");
  // It is a whole world file.
  EXPECT_EQ(sim::load_world_text(world, "take.yaml").config.vehicles.front().name, "dog");
}

TEST(EmbeddedWorld, OfAStrangerCannotNameFilesOrPrograms) {
  EXPECT_EQ(error_of("shoal: 1"), "");
  EXPECT_EQ(error_of("[1, 2]"), "take.yaml: 'embedded_world' must be a map, the keys of a world file");
  const std::string rule = ": a world in a take has no other files and no programs";
  for (const char* key : {"include: /etc/passwd", "plugins: [evil]", "processes: [{name: p, command: [ls]}]"})
    EXPECT_EQ(error_of(std::string("shoal: 1\n") + key), "take.yaml: 'embedded_world' has the key '" +
                                                             std::string(key).substr(0, std::string(key).find(':')) +
                                                             "'" + rule);
  EXPECT_EQ(error_of("shoal: 1\nvehicles: [{name: a, file: /etc/passwd}]"),
            "take.yaml: 'embedded_world' names the file '/etc/passwd'" + rule);
  EXPECT_EQ(error_of("shoal: 1\nobjects: [{name: a, parts: [{shape: mesh, mesh: ../../a.stl}]}]"),
            "take.yaml: 'embedded_world' names the file '../../a.stl'" + rule);
  EXPECT_EQ(error_of("shoal: 1\ndescription: " + std::string(motion::max_embedded_bytes, 'x')),
            "take.yaml: 'embedded_world' must have at most 1000000 bytes, got 1000023");
}

TEST(EmbeddedWorld, IsRefusedBeforeARecordingWhenItNamesFiles) {
  try {
    motion::embeddable_world(parsed("shoal: 1\nobjects: [{name: a, parts: [{shape: mesh, mesh: /tmp/a.stl}]}]"),
                             "rocks");
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--embed: world 'rocks' names the file '/tmp/a.stl'"));
  }
}

TEST(EmbeddedWorld, IsUsedOnlyWhereATakeHoldsOne) {
  motion::StageOptions stage;
  EXPECT_FALSE(motion::use_embedded_world(stage, {}, "take.yaml"));
  EXPECT_EQ(stage.tree, nullptr);
}

}  // namespace
