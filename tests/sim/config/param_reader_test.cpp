// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/param_reader.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "tests/sim/config/param_reader_fixture.hpp"

namespace {

using namespace param_reader_fixture;

using sim::ConfigNode;
using sim::Diagnostics;
using sim::ParamReader;
using sim::Vector3d;

/// Reads `yaml` with `read` as device 'lidar' of vehicle 'auv1'; gives the errors without that start.
Lines errors_of(const std::string& yaml, const std::function<void(ParamReader&)>& read) {
  Diagnostics diagnostics;
  const ConfigNode node = sim::parse_config_text(yaml, "w.yaml", diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << yaml;
  ParamReader in(node, "device 'lidar'", diagnostics);
  read(in);
  in.finish();
  Lines lines;
  for (const std::string& line : diagnostics.lines()) {
    const std::string start = ": device 'lidar': ";
    const std::size_t at = line.find(start);
    lines.push_back(at == std::string::npos ? line : line.substr(7, at - 7) + " " + line.substr(at + start.size()));
  }
  return lines;
}

/// Reads `x: <yaml>` into `value`; gives the only error, or nothing.
template <typename T, typename... Rest>
std::string error_of(T& value, const std::string& yaml, const Rest&... rest) {
  const Lines lines = errors_of("x: " + yaml + "\n", [&](ParamReader& in) { in.read("x", value, rest..., "a test"); });
  EXPECT_LE(lines.size(), 1u);
  return lines.empty() ? "" : lines[0];
}

// Text

TEST(ParamReader, RefusesControlCharactersWhichATerminalWouldObey) {
  std::string text;
  EXPECT_EQ(error_of(text, R"("two\nlines\tand ü")"), "");
  EXPECT_EQ(text, "two\nlines\tand ü");
  for (const auto& [yaml, shown] : std::map<std::string, std::string>{
           {R"("\e]0;x\a")", R"(\x1b]0;x\x07)"}, {R"("a\rb")", R"(a\rb)"}, {R"("\x9b2J")", R"(\x9b2J)"}})
    EXPECT_THAT(error_of(text, yaml), testing::EndsWith("'x' must have no control characters, got '" + shown + "'"));
}

// Rules

// Single values

TEST(ParamReader, ReadsNumbersAsYamlWritesThem) {
  for (const auto& [text, expected] : std::vector<std::pair<std::string, double>>{{"1.5", 1.5},
                                                                                  {"-2", -2},
                                                                                  {"+3", 3},
                                                                                  {".5", 0.5},
                                                                                  {"5.", 5},
                                                                                  {"1e3", 1000},
                                                                                  {"1E-3", 0.001},
                                                                                  {"010", 10},
                                                                                  {"1e-999", 0}}) {
    double value = -7;
    EXPECT_EQ(error_of(value, text, sim::any_number()), "") << text;
    EXPECT_EQ(value, expected) << text;
  }
}

TEST(ParamReader, ReportsWhatIsNoNumber) {
  double value = -7;
  EXPECT_EQ(error_of(value, "heavy", sim::any_number()), "1:4 'x' must be a number, got 'heavy'");
  EXPECT_EQ(error_of(value, "'5'", sim::any_number()), "1:4 'x' must be a number, got the text '5'");
  EXPECT_EQ(error_of(value, "[1, 2]", sim::any_number()), "1:4 'x' must be a number, got [1, 2]");
  EXPECT_EQ(error_of(value, "{a: 1}", sim::any_number()), "1:4 'x' must be a number, got {a: 1}");
  EXPECT_EQ(error_of(value, "~", sim::any_number()), "1:4 'x' must be a number, got nothing");
  for (const char* text : {"1_000", "0x10", "1,5", "1.5m", "--1", "+-1", "+", ".", "1e", "e5", "١"})
    EXPECT_EQ(error_of(value, text, sim::any_number()), std::string("1:4 'x' must be a number, got '") + text + "'");
  EXPECT_EQ(value, -7);
}

TEST(ParamReader, ReportsNumbersThatAreNotFinite) {
  double value = -7;
  for (const char* text : {".nan", ".NaN", ".inf", "-.inf", "+.INF", "nan", "inf", "-infinity", "1e999", "-1e999"})
    EXPECT_EQ(error_of(value, text, sim::any_number()), std::string("1:4 'x' must be finite, got '") + text + "'");
  int whole = -7;
  EXPECT_EQ(error_of(whole, ".nan", sim::any_number()), "1:4 'x' must be finite, got '.nan'");
  EXPECT_EQ(value, -7);
}

TEST(ParamReader, ReportsNumbersOutsideTheRule) {
  double value = -7;
  EXPECT_EQ(error_of(value, "0", sim::at_least(1)), "1:4 'x' must be >= 1, got 0");
  EXPECT_EQ(error_of(value, "361", sim::between(0, 360)), "1:4 'x' must be >= 0 and <= 360, got 361");
  EXPECT_EQ(value, -7);
}

TEST(ParamReader, ReadsWholeNumbers) {
  for (const auto& [text, expected] :
       std::vector<std::pair<std::string, int>>{{"5", 5}, {"-5", -5}, {"+5", 5}, {"1e3", 1000}, {"2.0", 2}}) {
    int value = -7;
    EXPECT_EQ(error_of(value, text, sim::any_number()), "") << text;
    EXPECT_EQ(value, expected) << text;
  }
  std::int64_t large = 0;
  EXPECT_EQ(error_of(large, "9223372036854775807", sim::at_least(0)), "");
  EXPECT_EQ(large, 9223372036854775807);
}

TEST(ParamReader, ReportsWhatIsNoWholeNumber) {
  int value = -7;
  EXPECT_EQ(error_of(value, "1.5", sim::any_number()), "1:4 'x' must be a whole number, got '1.5'");
  EXPECT_EQ(error_of(value, "many", sim::any_number()), "1:4 'x' must be a whole number, got 'many'");
  EXPECT_EQ(error_of(value, "'5'", sim::any_number()), "1:4 'x' must be a whole number, got the text '5'");
  EXPECT_EQ(error_of(value, "0", sim::at_least(1)), "1:4 'x' must be >= 1, got 0");
  EXPECT_EQ(error_of(value, "2147483648", sim::any_number()), "1:4 'x' must be <= 2147483647, got 2147483648");
  EXPECT_EQ(error_of(value, "-2147483649", sim::any_number()), "1:4 'x' must be >= -2147483648, got -2147483649");
  std::int64_t large = -7;
  EXPECT_EQ(error_of(large, "9223372036854775808", sim::any_number()),
            "1:4 'x' must be a whole number of at most 63 bits, got '9223372036854775808'");
  EXPECT_EQ(value, -7);
  EXPECT_EQ(large, -7);
}

TEST(ParamReader, ReadsTrueAndFalseAndNothingElse) {
  bool value = false;
  EXPECT_EQ(error_of(value, "true"), "");
  EXPECT_TRUE(value);
  EXPECT_EQ(error_of(value, "False"), "");
  EXPECT_FALSE(value);
  EXPECT_EQ(error_of(value, "yes"), "1:4 'x' must be true or false, got 'yes'");
  EXPECT_EQ(error_of(value, "'true'"), "1:4 'x' must be true or false, got the text 'true'");
}

TEST(ParamReader, TextMayLookLikeANumber) {
  std::string value = "default";
  EXPECT_EQ(error_of(value, "007"), "");
  EXPECT_EQ(value, "007");
  EXPECT_EQ(error_of(value, "''"), "");
  EXPECT_EQ(value, "");
  EXPECT_EQ(error_of(value, "[a]"), "1:4 'x' must be text, got [a]");
  EXPECT_EQ(error_of(value, ""), "1:1 'x' must be text, got nothing");
}

TEST(ParamReader, AnOptionalIsUnsetByNothing) {
  std::optional<double> value = 3;
  EXPECT_EQ(error_of(value, "-1", sim::at_least(0)), "1:4 'x' must be >= 0, got -1");
  EXPECT_EQ(value, 3);
  EXPECT_EQ(error_of(value, "4", sim::at_least(0)), "");
  EXPECT_EQ(value, 4);
  EXPECT_EQ(error_of(value, "~", sim::at_least(0)), "");
  EXPECT_EQ(value, std::nullopt);
}

/// Reads `x: <yaml>` as a number or a word.
template <typename T>
std::string error_of_word(T& value, const std::string& yaml) {
  const Lines lines = errors_of("x: " + yaml + "\n", [&](ParamReader& in) {
    in.read_or_word("x", value, sim::between(1, 9), {"none"}, "a test");
  });
  EXPECT_LE(lines.size(), 1u);
  return lines.empty() ? "" : lines[0];
}

TEST(ParamReader, AWordStandsForWhatNoNumberSays) {
  double number = 5;
  EXPECT_EQ(error_of_word(number, "none"), "");
  EXPECT_EQ(number, 0);
  EXPECT_EQ(error_of_word(number, "2.5"), "");
  EXPECT_EQ(number, 2.5);
  int whole = 5;
  EXPECT_EQ(error_of_word(whole, "\"none\""), "");
  EXPECT_EQ(whole, 0);
  EXPECT_EQ(error_of_word(whole, "3"), "");
  EXPECT_EQ(whole, 3);
  std::int64_t large = 5;
  EXPECT_EQ(error_of_word(large, "none"), "");
  EXPECT_EQ(large, 0);
}

TEST(ParamReader, NamesTheWordWhereItsNumberIsWritten) {
  double number = 5;
  const std::string zero = "1:4 'x' must be >= 1 and <= 9, or 'none', got 0; write 'x: none'";
  EXPECT_EQ(error_of_word(number, "0"), zero);
  EXPECT_EQ(error_of_word(number, "10"), "1:4 'x' must be >= 1 and <= 9, or 'none', got 10");
  EXPECT_EQ(error_of_word(number, "nne"), "1:4 'x' must be a number or 'none', got 'nne'");
  EXPECT_EQ(error_of_word(number, "[1]"), "1:4 'x' must be a number or 'none', got [1]");
  EXPECT_EQ(error_of_word(number, ".inf"), "1:4 'x' must be finite, got '.inf'");
  EXPECT_EQ(number, 5);
  int whole = 5;
  EXPECT_EQ(error_of_word(whole, "0"), zero);
  EXPECT_EQ(error_of_word(whole, "1.5"), "1:4 'x' must be a whole number, got '1.5'");
  EXPECT_EQ(whole, 5);
}

TEST(ParamReader, AnOptionalVectorIsUnsetByNothing) {
  std::optional<Vector3d> value;
  EXPECT_EQ(error_of(value, "[1, 2, 3]", sim::any_number()), "");
  EXPECT_EQ(value, Vector3d(1, 2, 3));
  EXPECT_EQ(error_of(value, "~", sim::any_number()), "");
  EXPECT_EQ(value, std::nullopt);
  EXPECT_EQ(error_of(value, "[1, 2]", sim::any_number()), "1:4 'x' must be a list of 3 numbers, got [1, 2]");
}

TEST(ParamReader, AVectorIsAListOfThreeNumbers) {
  Vector3d value(7, 7, 7);
  EXPECT_EQ(error_of(value, "[1, 2.5, -3]", sim::any_number()), "");
  EXPECT_EQ(value, Vector3d(1, 2.5, -3));
  EXPECT_EQ(error_of(value, "[1, 2]", sim::any_number()), "1:4 'x' must be a list of 3 numbers, got [1, 2]");
  EXPECT_EQ(error_of(value, "5", sim::any_number()), "1:4 'x' must be a list of 3 numbers, got '5'");
  EXPECT_EQ(error_of(value, "[1, a, 3]", sim::any_number()), "1:8 item 2 of 'x' must be a number, got 'a'");
  EXPECT_EQ(error_of(value, "[1, 2, 0]", sim::above(0)), "1:11 item 3 of 'x' must be > 0, got 0");
  EXPECT_EQ(value, Vector3d(1, 2.5, -3));
}

TEST(ParamReader, ListsHoldNumbersOrText) {
  std::vector<double> numbers = {7};
  EXPECT_EQ(error_of(numbers, "[1, .inf]", sim::any_number()), "1:8 item 2 of 'x' must be finite, got '.inf'");
  EXPECT_EQ(error_of(numbers, "1", sim::any_number()), "1:4 'x' must be a list of numbers, got '1'");
  EXPECT_EQ(numbers, std::vector<double>{7});
  EXPECT_EQ(error_of(numbers, "[1, 2]", sim::any_number()), "");
  EXPECT_EQ(numbers, (std::vector<double>{1, 2}));
  Lines texts = {"a"};
  EXPECT_EQ(error_of(texts, "[a, [b]]"), "1:8 item 2 of 'x' must be text, got [b]");
  EXPECT_EQ(error_of(texts, "a"), "1:4 'x' must be a list of text, got 'a'");
  EXPECT_EQ(texts, Lines{"a"});
  EXPECT_EQ(error_of(texts, "[b, 5]"), "");
  EXPECT_EQ(texts, (Lines{"b", "5"}));
  EXPECT_EQ(error_of(texts, ""), "");
  EXPECT_EQ(texts, Lines{});
}

TEST(ParamReader, DegreesBecomeRadians) {
  double angle_rad = 0;
  Vector3d rpy_rad = Vector3d::Zero();
  const auto read = [&](ParamReader& in) {
    in.read_deg("fov_deg", angle_rad, sim::between(0, 360), "");
    in.read_deg("rpy_deg", rpy_rad, "");
  };
  EXPECT_EQ(errors_of("fov_deg: 180\nrpy_deg: [0, 90, -180]\n", read), Lines{});
  EXPECT_EQ(angle_rad, std::numbers::pi);
  EXPECT_EQ(rpy_rad, Vector3d(0, std::numbers::pi / 2, -std::numbers::pi));
  EXPECT_EQ(errors_of("fov_deg: 361\n", read), Lines{"1:10 'fov_deg' must be >= 0 and <= 360, got 361"});
}

TEST(ParamReader, AChoiceIsOneOfItsWords) {
  std::string word = "a";
  Color color = Color::red;
  const auto read = [&](ParamReader& in) {
    in.read_one_of("mode", word, {"a", "b"}, "");
    in.read_choice("color", color, {{"red", Color::red}, {"green", Color::green}}, "");
  };
  EXPECT_EQ(errors_of("mode: b\ncolor: green\n", read), Lines{});
  EXPECT_EQ(word, "b");
  EXPECT_EQ(color, Color::green);
  EXPECT_EQ(errors_of("mode: c\ncolor: [red]\n", read),
            (Lines{"1:7 'mode' must be one of: a, b; got 'c'", "2:8 'color' must be one of: red, green; got [red]"}));
  EXPECT_EQ(word, "b");
  EXPECT_EQ(color, Color::green);
}

TEST(ParamReader, AChoiceMayHaveAWordForNone) {
  std::optional<Color> color = Color::red;
  const auto read = [&](ParamReader& in) {
    in.read_choice("color", color, "any", {{"red", Color::red}, {"green", Color::green}}, "");
  };
  EXPECT_EQ(errors_of("x: 1\n", read), Lines{"1:1 unknown key 'x'; known keys: color"});
  EXPECT_EQ(color, Color::red);
  EXPECT_EQ(errors_of("color: any\n", read), Lines{});
  EXPECT_EQ(color, std::nullopt);
  EXPECT_EQ(errors_of("color: green\n", read), Lines{});
  EXPECT_EQ(color, Color::green);
  EXPECT_EQ(errors_of("color: blue\n", read), Lines{"1:8 'color' must be one of: any, red, green; got 'blue'"});
  EXPECT_EQ(color, Color::green);
}

TEST(ParamReader, AChoiceMayBeOfSomeOfTheWords) {
  Color color = Color::green;
  const Color allowed[] = {Color::green};
  const auto read = [&](ParamReader& in) {
    in.read_choice("color", color, {{"red", Color::red}, {"green", Color::green}}, allowed, "");
  };
  EXPECT_EQ(errors_of("color: green\n", read), Lines{});
  EXPECT_EQ(errors_of("color: red\n", read), Lines{"1:8 'color' must be one of: green; got 'red'"});
  EXPECT_EQ(color, Color::green);
}

TEST(ParamReader, ALongValueIsCutInTheMessage) {
  double value = 0;
  const std::string error = error_of(value, std::string(1000, 'z'), sim::any_number());
  EXPECT_EQ(error, "1:4 'x' must be a number, got '" + std::string(57, 'z') + "...'");
  const std::string controls = error_of(value, "\"a\\nb\\e[1m\"", sim::any_number());
  EXPECT_EQ(controls, "1:4 'x' must be a number, got the text 'a\\nb\\x1b[1m'");
}

TEST(ParamReader, RawTreesAreKept) {
  ConfigNode value;
  EXPECT_EQ(errors_of("x: {a.b: [1]}\n", [&](ParamReader& in) { in.read_raw("x", value, ""); }), Lines{});
  EXPECT_EQ(value.entries.at(0).key, "a.b");
}

// Keys

TEST(ParamReader, ReportsUnknownKeysAtTheKey) {
  int beams = 0;
  double fov_deg = 0;
  const auto read = [&](ParamReader& in) {
    in.read("fov_deg", fov_deg, sim::any_number(), "");
    in.read("beams", beams, sim::any_number(), "");
  };
  EXPECT_EQ(errors_of("beams: 5\nbeam: 3\n", read),
            Lines{"2:1 unknown key 'beam'; known keys: beams, fov_deg; did you mean 'beams'?"});
  EXPECT_EQ(errors_of("color: 3\n", read), Lines{"1:1 unknown key 'color'; known keys: beams, fov_deg"});
  EXPECT_EQ(errors_of("{a: 1, b: 2}\n", [](ParamReader&) {}),
            (Lines{"1:2 unknown key 'a'; known keys: none", "1:8 unknown key 'b'; known keys: none"}));
}

TEST(ParamReader, ReportsAFewOfManyUnknownKeys) {
  std::string yaml;
  for (int i = 0; i < 1000; ++i) yaml += "k" + std::to_string(i) + ": 1\n";
  const Lines errors = errors_of(yaml, [](ParamReader&) {});
  ASSERT_EQ(errors.size(), 21u);
  EXPECT_EQ(errors.back(), "21:1 more unknown keys are not shown");
}

TEST(ParamReader, ReportsAMissingKeyAtTheMap) {
  std::string file = "default";
  const auto read = [&](ParamReader& in) {
    in.require("file");
    in.read("name", file, "");  // another key in between
    in.read("file", file, "");
    in.read("file", file, "");  // required once
  };
  EXPECT_EQ(errors_of("\nname: 5\n", read), Lines{"2:1 missing key 'file'"});
  EXPECT_EQ(errors_of("file: x\n", read), Lines{});
}

TEST(ParamReader, AnEmptyMapMayBeWrittenAsNothing) {
  int beams = 3;
  EXPECT_EQ(errors_of("", [&](ParamReader& in) { in.read("beams", beams, sim::any_number(), ""); }), Lines{});
  EXPECT_EQ(beams, 3);
}

TEST(ParamReader, ReportsOnlyOnceThatItIsNoMap) {
  std::string file;
  const auto read = [&](ParamReader& in) {
    in.require("file");
    in.read("file", file, "");
  };
  EXPECT_EQ(errors_of("[1, 2]\n", read), Lines{"1:1 must be a map of keys and values, got [1, 2]"});
}

TEST(ParamReader, KnowsTheKeysItHas) {
  EXPECT_EQ(errors_of("a: 5\n",
                      [](ParamReader& in) {
                        EXPECT_TRUE(in.has("a"));
                        EXPECT_FALSE(in.has("b"));
                        EXPECT_EQ(in.child("b"), nullptr);
                        ASSERT_NE(in.child("a"), nullptr);  // and 'a' is known from here on
                        EXPECT_EQ(in.child("a")->scalar, "5");
                        EXPECT_FALSE(in.describing());
                      }),
            Lines{});
}

TEST(ParamReader, OwnErrorsStandAtTheValueOrTheMap) {
  EXPECT_EQ(errors_of("\na: 5\n",
                      [](ParamReader& in) {
                        in.child("a");
                        in.error("a", "is odd");
                        in.error("b", "does not exist");
                        in.error("is wrong");
                      }),
            (Lines{"2:4 is odd", "2:1 does not exist", "2:1 is wrong"}));
}

// Maps in maps

struct Item {
  std::string name;
  double x = 0.5;
  Inner inner;
  std::optional<Inner> maybe;
  void read(ParamReader& in) {
    in.require("name");
    in.read("name", name, "its name");
    in.read("x", x, sim::any_number(), "a number");
    in.read("inner", inner, "a map");
    in.read("maybe", maybe, "a map or none");
  }
};

struct Outer {
  std::vector<Item> joints;
  Inner inner;
  Lines categories;
  void read(ParamReader& in) {
    in.read("categories", categories, "some names");
    for (const std::string& category : categories) in.declare("category", category);
    in.read_list("joints", joints, "joint", "some joints");
    for (const Item& joint : joints) in.declare("joint", joint.name);
    in.read("inner", inner, "a map");
  }
};

Lines outer_errors(const std::string& yaml, Outer& outer) {
  Diagnostics diagnostics;
  const ConfigNode node = sim::parse_config_text(yaml, "w.yaml", diagnostics);
  ParamReader in(node, "vehicle 'auv1'", diagnostics);
  outer.read(in);
  in.finish();
  return diagnostics.lines();
}

TEST(ParamReader, ReadsNestedMapsAndLists) {
  Outer outer;
  EXPECT_EQ(outer_errors("joints:\n"
                         "  - {name: left, x: 2}\n"
                         "  - {name: right, maybe: {count: 4}}\n"
                         "inner: {count: 3, joint: right}\n",
                         outer),
            Lines{});
  ASSERT_EQ(outer.joints.size(), 2u);
  EXPECT_EQ(outer.joints[0].x, 2);
  EXPECT_FALSE(outer.joints[0].maybe.has_value());
  EXPECT_EQ(outer.joints[1].maybe->count, 4);
  EXPECT_EQ(outer.inner.count, 3);
  EXPECT_EQ(outer.inner.joint, "right");
}

TEST(ParamReader, NestedErrorsSayWho) {
  Outer outer;
  EXPECT_EQ(outer_errors("joints:\n"
                         "  - {name: left, x: a}\n"
                         "  - {x: 1}\n"
                         "  - {name: right, inner: {count: 0, cont: 1}, maybe: {count: 0}}\n"
                         "inner: 5\n",
                         outer),
            (Lines{"w.yaml:2:21: vehicle 'auv1': joint 'left': 'x' must be a number, got 'a'",
                   "w.yaml:3:5: vehicle 'auv1': joint 2: missing key 'name'",
                   "w.yaml:4:34: vehicle 'auv1': joint 'right': inner: 'count' must be >= 1, got 0",
                   "w.yaml:4:37: vehicle 'auv1': joint 'right': inner: unknown key 'cont'; known keys: "
                   "count, joint; did "
                   "you mean 'count'?",
                   "w.yaml:4:62: vehicle 'auv1': joint 'right': maybe: 'count' must be >= 1, got 0",
                   "w.yaml:5:8: vehicle 'auv1': 'inner' must be a map, got '5'"}));
}

TEST(ParamReader, ReportsAListThatIsNone) {
  Outer outer;
  EXPECT_EQ(outer_errors("joints: {name: x}\n", outer),
            Lines{"w.yaml:1:9: vehicle 'auv1': 'joints' must be a list of maps, got {name: x}"});
  EXPECT_EQ(outer_errors("joints: [5, ~]\n", outer),
            (Lines{"w.yaml:1:10: vehicle 'auv1': item 1 of 'joints' must be a map, got '5'",
                   "w.yaml:1:13: vehicle 'auv1': item 2 of 'joints' must be a map, got nothing"}));
}

TEST(ParamReader, AKeyWithoutAValueIsAnEmptyListOrMap) {
  Outer outer;
  outer.joints.resize(2);
  EXPECT_EQ(outer_errors("joints:\ninner:\n", outer), Lines{});
  EXPECT_TRUE(outer.joints.empty());
  EXPECT_EQ(outer.inner.count, 1);
}

TEST(ParamReader, WithoutWhoAMessageStartsWithTheKey) {
  Diagnostics diagnostics;
  const ConfigNode node =
      sim::parse_config_text("joints: [{name: a, x: b}]\ninner: {count: 0}\n", "w.yaml", diagnostics);
  ParamReader in(node, "", diagnostics);
  Outer outer;
  outer.read(in);
  EXPECT_EQ(diagnostics.lines(), (Lines{"w.yaml:1:23: joint 'a': 'x' must be a number, got 'b'",
                                        "w.yaml:2:16: inner: 'count' must be >= 1, got 0"}));
}

// Names

TEST(ParamReader, ReportsANameThatNoOneHas) {
  Outer outer;
  EXPECT_EQ(outer_errors("joints: [{name: right}, {name: left}]\ninner: {joint: lft}\n", outer),
            Lines{"w.yaml:2:16: vehicle 'auv1': inner: 'joint' names no joint 'lft'; known joints: left, right"});
  Outer without_joints;
  EXPECT_EQ(outer_errors("inner: {joint: lft}\n", without_joints),
            Lines{"w.yaml:1:16: vehicle 'auv1': inner: 'joint' names no joint 'lft'; known joints: none"});
}

TEST(ParamReader, AnEmptyReferenceNamesNothing) {
  Outer outer;
  EXPECT_EQ(outer_errors("inner: {joint: ''}\n", outer), Lines{});
}

TEST(ParamReader, ListsOfReferencesAreCheckedItemByItem) {
  Lines bodies;
  const auto read = [&](ParamReader& in) {
    in.declare("body", "hull");
    in.read_references("x", bodies, "body", "");
  };
  EXPECT_EQ(errors_of("x: [hull, hall]\n", read), Lines{"1:11 'x' names no body 'hall'; known bodies: hull"});
  EXPECT_EQ(errors_of("x: [hull, hull]\n", read), Lines{});
  EXPECT_EQ(errors_of("x: hull\n", read), Lines{"1:4 'x' must be a list of text, got 'hull'"});
}

TEST(ParamReader, ReportsADuplicateNameWhereItIsWritten) {
  Outer outer;
  EXPECT_EQ(outer_errors("joints:\n  - name: left\n  - name: right\n  - name: left\ncategories: [a, b, a]\n", outer),
            (Lines{"w.yaml:5:20: vehicle 'auv1': duplicate category 'a'",
                   "w.yaml:4:11: vehicle 'auv1': duplicate joint 'left'"}));
}

TEST(ParamReader, AnInnerNameMayRepeatAnOuterOne) {
  EXPECT_EQ(errors_of("",
                      [](ParamReader& in) {
                        in.declare("joint", "b");
                        in.declare("joint", "a");
                        in.declare("joint", "");
                        EXPECT_EQ(in.declared("joint"), (Lines{"a", "b"}));
                        EXPECT_EQ(in.declared("body"), Lines{});
                      }),
            Lines{});
}

TEST(ParamReader, AHundredThousandNamesAreDeclaredSoon) {
  const Lines errors = errors_of("x: none\n", [](ParamReader& in) {
    for (int i = 0; i < 100000; ++i) in.declare("vehicle", "rover" + std::to_string(i));
    std::string value;
    in.read_reference("x", value, "vehicle", "");
  });
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_LT(errors[0].size(), 1000u);
  EXPECT_NE(errors[0].find(", ... (100000 in all)"), std::string::npos) << errors[0];
}

// Describing

TEST(ParamReader, ATypeThatContainsItselfIsRead) {
  Tree tree;
  EXPECT_EQ(errors_of("{name: a, branches: [{name: b, branches: [{name: c, nme: d}]}]}\n",
                      [&](ParamReader& in) { tree.read(in); }),
            Lines{"1:53 branch 'b': branch 'c': unknown key 'nme'; known keys: branches, name; did you mean "
                  "'name'?"});
  EXPECT_EQ(tree.branches.at(0).branches.at(0).name, "c");
}

}  // namespace
