// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/old_options.hpp"

#include <gmock/gmock.h>

namespace {

/// What an option becomes: `key: value, key: value`; `none` when the value is not of its form.
std::string arguments(const char* program, const char* option, const std::string& value) {
  const tools::OldOption* found = tools::find_old_option(program, option);
  if (found == nullptr) return "unknown";
  const auto arguments = tools::arguments_of(*found, value);
  if (!arguments) return "none";
  std::string text;
  for (const tools::Argument& each : *arguments) text += (text.empty() ? "" : ", ") + each.key + ": " + each.value;
  return text;
}

TEST(OldOptions, OfAllProgramsAndOfOne) {
  EXPECT_EQ(arguments("shoal-coop-rover", "--name", "rover1"), "name: rover1");
  EXPECT_EQ(arguments("shoal-balance", "--name", "segway1"), "name: segway1");
  EXPECT_EQ(arguments("shoal-balance", "--waypoints", "0,0"), "unknown");
  EXPECT_TRUE(tools::is_old_program("shoal-coop-station"));
  EXPECT_FALSE(tools::is_old_program("./shoal-coop-station"));
  EXPECT_FALSE(tools::is_old_program("*"));
}

TEST(OldOptions, NumbersStayAsTheyAreAndTextIsQuotedWhereItMust) {
  EXPECT_EQ(arguments("shoal-coop-rover", "--speed", "1.50"), "speed_mps: 1.50");
  EXPECT_EQ(arguments("shoal-coop-rover", "--lcm-url", "{lcm_url}"), "lcm_url: \"{lcm_url}\"");
}

TEST(OldOptions, ListsOfPointsBecomeLists) {
  EXPECT_EQ(arguments("shoal-coop-rover", "--waypoints", "-28,28; -20,-28.5"),
            "waypoints_m: [[-28, 28], [-20, -28.5]]");
  EXPECT_EQ(arguments("shoal-coop-rover", "--start", "-28,-28,90"), "start_m: [-28, -28], start_yaw_deg: 90");
  EXPECT_EQ(arguments("shoal-coop-auv", "--modem-at", "0.5,0,0.1"), "modem_position_m: [0.5, 0, 0.1]");
  EXPECT_EQ(arguments("shoal-coop-station", "--orders", "120:500,200,15;700:600,-300,20,1.8"),
            "orders: [[120, 500, 200, 15], [700, 600, -300, 20, 1.8]]");
  EXPECT_EQ(arguments("shoal-balance", "--speeds", "1:0.5;3:4:5"), "speeds: [[1, 0.5], [3, 4, 5]]");
  EXPECT_EQ(arguments("shoal-coop-auv", "--slot", "2/3"), "slot: 2, slots: 3");
  EXPECT_EQ(arguments("shoal-coop-auv", "--obey", ""), "accept_orders: true");
}

TEST(OldOptions, ABehaviourBecomesTheKeysOfItsKind) {
  EXPECT_EQ(arguments("shoal-coop-craft", "--behaviour", "circle:0,-5,40"), "circle_m: [0, -5, 40]");
  EXPECT_EQ(arguments("shoal-coop-craft", "--behaviour", "zigzag:0,0,2200,0,100,11"),
            "zigzag_m: [0, 0, 2200, 0, 100], zigzag_legs: 11");
  EXPECT_EQ(arguments("shoal-coop-craft", "--behaviour", "follow:auv,0,150"), "follow: auv, follow_offset_m: [0, 150]");
  EXPECT_EQ(arguments("shoal-coop-craft", "--behaviour", "route"), "");
}

TEST(OldOptions, ValuesOfAnotherFormAreRefused) {
  for (const char* value : {"1", "1,2;3", "a,b", "1,2,3", "1,nan"})
    EXPECT_EQ(arguments("shoal-coop-rover", "--waypoints", value), "none") << value;
  for (const char* value : {"1,2", "1,2,x", ""}) EXPECT_EQ(arguments("shoal-coop-rover", "--start", value), "none");
  for (const char* value : {"1", "1/2/3", "a/b"}) EXPECT_EQ(arguments("shoal-coop-auv", "--slot", value), "none");
  for (const char* value :
       {"route:1", "circle:1,2", "zigzag:1,2,3,4,5", "follow:,1,2", "follow:a,1", "spiral:1", "circle"})
    EXPECT_EQ(arguments("shoal-coop-auv", "--behaviour", value), "none") << value;
  for (const char* value : {"1:2,3", "1,2,3,4", "1:2,3,4,5,6"})
    EXPECT_EQ(arguments("shoal-coop-station", "--orders", value), "none") << value;
}

}  // namespace
