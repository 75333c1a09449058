// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/parts.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/sim/physics/step_objects.hpp"

namespace {

using namespace small_worlds;

TEST(Parts, GiveEachCategoryABitInTheOrderOfTheirNames) {
  sim::Parts parts;
  parts.add_categories({"glass", "solid", "net"});
  EXPECT_EQ(parts.category_bit("solid"), 1u) << "always the first";
  EXPECT_EQ(parts.category_bit("glass"), 2u);
  EXPECT_EQ(parts.category_bit("net"), 4u);
  EXPECT_THROW(parts.category_bit("fog"), std::out_of_range);
}

TEST(Parts, RefuseA32ndCategoryAndAddNoneThen) {
  sim::Parts parts;
  std::vector<std::string> names;
  for (int i = 0; i < 31; ++i) names.push_back("category" + std::to_string(i));
  EXPECT_THROW(parts.add_categories(names), std::length_error) << "with `solid` these are 32";
  EXPECT_THROW(parts.category_bit("category0"), std::out_of_range);
  names.pop_back();
  parts.add_categories(names);
  EXPECT_EQ(parts.category_bit("category29"), 1u << 30);
}

TEST(Parts, HaveNamesOfTheirOwnOrTheirPlaceInTheBody) {
  StepObjects objects;
  PartConfig named = at(box({1, 1, 1}, 1), {0, 0, 2});
  named.name = "mast";
  const sim::SteppedBody& hull = objects.add(body("hull", {sphere(1, 1), named}), Pose::Identity());
  ASSERT_EQ(objects.parts.all().size(), 2u);
  EXPECT_EQ(objects.parts[0].name, "hull/1");
  EXPECT_EQ(objects.parts[1].name, "hull/mast");
  EXPECT_EQ(objects.parts[1].body, hull.number());
  EXPECT_EQ(objects.parts[1].X_BP.translation().z(), 2);
  EXPECT_EQ(objects.collider.parts()[1].body, hull.number()) << "the collider has the same numbers";
}

TEST(Parts, GiveTheBodyTheirMass) {
  StepObjects objects;
  const sim::SteppedBody& hull =
      objects.add(body("hull", {at(sphere(1, 1), {0, 0, 0}), at(sphere(1, 3), {4, 0, 0})}), Pose::Identity());
  EXPECT_DOUBLE_EQ(hull.mass_kg(), 4);
  EXPECT_DOUBLE_EQ(hull.p_BC().x(), 3) << "three quarters of the way to the heavier one";
}

TEST(Parts, AddNoneWhenOneIsInvalid) {
  StepObjects objects;
  const int group = objects.add_group("invalid");
  EXPECT_THROW(objects.add_body(group, body("body", {sphere(1, 1), plane()}), Pose::Identity()), sim::ConfigError)
      << "a plane can only be part of a fixed body";
  EXPECT_TRUE(objects.parts.all().empty());
  EXPECT_TRUE(objects.collider.parts().empty());
}

TEST(Parts, ReuseTheNumbersOfRemovedOnes) {
  StepObjects objects;
  objects.add_ball("a", 0);
  objects.add_ball("b", 10);
  objects.collider.remove_group(0, objects.groups[0].bodies, objects.groups[0].parts);
  objects.parts.remove(objects.groups[0].parts);
  EXPECT_EQ(objects.parts[0].group, -1);
  objects.add_ball("c", 20);
  EXPECT_EQ(objects.parts[0].name, "c/1");
  EXPECT_EQ(objects.parts[1].name, "b/1");
}

}  // namespace
