// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/metric_config.hpp"

#include <gmock/gmock.h>

#include "sim/config/diagnostics.hpp"
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/rule_expression.hpp"

namespace {

using testing::HasSubstr;

/// The errors of a world with two metrics and this text after them, without the name of the file.
std::string world_error(const std::string& text) {
  try {
    sim::load_world_text("shoal: 1\n" + text, "w.yaml");
    return {};
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
}

TEST(RulesOfAWorld, PointAtTheCharacterInPlainAndQuotedText) {
  const std::string what = "rule 1: unknown metric 'm'; known metrics: none";
  EXPECT_EQ(world_error("pass: [m.count < 3]\n"), "w.yaml:2:8: " + what);
  EXPECT_EQ(world_error("pass:\n  - 3 > m.count\n"), "w.yaml:3:9: " + what);
  EXPECT_EQ(world_error("pass:\n  - '3 > m.count'\n"), "w.yaml:3:10: " + what);
  EXPECT_EQ(world_error("pass:\n  - \"3 > m.count\"\n"), "w.yaml:3:10: " + what);
  EXPECT_EQ(world_error("pass:\r\n  - 3 > m.count\r\n"), "w.yaml:3:9: " + what);
  EXPECT_EQ(world_error("name: ä\npass:\n  - 3 > m.count\n"), "w.yaml:4:9: " + what);
}

TEST(RulesOfAWorld, PointAtTheStartOfTextThatTheFileHasInOtherForm) {
  const std::string what = "rule 1: unknown metric 'm'; known metrics: none";
  EXPECT_EQ(world_error("pass:\n  - >\n    3\n    > m.count\n"), "w.yaml:3:5: " + what);
  EXPECT_EQ(world_error("pass:\n  - |\n    3 > m.count\n"), "w.yaml:3:5: " + what);
  EXPECT_EQ(world_error("pass:\n  - 3\n    > m.count\n"), "w.yaml:3:5: " + what);
  EXPECT_EQ(world_error("pass:\n  - \"3\\x20> m.count\"\n"), "w.yaml:3:5: " + what);
}

TEST(RulesOfAWorld, AreRefusedAsMaps) {
  EXPECT_THAT(world_error("pass: [{metric: m.count, below: }]\n"),
              HasSubstr("rule 1: a rule is text, a comparison such as 'METRIC.FIGURE < 5', got {metric: m.count"));
  EXPECT_THAT(world_error("pass: [~]\n"), HasSubstr("rule 1: a rule is text"));
  EXPECT_EQ(world_error("pass: m.count < 3\n"), "w.yaml:2:7: 'pass' must be a list of rules, got 'm.count < 3'");
  EXPECT_EQ(world_error("pass:\n"), "");
}

}  // namespace
