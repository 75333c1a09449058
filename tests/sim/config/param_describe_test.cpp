// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <numbers>
#include <optional>
#include <string>

#include "sim/config/param_reader.hpp"
#include "tests/sim/config/param_reader_fixture.hpp"

namespace {

using namespace param_reader_fixture;

using sim::ConfigNode;
using sim::ParamInfo;
using sim::ParamReader;
using sim::Vector3d;

TEST(ParamReader, DescribesAWordBesideTheNumber) {
  std::vector<ParamInfo> table;
  ParamReader in(table);
  double number = 5;
  int whole = 0;
  in.read_or_word("number", number, sim::above(0), {"max"}, "m");
  in.read_or_word("whole", whole, sim::at_least(1), {"never"}, "m");
  ASSERT_EQ(table.size(), 2u);
  EXPECT_EQ(table[0].type, "number or max");
  EXPECT_EQ(table[0].rule, "> 0");
  EXPECT_EQ(table[0].initial, "5");
  EXPECT_EQ(table[1].type, "integer or never");
  EXPECT_EQ(table[1].initial, "never");
}

template <typename T>
std::vector<ParamInfo> describe(T& value) {
  std::vector<ParamInfo> table;
  ParamReader in(table);
  value.read(in);
  in.finish();
  return table;
}

struct AllKinds {
  bool flag = true;
  int whole = 3;
  std::int64_t large = 4;
  double number = 1e-9;
  std::optional<double> maybe;
  std::string text = "a: b";
  Vector3d vector = Vector3d(1, 2, 0.5);
  std::vector<double> numbers = {1, 2};
  Lines texts = {"a", ""};
  double angle_rad = std::numbers::pi / 4;
  Vector3d rpy_rad = Vector3d(0, 0, std::numbers::pi / 3);
  std::string word = "a";
  Color color = Color::green;
  std::string body;
  Lines bodies;
  std::string needed = "not shown";
  ConfigNode raw;
  Inner inner;
  std::optional<Inner> maybe_inner;
  std::vector<Inner> inners;

  void read(ParamReader& in) {
    in.read("flag", flag, "m");
    in.read("whole", whole, sim::at_least(1), "m");
    in.read("large", large, sim::any_number(), "m");
    in.read("number", number, sim::above(0), "m");
    in.read("maybe", maybe, sim::any_number(), "m");
    in.read("text", text, "m");
    in.read("vector", vector, sim::any_number(), "m");
    in.read("numbers", numbers, sim::any_number(), "m");
    in.read("texts", texts, "m");
    in.read_deg("angle_deg", angle_rad, sim::between(0, 360), "m");
    in.read_deg("rpy_deg", rpy_rad, "m");
    in.read_one_of("word", word, {"a", "b"}, "m");
    in.read_choice("color", color, {{"red", Color::red}, {"green", Color::green}}, "m");
    in.read_reference("body", body, "body", "m");
    in.read_references("bodies", bodies, "body", "m");
    in.require("needed");
    in.read("needed", needed, "m");
    in.read_raw("raw", raw, "m");
    in.read("inner", inner, "m");
    in.read("maybe_inner", maybe_inner, "m");
    in.read_list("inners", inners, "inner", "m");
    in.describe({"by_hand", "text", "", "", "m", true, {}});
    EXPECT_EQ(in.child("flag"), nullptr);
    EXPECT_FALSE(in.has("flag"));
    EXPECT_EQ(in.node(), nullptr);
    in.declare("body", "x");
    in.declare("body", "x");
    in.error("flag", "no one receives this");
    in.error("nor this");
    EXPECT_TRUE(in.diagnostics().ok());
  }
};

TEST(ParamReader, DescribesEveryKindOfKey) {
  AllKinds all;
  Lines rows;
  for (const ParamInfo& info : describe(all)) {
    EXPECT_EQ(info.meaning, "m");
    rows.push_back(info.key + " | " + info.type + " | " + info.rule + " | " + info.initial +
                   (info.required ? " | required" : "") + " | " + std::to_string(info.children.size()));
  }
  EXPECT_EQ(rows, (Lines{"flag | bool |  | true | 0",
                         "whole | integer | >= 1 | 3 | 0",
                         "large | integer |  | 4 | 0",
                         "number | number | > 0 | 1e-09 | 0",
                         "maybe | number |  | ~ | 0",
                         "text | text |  | \"a: b\" | 0",
                         "vector | [x, y, z] |  | [1, 2, 0.5] | 0",
                         "numbers | list of numbers |  | [1, 2] | 0",
                         "texts | list of text |  | [a, \"\"] | 0",
                         "angle_deg | number | >= 0 and <= 360 | 45 | 0",
                         "rpy_deg | [x, y, z] |  | [0, 0, 60] | 0",
                         "word | text | one of: a, b | a | 0",
                         "color | text | one of: red, green | green | 0",
                         "body | text | name of a body | \"\" | 0",
                         "bodies | list of text | names of bodies | [] | 0",
                         "needed | text |  |  | required | 0",
                         "raw | map |  | {} | 0",
                         "inner | map |  | {} | 2",
                         "maybe_inner | map |  | ~ | 2",
                         "inners | list of maps |  | [] | 2",
                         "by_hand | text |  |  | required | 0"}));
}

TEST(ParamReader, DescribingLeavesTheMembersAlone) {
  AllKinds all;
  all.inner.count = 9;
  const std::vector<ParamInfo> table = describe(all);
  EXPECT_EQ(all.inner.count, 9);
  EXPECT_FALSE(all.maybe_inner.has_value());
  EXPECT_EQ(all.angle_rad, std::numbers::pi / 4);
  EXPECT_TRUE(all.inners.empty());
}

TEST(ParamReader, ATypeThatContainsItselfIsDescribedOnce) {
  Tree tree;
  const std::vector<ParamInfo> table = describe(tree);
  ASSERT_EQ(table.size(), 2u);
  ASSERT_EQ(table[1].children.size(), 2u);
  EXPECT_TRUE(table[1].children[1].children.empty());
}

}  // namespace
