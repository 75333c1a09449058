// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/part_shape.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using sim::PartShape;

TEST(PartShape, ChecksEveryKeyThatAShapeHas) {
  std::set<std::string> checked(sim::keys_of_some_shapes().begin(), sim::keys_of_some_shapes().end());
  for (const auto& [word, shape] : sim::part_shape_words)
    for (const std::string_view key : sim::shape_info(shape).keys) {
      EXPECT_TRUE(checked.contains(std::string(key))) << key;
      EXPECT_TRUE(sim::has_key(shape, key)) << word << " " << key;
    }
}

TEST(PartShape, OnlySolidsHaveMass) {
  EXPECT_TRUE(sim::has_key(PartShape::mesh, "mass_kg"));
  EXPECT_FALSE(sim::has_key(PartShape::plane, "mass_kg"));
  EXPECT_FALSE(sim::has_key(PartShape::terrain, "density_kgpm3"));
  EXPECT_FALSE(sim::has_key(PartShape::box, "radius_m"));
}

}  // namespace
