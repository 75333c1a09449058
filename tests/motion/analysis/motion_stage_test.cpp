// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_stage.hpp"

#include <gmock/gmock.h>
#include <spdlog/fmt/fmt.h>

#include <fstream>
#include <random>

#include "motion/analysis/motion_tracking.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::HasSubstr;

struct Theatre {
  test_support::ScratchFolder folder;
  motion::StageOptions options;

  Theatre() {
    options.world = folder.file("world.yaml");
    std::ofstream(options.world) << test::leg_world(
        "        - {name: imu, type: imu, body: shin, gyro_noise: {gaussian_std: 0.01}}\n        - {name: "
        "group, type: joint_group}\n        - {name: player, type: motion_player, group: group}\n");
  }
};

sim::JointMotion swing(double height, double end_s = 3) {
  sim::JointMotion motion;
  motion.name = "swing";
  motion.ease = sim::Easing::smooth;
  motion.keys = {{0, "", {{"hip", 0.2}, {"knee", 0}}, {}, "", {}},
                 {1, "", {{"hip", height}}, {}, "", {}},
                 {end_s, "", {{"hip", 0}, {"knee", 0.5}}, {}, "", {}}};
  return motion;
}

TEST(MotionStage, FromAnyInstantTheEndIsThatOfTheFullPlay) {
  const Theatre theatre;
  motion::MotionStage stage(theatre.options, swing(1));
  stage.play_out(0.5, 60);
  const double end_s = stage.now_s();
  const std::uint64_t hash = stage.state_hash();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0, end_s);
  for (int i = 0; i < 100; ++i) {
    const double from_s = any(random);
    stage.go_to(from_s);
    stage.go_to(end_s);
    ASSERT_EQ(stage.state_hash(), hash) << "from " << from_s;
  }
  EXPECT_TRUE(stage.branches().empty());
}

TEST(MotionStage, SaysWhetherTheMotionHasEnded) {
  const Theatre theatre;
  const sim::JointMotion motion = swing(1);
  motion::MotionStage stage(theatre.options, motion);
  EXPECT_FALSE(stage.play_out(0, 2));
  EXPECT_NEAR(stage.now_s(), 2, 1e-9);
  EXPECT_TRUE(stage.play_out(0, motion::end_limit_s(motion)));
  EXPECT_GT(motion::end_limit_s(motion), stage.now_s());
}

TEST(MotionStage, KnowsWhenATimeOfTheMotionIsReached) {
  const Theatre theatre;
  motion::MotionStage stage(theatre.options, swing(1));
  stage.go_to(1.5);
  const double at_s = stage.time_of(0.8);
  stage.go_to(at_s);
  EXPECT_NEAR(stage.player().at_s(), 0.8, 1e-9);
  stage.play_out(0.5, 60);
  EXPECT_NEAR(stage.time_of(0.8), at_s, 1e-9);  // also when it has ended
}

TEST(MotionStage, AChangeActsFromItsInstantOnAndTheOldFutureIsABranch) {
  const Theatre theatre;
  motion::MotionStage stage(theatre.options, swing(1));
  stage.play_out(0.5, 60);
  const double end_s = stage.now_s();
  const std::uint64_t first = stage.state_hash();
  stage.go_to(1);
  const std::uint64_t before = stage.state_hash();
  stage.go_to(2);
  stage.change_motion(swing(0.5));
  stage.go_to(end_s);
  const std::uint64_t second = stage.state_hash();
  EXPECT_NE(second, first);
  ASSERT_EQ(stage.branches().size(), 1u);
  EXPECT_NEAR(stage.branches()[0].changed_at_s, 2, 1e-9);
  EXPECT_EQ(stage.branches()[0].state_hash, first);
  // Before the change all is as it was, and after it the new course is repeated.
  stage.go_to(1);
  EXPECT_EQ(stage.state_hash(), before);
  stage.go_to(end_s);
  EXPECT_EQ(stage.state_hash(), second);
}

TEST(MotionStage, AnActionOfTheWorldIsPartOfTheBranch) {
  const Theatre theatre;
  motion::MotionStage stage(theatre.options, swing(1));
  stage.go_to(2);
  sim::Diagnostics diagnostics;
  stage.run_action(
      sim::parse_config_text("{set: {device: dog/hip, values: {max_effort: 0.01}}}", "action", diagnostics));
  stage.go_to(4);
  const std::uint64_t hash = stage.state_hash();
  stage.go_to(1.5);
  stage.go_to(4);
  EXPECT_EQ(stage.state_hash(), hash);
}

TEST(MotionStage, CarriesOutTheChangesOfAMotionAtTheirTimes) {
  const Theatre theatre;
  sim::JointMotion motion = swing(1);
  sim::Diagnostics diagnostics;
  motion.changes.push_back(
      {1.5, sim::parse_config_text("{set: {device: dog/hip, values: {max_effort: 0.01}}}", "action", diagnostics)});
  motion::MotionStage plain(theatre.options, swing(1)), changed(theatre.options, motion);
  plain.play_out(0.5, 60);
  changed.play_out(0.5, 60);
  const double end_s = changed.now_s();
  const std::uint64_t hash = changed.state_hash();
  EXPECT_NE(hash, plain.state_hash());
  // Up to its time both are equal, and from any instant the change is repeated.
  const double at_s = changed.time_of(1.5);
  for (const double before_s : {0.5, 0.002}) {
    plain.go_to(at_s - before_s);
    changed.go_to(at_s - before_s);
    EXPECT_EQ(changed.state_hash(), plain.state_hash()) << before_s;
    changed.go_to(end_s);
    EXPECT_EQ(changed.state_hash(), hash);
  }
}

TEST(MotionStage, AnActionThatCannotBeCarriedOutLeavesTheWorldAsItWas) {
  const Theatre theatre;
  motion::MotionStage stage(theatre.options, swing(1)), plain(theatre.options, swing(1));
  stage.go_to(2);
  plain.go_to(2);
  sim::Diagnostics diagnostics;
  const auto run = [&](const std::string& text) {
    stage.run_action(sim::parse_config_text(text, "action", diagnostics));
  };
  EXPECT_THROW(run("{remove: dog}"), sim::ConfigError);
  EXPECT_THROW(run("[{set: {device: dog/hip, values: {max_effort: 0.01}}}, {remove: dog}]"), sim::ConfigError);
  EXPECT_EQ(stage.state_hash(), plain.state_hash());
  stage.go_to(4);
  plain.go_to(4);
  EXPECT_EQ(stage.state_hash(), plain.state_hash());
  // From before, too: nothing is carried out again.
  stage.go_to(1);
  stage.go_to(4);
  EXPECT_EQ(stage.state_hash(), plain.state_hash());
}

TEST(MotionStage, AChangeInTheLastStepIsThereAgain) {
  const Theatre theatre;
  motion::MotionStage stage(theatre.options, swing(1));
  stage.go_to(2);
  sim::Diagnostics diagnostics;
  stage.run_action(sim::parse_config_text("{gravity_mps2: 5}", "action", diagnostics));
  const std::uint64_t hash = stage.state_hash();
  stage.go_to(1.9);
  stage.go_to(2);
  EXPECT_EQ(stage.world().physics().gravity_mps2(), 5);
  EXPECT_EQ(stage.state_hash(), hash);
}

TEST(MotionStage, PlaysAPartAgainAndAgain) {
  Theatre theatre;
  theatre.options.play.from_s = 0.5;
  theatre.options.play.to_s = 1.5;
  theatre.options.play.repeat = -1;
  motion::MotionStage stage(theatre.options, swing(1));
  stage.go_to(0.1);  // the approach is planned
  const double start_s = stage.time_of(0.5);
  stage.go_to(start_s + 2.25);
  EXPECT_NEAR(stage.player().at_s(), 0.75, 1e-9);
  theatre.options.play.to_s = 4;
  EXPECT_THROW(motion::MotionStage(theatre.options, swing(1)), std::runtime_error);
}

TEST(MotionStage, MarginsAndScoresGoBackWithIt) {
  motion::StageOptions options;
  options.world = test_support::source_path("worlds/ers7_studio.yaml");
  options.scores = true;
  sim::JointMotion bow;
  bow.name = "bow";
  bow.keys = {{0, "", {{"lf_swing", 0}, {"rf_swing", 0}}, {}, "", {}},
              {1, "", {{"lf_swing", -0.5}, {"rf_swing", -0.5}}, {}, "", {}}};
  motion::MotionStage stage(options, bow);
  const auto figures = [&] {
    std::string text;
    for (const auto& [name, value] : stage.scoring()->figures()) text += fmt::format("{} {}\n", name, value);
    return text;
  };
  EXPECT_FALSE(stage.support());
  stage.go_to(0.5);
  const std::string half = figures();
  const double margin_m = stage.support().value().static_margin_m;
  EXPECT_GT(margin_m, 0);
  // The metric of the world has the same.
  EXPECT_THAT(half, HasSubstr(fmt::format("support.static_m {}\n", margin_m)));
  stage.go_to(1.2);
  EXPECT_NE(figures(), half);
  stage.go_to(0.3);
  EXPECT_FALSE(stage.support());  // its contacts are known from the next step on
  stage.go_to(0.5);
  EXPECT_EQ(figures(), half);
  EXPECT_EQ(stage.support().value().static_margin_m, margin_m);
}

TEST(MotionStage, TracksSetPointsAndTilt) {
  const Theatre theatre;
  motion::MotionStage stage(theatre.options, swing(0.5));
  motion::MotionTracking tracking;
  stage.after_step = [&](motion::MotionStage& now) { tracking.add(now); };
  stage.play_out(0.5, 60);
  EXPECT_LT(tracking.greatest_error_rad(), 0.02);
  EXPECT_NEAR(tracking.greatest_tilt_rad(), 0.5, 0.02);  // the thigh is the first body
  EXPECT_FALSE(tracking.has_fallen());
}

TEST(MotionStage, SaysWhichWorldHasNoPlayer) {
  const Theatre theatre;
  std::ofstream(theatre.options.world) << test::leg_world("");
  try {
    motion::MotionStage stage(theatre.options, swing(1));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("has a motion_player"));
  }
}

TEST(MotionStage, RefusesAJointThatTheVehicleDoesNotHave) {
  const Theatre theatre;
  sim::JointMotion motion = swing(1);
  motion.keys[0].joints.emplace_back("tail", 1);
  try {
    motion::MotionStage stage(theatre.options, motion);
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("names joint 'tail', which is not a servo of the group"));
  }
}

}  // namespace
