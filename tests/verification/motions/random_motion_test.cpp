// SPDX-License-Identifier: BSD-3-Clause
#include "verification/motions/random_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motion/analysis/motion_check.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/project_paths.hpp"
#include "verification/motions/push_prediction.hpp"

namespace {

class OfTheDog : public testing::Test {
 protected:
  const sim::VehicleConfig dog = sim::load_vehicle(test_support::source_path("vehicles/ers7.yaml"), {});
  const std::vector<sim::MotionPose> poses =
      sim::load_motion(test_support::source_path("vehicles/motions/ers7/stretch.yaml")).poses;
};

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
