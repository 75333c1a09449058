// SPDX-License-Identifier: BSD-3-Clause
#include "verification/motions/push_prediction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/analysis/motion_check.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/project_paths.hpp"

namespace {

using verification::PushTrial;

constexpr double quarter_turn = std::numbers::pi / 2;

motion::PushMargin margin_of(std::vector<double> withstood_mps) {
  motion::PushMargin margin;
  margin.withstood_mps = std::move(withstood_mps);
  return margin;
}

TEST(PushPrediction, BetweenTwoDirectionsTheBoundIsAStraightLine) {
  // Four directions of 1 m/s: a square.
  const motion::PushMargin square = margin_of({1, 1, 1, 1});
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(verification::margin_at(square, i * quarter_turn), 1, 1e-12);
  EXPECT_NEAR(verification::margin_at(square, quarter_turn / 2), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(verification::margin_at(square, -quarter_turn / 2), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(verification::margin_at(square, 4 * quarter_turn + quarter_turn / 2), std::sqrt(0.5), 1e-12);
  // x / 2 + y = 1 at x = y: 2/3 of each.
  EXPECT_NEAR(verification::margin_at(margin_of({2, 1, 1, 1}), quarter_turn / 2), std::hypot(2.0 / 3, 2.0 / 3), 1e-12);
  EXPECT_EQ(verification::margin_at(margin_of({2, 0, 1, 1}), quarter_turn / 2), 0);
}

PushTrial push_trial(double mps, double withstood_mps, double displacement_m, bool fell) {
  PushTrial trial;
  trial.push.mps = mps;
  trial.withstood_mps = withstood_mps;
  trial.static_displacement_m = displacement_m;
  trial.fell = fell;
  return trial;
}

TEST(PushPrediction, CountsWhatWasPredicted) {
  const std::vector<PushTrial> trials{push_trial(0.5, 0.4, 0.03, true), push_trial(0.5, 0.6, 0.02, true),
                                      push_trial(0.3, 0.2, 0.01, false), push_trial(0.1, 0.5, 0.01, false),
                                      push_trial(0.9, 0.5, 0.04, true)};
  const verification::Detection by_margin = verification::detection_by_margin(trials);
  EXPECT_EQ(by_margin.found, 2);
  EXPECT_EQ(by_margin.missed, 1);
  EXPECT_EQ(by_margin.false_alarms, 1);
  EXPECT_EQ(by_margin.right_passes, 1);
  EXPECT_DOUBLE_EQ(by_margin.recall(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(by_margin.precision(), 2.0 / 3);
  // A threshold between 0.01 and 0.02 m finds all three.
  const verification::Detection by_static_check = verification::detection_by_static_check(trials, false);
  EXPECT_EQ(by_static_check.recall(), 1);
  EXPECT_EQ(by_static_check.precision(), 1);
  // Of equal displacements both are above a threshold, or none.
  const verification::Detection tie =
      verification::detection_by_static_check({push_trial(0.1, 1, 0.02, true), push_trial(0.9, 1, 0.02, false)}, false);
  EXPECT_EQ(tie.found, 1);
  EXPECT_EQ(tie.false_alarms, 1);
}

class OfTheDog : public testing::Test {
 protected:
  const sim::VehicleConfig dog = sim::load_vehicle(test_support::source_path("vehicles/ers7.yaml"), {});
  const std::vector<sim::MotionPose> poses =
      sim::load_motion(test_support::source_path("vehicles/motions/ers7/stretch.yaml")).poses;
};

using PushPredictionOfMotions = OfTheDog;

/// A few of the motions of push_prediction_bench; docs/develop/performance.md has its command.
TEST_F(PushPredictionOfMotions, FindsMostFallsOfPushesThatItHasNotTried) {
  motion::StageOptions stage;
  stage.world = test_support::source_path("worlds/ers7_studio.yaml");
  verification::PredictionOptions options;
  options.motions = 3;
  options.pushes = 12;
  options.seed = 7;
  options.push.directions = 6;
  options.push.watch_s = 1;
  options.push.greatest_mps = 4;
  options.push.resolution_mps = 1.0 / 8;
  const verification::PushTrials result = verification::push_trials(stage, dog, poses, options);
  ASSERT_EQ(result.trials.size(), 36u);
  const verification::Detection detection = verification::detection_by_margin(result.trials);
  EXPECT_GE(detection.found + detection.missed, 9);  // a quarter falls
  EXPECT_GE(detection.false_alarms + detection.right_passes, 9);
  // Six directions and 1/8 m/s are coarse, and 36 pushes few: 13 falls are found, with 3 false alarms.
  EXPECT_GE(detection.recall(), 0.75);
  EXPECT_GE(detection.precision(), 0.75);
}

using RandomMotion = OfTheDog;

TEST_F(RandomMotion, StartsInAPoseAndKeepsRangesAndSpeeds) {
  sim::Random random(1, "test");
  for (int draw = 0; draw < 50; ++draw) {
    random.begin_step(draw);
    const sim::JointMotion motion = verification::random_motion(poses, dog, {}, random);
    ASSERT_EQ(motion.keys.size(), 5u);
    // Limits of two joints are not kept.  Keys are not at whole frames: speeds may differ by a thousandth.
    for (const motion::MotionFinding& finding : motion::check_motion(motion, dog))
      EXPECT_TRUE(finding.rule == motion::MotionRule::two_joint_low ||
                  finding.rule == motion::MotionRule::two_joint_high ||
                  (finding.rule == motion::MotionRule::velocity && std::abs(finding.value) < 1.001 * finding.limit))
          << finding.text();
    const bool starts_in_a_pose = std::any_of(poses.begin(), poses.end(), [&](const sim::MotionPose& pose) {
      const auto tracks = motion.tracks();
      return std::all_of(pose.joints.begin(), pose.joints.end(), [&](const auto& joint) {
        return std::any_of(tracks.begin(), tracks.end(), [&](const sim::MotionTrack& track) {
          return track.joint == joint.first && std::abs(track.value_at(0) - joint.second) < 1e-9;
        });
      });
    });
    EXPECT_TRUE(starts_in_a_pose) << draw;
  }
}

}  // namespace
