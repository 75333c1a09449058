// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/part_collisions.hpp"

#include <gtest/gtest.h>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace {

std::string object(const std::string& name, const std::string& part) {
  return "  - {name: " + name + ", fixed: true, parts: [{shape: box, " + part + "}]}\n";
}

/// Whether the first part of an object collides with anything.
bool collides(const std::string& objects, const std::string& name) {
  const sim::LoadedWorld loaded =
      sim::load_world_text("shoal: 1\ncategories: [light, glass]\nobjects:\n" + objects, "test", {});
  sim::InProcessBus bus;
  const sim::World world(loaded.config, bus);
  return sim::PartCollisions(world).has(world.objects().at(name).config->bodies.front().parts.front(), name);
}

const std::string lamp = "category: light, collides_with: [light]";

TEST(PartCollisions, OfAPartThatCollidesWithAllAreThereEvenWhereItIsAlone) {
  EXPECT_TRUE(collides(object("block", "mass_kg: 1"), "block"));
  EXPECT_TRUE(collides(object("pane", "category: glass"), "pane"));
}

TEST(PartCollisions, OfALampAreThoseWithLampsOfOthers) {
  EXPECT_FALSE(collides(object("lamp", lamp), "lamp"));
  EXPECT_FALSE(collides(object("lamp", lamp) + object("block", "mass_kg: 1"), "lamp"));
  EXPECT_TRUE(collides(object("lamp", lamp) + object("other", lamp), "lamp"));
}

TEST(PartCollisions, NeedThatEachAcceptsTheCategoryOfTheOther) {
  const std::string pane = object("pane", "category: glass, collides_with: [solid]");
  EXPECT_TRUE(collides(pane + object("block", "collides_with: [glass]"), "pane"));
  EXPECT_FALSE(collides(pane + object("block", "collides_with: [light]"), "pane"));
}

}  // namespace
