// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/config_node.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/sim/config/parse.hpp"

namespace {

using sim::ConfigNode;
using sim::Diagnostics;
using sim::SourcePlace;
using Kind = ConfigNode::Kind;
using Lines = std::vector<std::string>;

using test::parse;

const char* const world =
    "run: {speed: 1}\n"
    "vehicles:\n"
    "  - name: rover1\n"
    "    devices:\n"
    "      - {name: lidar, rate_hz: 10}\n"
    "      - {name: imu}\n"
    "numbers: [1, 2, 3]\n";

struct SetResult {
  std::string yaml;
  Lines errors;
};

SetResult set(const std::string& text, const std::string& path, const std::string& value) {
  ConfigNode root = parse(text);
  Diagnostics diagnostics;
  const SourcePlace place{sim::intern_file_name("--set " + path), 0, 0};
  sim::set_config_path(root, path, parse(value), place, diagnostics);
  return {sim::to_yaml(root), diagnostics.lines()};
}

TEST(SetConfigPath, ReplacesAValueOfAMap) {
  EXPECT_EQ(set("run: {speed: 1}\n", "run.speed", "2").yaml, "run:\n  speed: 2\n");
}

TEST(SetConfigPath, FindsItemsByNameAndByIndexFromOne) {
  const std::string by_name = set(world, "vehicles.rover1.devices.imu.rate_hz", "5").yaml;
  EXPECT_NE(by_name.find("- name: imu\n        rate_hz: 5\n"), std::string::npos) << by_name;
  EXPECT_EQ(set(world, "vehicles.1.devices.2.rate_hz", "5").yaml, by_name);
  EXPECT_NE(set(world, "numbers.3", "9").yaml.find("[1, 2, 9]"), std::string::npos);
}

TEST(SetConfigPath, MakesMapsOnTheWay) {
  EXPECT_EQ(set("a: 1\n", "b.c.d", "[1, 2]").yaml, "a: 1\nb:\n  c:\n    d: [1, 2]\n");
  EXPECT_EQ(set("a:\n", "a.b", "1").yaml, "a:\n  b: 1\n");
}

TEST(SetConfigPath, WhatItMakesPointsToItsPlace) {
  ConfigNode root = parse("a: 1\n");
  Diagnostics diagnostics;
  const SourcePlace place{sim::intern_file_name("--set b.c"), 0, 0};
  sim::set_config_path(root, "b.c", parse("2"), place, diagnostics);
  EXPECT_EQ(root.entries.back().place.text(), "--set b.c");
  EXPECT_EQ(root.entries.back().value.place.text(), "--set b.c");
}

TEST(SetConfigPath, ReportsAnItemThatDoesNotExist) {
  EXPECT_EQ(
      set(world, "vehicles.rover2.file", "x").errors,
      Lines{"--set vehicles.rover2.file: 'vehicles' has no item 'rover2'; items: rover1; did you mean 'rover1'?"});
  EXPECT_EQ(set(world, "numbers.4", "x").errors, Lines{"--set numbers.4: 'numbers' has no item '4'; items: 1 to 3"});
  EXPECT_EQ(set(world, "numbers.0", "x").errors, Lines{"--set numbers.0: 'numbers' has no item '0'; items: 1 to 3"});
  EXPECT_EQ(set("a: []\n", "a.b", "x").errors, Lines{"--set a.b: 'a' has no item 'b'; items: none"});
}

TEST(SetConfigPath, ReportsAPathThroughAScalar) {
  EXPECT_EQ(set(world, "run.speed.x", "1").errors, Lines{"--set run.speed.x: no 'x' in 'speed', which is '1'"});
}

TEST(SetConfigPath, ReportsABadPath) {
  for (const char* path : {"", ".", "a.", ".a", "a..b"})
    EXPECT_EQ(set(world, path, "1").errors, Lines{std::string("--set ") + path + ": bad path '" + path +
                                                  "'; a path is keys and names joined by dots"});
  std::string deep = "a";
  for (int i = 0; i < 100000; ++i) deep += ".a";
  EXPECT_EQ(set(world, deep, "1").errors.size(), 1u);
}

using Parameters = std::vector<std::pair<std::string, ConfigNode>>;

SetResult substitute(const std::string& text, const Parameters& parameters) {
  ConfigNode root = parse(text);
  Diagnostics diagnostics;
  sim::substitute_parameters(root, parameters, "vehicle 'r1'", diagnostics);
  return {sim::to_yaml(root), diagnostics.lines()};
}

TEST(SubstituteParameters, AWholeScalarTakesTheNode) {
  const Parameters parameters = {{"r", parse("0.1")}, {"axis", parse("[0, 1, 0]")}};
  EXPECT_EQ(substitute("a: ${r}\nb: '${axis}'\nc: ['${r}', 2]\n", parameters).yaml,
            "a: 0.1\nb: [0, 1, 0]\nc: [0.1, 2]\n");
}

TEST(SubstituteParameters, PartsOfATextAreReplaced) {
  const Parameters parameters = {{"index", parse("3")}, {"side", parse("left")}};
  EXPECT_EQ(substitute("a: ${side}_wheel${index}\nb: $5 {x}\n", parameters).yaml, "a: left_wheel3\nb: $5 {x}\n");
}

TEST(SubstituteParameters, AValueKeepsThePlaceItWasWrittenAt) {
  Diagnostics diagnostics;
  const ConfigNode value = sim::parse_config_text("heavy", "mine.yaml", diagnostics);
  ConfigNode root = parse("mass: ${m}\n");
  sim::substitute_parameters(root, {{"m", value}}, "", diagnostics);
  EXPECT_EQ(root.find("mass")->place.text(), "mine.yaml:1:1");
}

TEST(SubstituteParameters, WhatWasPutInIsNotSearchedAgain) {
  const Parameters parameters = {{"a", parse("'${a}${a}'")}};
  EXPECT_EQ(substitute("x: ${a}\ny: _${a}\n", parameters).yaml, "x: \"${a}${a}\"\ny: _${a}${a}\n");
}

TEST(SubstituteParameters, ReportsUnknownNames) {
  const Parameters parameters = {{"radius", parse("1")}, {"mass", parse("2")}};
  EXPECT_EQ(substitute("a:\n  - ${radios}\n", parameters).errors,
            Lines{"w.yaml:2:5: vehicle 'r1': unknown parameter 'radios'; known parameters: mass, radius"});
  EXPECT_EQ(substitute("a: ${x}\n", {}).errors,
            Lines{"w.yaml:1:4: vehicle 'r1': unknown parameter 'x'; known parameters: none"});
}

TEST(SubstituteParameters, ReportsAMissingBrace) {
  EXPECT_EQ(substitute("a: 1${x\n", {}).errors, Lines{"w.yaml:1:4: vehicle 'r1': '${' without '}' in '1${x'"});
}

TEST(SubstituteParameters, ReportsAListInsideOfText) {
  const Parameters parameters = {{"list", parse("[1, 2]")}};
  EXPECT_EQ(substitute("a: x${list}\n", parameters).errors,
            Lines{"w.yaml:1:4: vehicle 'r1': parameter 'list' must be text inside of text, got [1, 2]"});
}

TEST(SubstituteParameters, CannotFillTheMemory) {
  ConfigNode text;
  text.kind = Kind::scalar;
  text.scalar.assign(10'000'000, 'x');
  ConfigNode list;
  list.kind = Kind::list;
  list.items.resize(100'000);
  std::string file;
  for (int i = 0; i < 100; ++i) file += "- ${text}\n- ${list}\n";
  const Lines errors = substitute(file, {{"text", text}, {"list", list}}).errors;
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("the substituted parameters make the file too large"), std::string::npos);
}

}  // namespace
