// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/mechanism_config.hpp"

#include <gmock/gmock.h>

namespace {

sim::BodyConfig body(const std::string& name, std::size_t parts = 1) {
  sim::BodyConfig made;
  made.name = name;
  made.parts.resize(parts);
  return made;
}

sim::JointConfig joint(const std::string& one, const std::string& other) {
  sim::JointConfig made;
  made.bodies = {one, other};
  return made;
}

std::vector<std::string> apart_in(const sim::MechanismConfig& mechanism) {
  std::vector<std::string> names;
  for (const sim::BodyConfig* each : mechanism.unconnected()) names.push_back(each->name);
  return names;
}

TEST(MechanismConfig, BodiesAreConnectedByChainsOfJoints) {
  sim::MechanismConfig mechanism;
  mechanism.bodies = {body("base"), body("arm"), body("hand"), body("box")};
  mechanism.joints = {joint("arm", "base"), joint("arm", "hand")};
  EXPECT_THAT(apart_in(mechanism), testing::ElementsAre("box"));
  mechanism.joints.push_back(joint("box", "world"));
  EXPECT_THAT(apart_in(mechanism), testing::ElementsAre("box"));
  mechanism.joints.push_back(joint("base", "world"));  // both are in the world
  EXPECT_THAT(apart_in(mechanism), testing::IsEmpty());
}

TEST(MechanismConfig, IsAnchoredByAJointToTheWorld) {
  sim::MechanismConfig mechanism;
  mechanism.bodies = {body("base"), body("arm")};
  mechanism.joints = {joint("base", "arm")};
  EXPECT_FALSE(mechanism.anchored());
  mechanism.joints.push_back(joint("arm", "world"));
  EXPECT_TRUE(mechanism.anchored());
}

TEST(MechanismConfig, CountsThePartsOfAllBodies) {
  sim::MechanismConfig mechanism;
  EXPECT_EQ(mechanism.part_count(), 0u);
  mechanism.bodies = {body("base", 2), body("arm", 3)};
  EXPECT_EQ(mechanism.part_count(), 5u);
}

}  // namespace
