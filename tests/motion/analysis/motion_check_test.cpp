// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_check.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/devices/joint/leg_fixture.hpp"

namespace {

using motion::MotionRule;

/// The leg with a range of +-1 rad of its knee, 2 rad/s, 20 rad/s^2, and at least -0.2 rad with the hip from 0.5 on.
const sim::VehicleConfig& leg() {
  static const test::TestWorld world(
      test::leg_world("        - {name: group, type: joint_group, limits: [{joint: knee, by: hip, from_deg: 28.64789, "
                      "low_deg: -11.459156}]}\n",
                      ", low: -1, high: 1, max_acceleration: 20"));
  return *world.loaded.config.vehicles.front().config;
}

sim::JointMotion motion(const std::vector<std::pair<double, sim::JointValues>>& keys) {
  sim::JointMotion made;
  made.name = "m";
  made.ease = sim::Easing::smooth;
  for (const auto& [at_s, values] : keys) made.keys.push_back({at_s, "", values, {}, "", {}});
  return made;
}

std::vector<MotionRule> rules_of(const sim::JointMotion& motion) {
  std::vector<MotionRule> rules;
  for (const motion::MotionFinding& finding : motion::check_motion(motion, leg())) rules.push_back(finding.rule);
  return rules;
}

TEST(MotionCheck, FindsNothingInAGoodMotion) {
  EXPECT_THAT(rules_of(motion({{0, {{"hip", 0}, {"maker/knee", 0}}}, {2, {{"hip", 1}, {"maker/knee", 1}}}})),
              testing::IsEmpty());
}

TEST(MotionCheck, FindsEachRuleBrokenOnce) {
  EXPECT_THAT(rules_of(motion({{0, {{"tail", 0}, {"hip", 0}}}})), testing::ElementsAre(MotionRule::unknown_joint));
  EXPECT_THAT(rules_of(motion({{0, {{"knee", 0}}}, {2, {{"knee", 1.1}}}, {4, {{"knee", 0}}}})),
              testing::ElementsAre(MotionRule::high));
  EXPECT_THAT(rules_of(motion({{0, {{"knee", 0}}}, {2, {{"knee", -1.1}}}, {4, {{"knee", 0}}}})),
              testing::ElementsAre(MotionRule::low));
  EXPECT_THAT(rules_of(motion({{0, {{"hip", 0}, {"knee", 0}}}, {2, {{"hip", 0.8}, {"knee", -0.4}}}})),
              testing::ElementsAre(MotionRule::two_joint_low));
  // 1 rad in 0.32 s: at most 1.5 / 0.32 = 4.7 rad/s, and 6 / 0.32^2 = 59 rad/s^2 at both ends.
  EXPECT_THAT(rules_of(motion({{0, {{"hip", 0}}}, {0.32, {{"hip", 1}}}})),
              testing::UnorderedElementsAre(MotionRule::acceleration, MotionRule::acceleration));
  sim::JointMotion loop = motion({{0, {{"hip", 0}}}, {2, {{"hip", 0.5}}}});
  loop.loop = true;
  EXPECT_THAT(rules_of(loop), testing::ElementsAre(MotionRule::loop_seam));
}

TEST(MotionCheck, LightsAndSoundsMustBeThoseOfTheVehicle) {
  const test::TestWorld world(
      test::leg_world("        - {name: led, type: led, lights: [{name: lamp}]}\n        - {name: speaker, type: "
                      "speaker, sounds: [{name: bark}]}\n        - {name: group, type: joint_group}\n"));
  const sim::VehicleConfig& vehicle = *world.loaded.config.vehicles.front().config;
  sim::JointMotion lit = motion({{0, {{"hip", 0}, {"lamp", 0}, {"lmap", 1}}}, {1, {{"lamp", 1.5}}}});
  lit.ease = sim::Easing::linear;
  lit.lights = {"lamp", "lmap"};
  lit.sounds = {{0.5, "bark", 1}, {0.5, "brak", 1}, {2, "bark", 1}};
  std::vector<std::string> texts;
  for (const motion::MotionFinding& finding : motion::check_motion(lit, vehicle)) texts.push_back(finding.text());
  EXPECT_THAT(texts, testing::UnorderedElementsAre(
                         "light 'lmap': no led of the vehicle has a light of this name",
                         "light 'lamp' at 1.000 s: 1.5 is not within 0 to 1",
                         "sound 'brak' at 0.500 s: no speaker of the vehicle has a sound of this name",
                         "sound 'bark' at 2.000 s is never played: the motion ends at 1.000 s"));
  const sim::JointMotion fixed = motion::mended(lit, vehicle);
  for (const sim::MotionTrack& track : fixed.tracks()) EXPECT_LE(track.value_at(1), 1) << track.joint;
}

TEST(MotionCheck, ReportsTheWorstFrameAndItsKey) {
  const auto findings = motion::check_motion(
      motion({{0, {{"knee", 0}}}, {1, {{"knee", 1.2}}}, {2, {{"knee", 1.5}}}, {4, {{"knee", 0}}}}), leg());
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NEAR(findings[0].at_s, 2, 1e-9);
  EXPECT_EQ(findings[0].key, 3);
  EXPECT_NEAR(findings[0].value, 1.5, 1e-12);
  EXPECT_EQ(findings[0].limit, 1);
  EXPECT_EQ(findings[0].text(), "joint 'knee' after key 3 at 2.000 s: 85.94 deg is above its upper limit, 57.30 deg");
}

TEST(MotionCheck, MendsRangesAndVelocities) {
  sim::JointMotion fast = motion({{0, {{"hip", 0}, {"knee", 0}}}, {0.01, {{"hip", 1}, {"knee", 3}}}});
  fast.ease = sim::Easing::linear;
  const sim::JointMotion mended = motion::mended(fast, leg());
  for (const motion::MotionFinding& finding : motion::check_motion(mended, leg()))
    EXPECT_EQ(finding.rule, MotionRule::acceleration) << finding.text();
  EXPECT_GE(mended.end_s(), 1 / 50.0);  // 1 rad at 50 rad/s
  EXPECT_LE(mended.end_s(), 1 / 50.0 + 0.008);
}

}  // namespace
