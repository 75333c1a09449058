// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world.hpp"

#include <gtest/gtest.h>

#include <type_traits>

namespace {

TEST(World, IsNotMadeOfAConfigThatDoesNotOutliveIt) {
  EXPECT_TRUE((std::is_constructible_v<sim::World, const sim::WorldConfig&, sim::Bus&>));
  EXPECT_TRUE((std::is_constructible_v<sim::World, sim::WorldConfig&, sim::Bus&>));
  EXPECT_FALSE((std::is_constructible_v<sim::World, sim::WorldConfig, sim::Bus&>));
  EXPECT_FALSE((std::is_constructible_v<sim::World, const sim::WorldConfig, sim::Bus&>));
}

}  // namespace
