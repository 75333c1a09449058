// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/flow_lines.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

TEST(FlowLines, NumbersAreAsShortAsTheyCanBe) {
  EXPECT_EQ(tools::short_number(0.1), "0.1");
  EXPECT_EQ(tools::short_number(2), "2");
  EXPECT_EQ(tools::short_number(1.0 / 3), "0.3333333333");
  EXPECT_EQ(tools::short_number(1e-13), "0");
  EXPECT_EQ(tools::short_number(-1e-13), "0");
  EXPECT_EQ(tools::short_list({1, -0.5, 1e-15}), "[1, -0.5, 0]");
}

TEST(FlowLines, AMapStandsOnOneLineIfItFits) {
  tools::FlowMap map;
  map.add("name", "left");
  map.add("mass_kg", 1.5);
  map.add("axis", sim::Vector3d(0, 1, 0));
  map.add_unless_zero("position_m", sim::Vector3d::Zero());
  EXPECT_EQ(map.lines("  - "), "  - {name: left, mass_kg: 1.5, axis: [0, 1, 0]}\n");
}

TEST(FlowLines, ALongMapIsBrokenBetweenItsEntries) {
  tools::FlowMap map;
  for (int i = 0; i < 20; ++i) map.add("entry_number_" + std::to_string(i), 1.25);
  const std::string text = map.lines("  - ");
  EXPECT_GT(text.size(), 120u);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    EXPECT_LE(end - begin, 120u);
    begin = end + 1;
  }
}

TEST(FlowLines, TextsHaveQuotesWhereTheyNeedThem) {
  EXPECT_EQ(tools::yaml_scalar("left wheel"), "left wheel");
  for (const char* text : {"yes: no", "{a}", "- a", ""}) EXPECT_NE(tools::yaml_scalar(text), text) << text;
}

}  // namespace
