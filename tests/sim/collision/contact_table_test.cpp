// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/contact_table.hpp"

#include <gtest/gtest.h>

namespace {

sim::MaterialConfig material(const std::string& name) {
  sim::MaterialConfig config;
  config.name = name;
  return config;
}

sim::ContactConfig contact(const std::string& first, const std::string& second, double friction) {
  sim::ContactConfig config;
  config.between = {first, second};
  config.friction = friction;
  return config;
}

double friction(const sim::ContactTable& table, const std::string& first, const std::string& second) {
  const sim::Surface& surface = table.of(table.number_of(first), table.number_of(second));
  EXPECT_EQ(&surface, &table.of(table.number_of(second), table.number_of(first)));
  return surface.parameters.mu;
}

TEST(ContactTable, APairOfNamesHasPrecedenceOverAnyAndThenTheLastEntry) {
  const sim::ContactTable table({material("ice"), material("rubber"), material("steel")},
                                {contact("ice", "rubber", 0.3), contact("any", "any", 0.5), contact("rubber", "any", 1),
                                 contact("any", "ice", 0.1), contact("steel", "steel", 0.2)});
  EXPECT_EQ(friction(table, "ice", "rubber"), 0.3);
  EXPECT_EQ(friction(table, "rubber", "steel"), 1);
  EXPECT_EQ(friction(table, "ice", "steel"), 0.1);
  EXPECT_EQ(friction(table, "steel", "steel"), 0.2);
  EXPECT_EQ(friction(table, "steel", "default"), 0.5);
}

TEST(ContactTable, ContactsOfConstructionHavePrecedenceOverThoseOfAVehicle) {
  sim::ContactTable table({material("ice")}, {contact("ice", "any", 0.1)});
  const int ice = table.number_of("ice");
  table.add({material("ice"), material("rubber")}, {contact("ice", "any", 0.7), contact("rubber", "any", 1)});
  EXPECT_EQ(table.number_of("ice"), ice);
  EXPECT_EQ(table.materials(), 3);
  EXPECT_EQ(friction(table, "ice", "default"), 0.1);
  EXPECT_EQ(friction(table, "rubber", "default"), 1);
}

// A table of all pairs would have 500 GB.
TEST(ContactTable, MemoryDoesNotGrowWithThePairs) {
  constexpr int count = 60'000;
  std::vector<sim::MaterialConfig> materials;
  std::vector<sim::ContactConfig> contacts;
  for (int i = 0; i < count; ++i) {
    materials.push_back(material("m" + std::to_string(i)));
    if (i > 0) contacts.push_back(contact("m" + std::to_string(i - 1), "m" + std::to_string(i), 1.0 / i));
  }
  const sim::ContactTable table(materials, contacts);
  EXPECT_EQ(table.materials(), count + 1);
  EXPECT_EQ(friction(table, "m4", "m5"), 0.2);
}

}  // namespace
