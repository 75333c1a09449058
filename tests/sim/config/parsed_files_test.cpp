// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/parsed_files.hpp"

#include <gtest/gtest.h>

#include "sim/config/diagnostics.hpp"

namespace {

std::string value_of_key(const std::string& text, const std::string& path) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode tree = sim::parse_file_text(text, path, diagnostics);
  diagnostics.throw_if_any();
  return tree.find("key")->scalar;
}

TEST(ParsedFiles, GiveTheSameTreeAgain) {
  for (int i = 0; i < 3; ++i) EXPECT_EQ(value_of_key("key: one", "a.yaml"), "one");
}

TEST(ParsedFiles, AreParsedAgainAfterAChange) {
  EXPECT_EQ(value_of_key("key: one", "b.yaml"), "one");
  EXPECT_EQ(value_of_key("key: two", "b.yaml"), "two");
  EXPECT_EQ(value_of_key("key: one", "b.yaml"), "one");
}

TEST(ParsedFiles, HaveTheirOwnPlaces) {
  sim::Diagnostics diagnostics;
  for (const char* path : {"c.yaml", "d.yaml"}) {
    const sim::ConfigNode tree = sim::parse_file_text("\nkey: one", path, diagnostics);
    EXPECT_EQ(tree.find("key")->place.text(), std::string(path) + ":2:6");
  }
}

TEST(ParsedFiles, ReportTheirErrorsEachTime) {
  for (int i = 0; i < 2; ++i) {
    sim::Diagnostics diagnostics;
    sim::parse_file_text("key: [", "e.yaml", diagnostics);
    EXPECT_EQ(diagnostics.lines().size(), 1u);
  }
}

TEST(ParsedFiles, AreKeptInALimitedNumber) {
  for (int round = 0; round < 2; ++round)
    for (int i = 0; i < 100; ++i) {
      const std::string text = std::to_string(i);
      EXPECT_EQ(value_of_key("key: " + text, "f" + text + ".yaml"), text);
    }
}

}  // namespace
