// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/touch_watch.hpp"

#include <gtest/gtest.h>

#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

/// Two balls that fall from 0.1 m onto a table.
std::string falling(const std::string& condition) {
  return "shoal: 1\nphysics: {step_s: 0.01}\ncontacts: [{between: [any, any], restitution: 0}]\nobjects:\n"
         "  - {name: ground, fixed: true, position_m: [0, 0, -5], parts: [{shape: plane}]}\n"
         "  - {name: table, fixed: true, position_m: [0, 0, -0.5], parts: [{shape: box, size_m: [9, 9, 1]}]}\n"
         "  - {name: a, position_m: [0, 0, 0.2], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}\n"
         "  - {name: b, position_m: [1, 0, 0.2], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}\n"
         "events:\n  - {name: touched, when: " +
         condition + ", " + tick;
}

std::size_t touches(const std::string& condition) {
  test::TestWorld test(falling(condition));
  return ticks(test, 1).size();
}

TEST(TouchWatch, CountsEachPairOnceWhileItTouches) {
  EXPECT_EQ(touches("a touches table"), 1u);
  EXPECT_EQ(touches("table touches a"), 1u);
  EXPECT_EQ(touches("a touches b"), 0u);
}

TEST(TouchWatch, AnyIsEverythingButPlanes) {
  EXPECT_EQ(touches("a touches any"), 1u);
  EXPECT_EQ(touches("ground touches any"), 0u);
}

TEST(TouchWatch, ANewObjectOfTheSameNameTouchesAnew) {
  test::TestWorld test(falling("a touches table") +
                       "  - {name: gone, at: 0.5, do: [{remove: a}]}\n"
                       "  - {name: back, at: 0.6, do: [{add: a}]}\n");
  EXPECT_EQ(ticks(test, 1).size(), 2u);
}

}  // namespace
