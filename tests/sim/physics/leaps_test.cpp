// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/leaps.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/sim/physics/step_objects.hpp"

namespace {

using namespace small_worlds;

/// A bar of 2 m along x, 0.1 m thick: it is looked at from 10 m/s on, at steps of 10 ms.
sim::SteppedBody& add_bar(StepObjects& objects, const Vector3d& v_W) {
  sim::SteppedBody& bar = objects.add(body("bar", {box({2, 0.1, 0.1}, 1)}), Pose::Identity());
  objects.leaps.plan(objects.groups[bar.group()]);
  bar.set_velocity_W(v_W, Vector3d::Zero());
  return bar;
}

/// Looks at the body as a step does.
std::vector<sim::Leap> find(StepObjects& objects, const sim::SteppedBody& body) {
  if (body.may_leap()) objects.leaps.note_fast({body.number()});
  objects.leaps.find();
  return objects.leaps.take();
}

TEST(Leaps, AreLookedForFromTheSpeedOfTheShortestSideOn) {
  StepObjects objects;
  sim::SteppedBody& bar = add_bar(objects, {9.9, 0, 0});
  EXPECT_FALSE(bar.may_leap());
  bar.set_velocity_W({10.1, 0, 0}, Vector3d::Zero());
  EXPECT_TRUE(bar.may_leap());
}

TEST(Leaps, AreMotionsFurtherThanTheSizeAlongTheMotion) {
  StepObjects objects;
  EXPECT_TRUE(find(objects, add_bar(objects, {150, 0, 0})).empty()) << "1.5 m of a bar of 2 m";
  const sim::SteppedBody& across = add_bar(objects, {0, 150, 0});
  const std::vector<sim::Leap> leaps = find(objects, across);
  ASSERT_EQ(leaps.size(), 1u);
  EXPECT_EQ(leaps[0].body, across.number());
  EXPECT_NEAR(leaps[0].moved_m, 1.5, 1e-12);
  EXPECT_NEAR(leaps[0].size_m, 0.1, 1e-12);
}

TEST(Leaps, AreLookedForAgainWhenTheBodyIsAFifthFaster) {
  StepObjects objects;
  sim::SteppedBody& bar = add_bar(objects, {100, 0, 0});
  find(objects, bar);
  bar.set_velocity_W({119, 0, 0}, Vector3d::Zero());
  EXPECT_FALSE(bar.may_leap());
  bar.set_velocity_W({121, 0, 0}, Vector3d::Zero());
  EXPECT_TRUE(bar.may_leap());
}

TEST(Leaps, AreReportedOnceUntilTheyArePlannedAnew) {
  StepObjects objects;
  const sim::SteppedBody& bar = add_bar(objects, {0, 150, 0});
  EXPECT_EQ(find(objects, bar).size(), 1u);
  EXPECT_TRUE(find(objects, bar).empty());
  objects.leaps.plan_anew();
  EXPECT_EQ(find(objects, bar).size(), 1u);
}

TEST(Leaps, AreNotOfGroupsThatAreFarFromEverything) {
  StepObjects objects;
  const sim::SteppedBody& bar = add_bar(objects, {0, 150, 0});
  objects.far_groups.update();
  ASSERT_TRUE(objects.far_groups.far(bar.group()));
  EXPECT_TRUE(find(objects, bar).empty());
}

}  // namespace
