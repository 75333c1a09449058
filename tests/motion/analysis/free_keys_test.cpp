// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/free_keys.hpp"

#include <gmock/gmock.h>

#include "motion/analysis/motion_check.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/project_paths.hpp"

namespace {

sim::VehicleConfig keyed_dog() {
  return sim::load_vehicle(test_support::source_path("vehicles/ers7.yaml"));
}

/// A loop of three keys, the last one as the first.
sim::JointMotion keyed_loop() {
  sim::JointMotion motion;
  motion.name = "sway";
  motion.vehicle = "ers7";
  motion.loop = true;
  motion.keys.resize(3);
  motion.poses = {{"stand", {{"lf_knee", 0.5}}}};
  motion.keys[0].pose = motion.keys[2].pose = "stand";
  motion.keys[1].at_s = 0.4;
  motion.keys[1].joints = {{"lf_knee", 0.9}, {"lf_swing", -0.2}};
  motion.keys[2].at_s = 1.2;
  return motion;
}

std::vector<double> start_of(const motion::FreeKeys& gait) {
  std::vector<double> values;
  for (const motion::GaitNumber& number : gait.numbers()) values.push_back(number.start);
  return values;
}

TEST(FreeKeys, TimesAndValuesAreTheNumbers) {
  const motion::FreeKeys gait(keyed_loop(), keyed_dog());
  std::vector<std::string> names;
  for (const motion::GaitNumber& number : gait.numbers()) names.push_back(number.name);
  // The last knee is that of the first key.
  EXPECT_EQ(names, (std::vector<std::string>{"key2.after_s", "key3.after_s", "key1.lf_knee", "key2.lf_knee",
                                             "key2.lf_swing"}));
  EXPECT_DOUBLE_EQ(gait.numbers()[1].start, 0.8);
  EXPECT_DOUBLE_EQ(gait.numbers()[3].low, 0.4);
  EXPECT_DOUBLE_EQ(gait.numbers()[3].high, 1.4);
}

TEST(FreeKeys, TheStartIsTheFile) {
  const motion::FreeKeys gait(keyed_loop(), keyed_dog());
  const auto found = gait.motion(start_of(gait)).tracks(), file = keyed_loop().tracks();
  ASSERT_EQ(found.size(), file.size());
  for (std::size_t i = 0; i < file.size(); ++i)
    for (double t_s = 0; t_s <= 1.2; t_s += 0.1) EXPECT_NEAR(found[i].value_at(t_s), file[i].value_at(t_s), 1e-9);
}

TEST(FreeKeys, TheSeamStaysClosedAndTheServosWithinTheirSpeeds) {
  const sim::VehicleConfig vehicle = keyed_dog();
  const motion::FreeKeys gait(keyed_loop(), vehicle);
  for (unsigned bits = 0; bits < 32; ++bits) {
    std::vector<double> values;
    for (std::size_t i = 0; i < 5; ++i)
      values.push_back((bits >> i & 1) != 0 ? gait.numbers()[i].high : gait.numbers()[i].low);
    const auto findings = motion::check_motion(gait.motion(values), vehicle);
    EXPECT_TRUE(findings.empty()) << bits << ": " << findings.front().text();
  }
}

TEST(FreeKeys, AMotionThatDoesNotLoopOrAnUnknownJointIsRefused) {
  const auto error_of = [](const sim::JointMotion& motion) -> std::string {
    try {
      motion::FreeKeys gait(motion, keyed_dog());
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  sim::JointMotion once = keyed_loop();
  once.loop = false;
  EXPECT_EQ(error_of(once), "motion 'sway': its keys cannot be searched: it must have 'loop: true'");
  sim::JointMotion other = keyed_loop();
  other.keys[1].joints.emplace_back("lf_wheel", 1);
  EXPECT_EQ(error_of(other), "motion 'sway' names joint 'lf_wheel', which is not a servo of vehicle 'ers7'");
  sim::JointMotion single = keyed_loop();
  single.keys.resize(1);
  EXPECT_EQ(error_of(single),
            "motion 'sway': its keys cannot be searched: it must have two keys or more, and no frames");
}

}  // namespace
