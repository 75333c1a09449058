// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/nav_arguments.hpp"

#include <gtest/gtest.h>

#include "sim/config/diagnostics.hpp"

namespace {

using namespace navigation;

TEST(NavArguments, AreThoseOfTheProcessesThatRunTheProgram) {
  const auto arguments = nav_arguments_of(R"(
shoal: 1
processes:
  - {name: one, program: shoal-nav, args: {name: auv, start_m: [400, -3], start_std_m: 2, period_s: 0.25, sound: rays}}
  - {name: two, program: shoal-nav, args: {name: craft, circle_m: [0, 0, 100]}}
  - {name: three, program: shoal-coop-auv, args: {name: other, period_s: 3}}
)");
  ASSERT_EQ(arguments.size(), 2U);
  const NavOptions auv = arguments.at("auv").applied_to({});
  EXPECT_EQ(auv.start.p_W, Vector2(400, -3));
  EXPECT_EQ(auv.start.std_m, 2);
  EXPECT_EQ(auv.period_us, 250'000);
  EXPECT_EQ(auv.sound, SoundModel::rays);
  const NavOptions craft = arguments.at("craft").applied_to({});
  EXPECT_FALSE(craft.start.p_W);
  EXPECT_EQ(craft.start.std_m, 1);
  EXPECT_EQ(craft.period_us, 500'000);
  EXPECT_EQ(craft.sound, SoundModel::straight);
}

TEST(NavArguments, ThatTheProgramWouldRefuseAreLeftOut) {
  const auto arguments = nav_arguments_of(R"(
processes:
  - {name: one, program: shoal-nav, args: {name: auv, start_m: [400], period_s: -1, sound: loud}}
)");
  const NavArguments& auv = arguments.at("auv");
  EXPECT_FALSE(auv.start_m || auv.period_us || auv.sound);
}

TEST(NavArguments, OfAWorldWithoutProcessesAreNone) {
  EXPECT_TRUE(nav_arguments_of("shoal: 1\n").empty());
  EXPECT_TRUE(nav_arguments_of("processes: 3\n").empty());
  EXPECT_THROW(nav_arguments_of("processes: ["), sim::ConfigError);
}

}  // namespace
