// SPDX-License-Identifier: BSD-3-Clause
// A motion that is exported and imported again moves the robot as before.

#include <gtest/gtest.h>

#include <string>

#include "motion/analysis/perturbed_world.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/motion/formats/format_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

sim::JointMotion shipped_motion(const std::string& name) {
  return sim::load_motion(test_support::source_path("vehicles/motions/ers7/" + name + ".yaml"));
}

sim::JointMotion read_again(const char* format, const sim::JointMotion& motion) {
  sim::JointMotion again = test::read(format, test::written(format, motion).bytes).motion;
  again.name = motion.name;  // a CSV file has none
  return again;
}

/// Where the dog is after a time of a repeated motion, and the state of its world.
struct EndOfMotion {
  sim::Vector3d torso_W;
  std::uint64_t state_hash;
};

EndOfMotion end_of(const sim::JointMotion& motion, double duration_s) {
  static const sim::WorldConfig studio =
      motion::world_for_walks(sim::load_world(test_support::source_path("worlds/ers7_studio.yaml")).config);
  sim::WorldConfig config = studio;
  motion::set_played_motion(config, "dog", motion);
  sim::InProcessBus bus;
  sim::World world(config, bus);
  while (sim::to_seconds(world.now()) < duration_s - 1e-9) world.step();
  return {world.vehicles().front()->X_WV().translation(), world.state().hash()};
}

class Reimport : public testing::TestWithParam<const char*> {};

TEST_P(Reimport, AsCsvEndsInTheSameState) {
  const sim::JointMotion motion = shipped_motion(GetParam());
  EXPECT_EQ(end_of(read_again("csv", motion), 6).state_hash, end_of(motion, 6).state_hash);
}

TEST_P(Reimport, AsAMotionFileEndsInTheSameState) {
  const sim::JointMotion motion = shipped_motion(GetParam());
  sim::Diagnostics diagnostics;
  sim::JointMotion again;
  const sim::ConfigNode node = sim::parse_config_text(sim::motion_text(motion), "again.yaml", diagnostics);
  sim::ParamReader reader(node, "", diagnostics);
  again.read(reader);
  reader.finish();
  diagnostics.throw_if_any();
  EXPECT_EQ(end_of(again, 6).state_hash, end_of(motion, 6).state_hash);
}

/// Webots' format has six decimals of a radian.  Where the robot tips from foot to foot a microradian becomes more:
/// 1.7 mm in `wave`, 5.6 mm in `steps`.
TEST(ReimportOfStableMotions, AsAWebotsMotionEndsWithinAMillimeterAfterHalfAMinute) {
  for (const std::string name : {"push_ups", "stretch"}) {
    const sim::JointMotion motion = shipped_motion(name);
    EXPECT_LE((end_of(read_again("webots", motion), 30).torso_W - end_of(motion, 30).torso_W).norm(), 0.001) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(, Reimport, testing::Values("push_ups", "steps", "wave"),
                         [](const testing::TestParamInfo<const char*>& of) { return std::string(of.param); });

}  // namespace
