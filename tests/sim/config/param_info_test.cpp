// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/param_info.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "sim/config/config_node.hpp"
#include "sim/config/param_reader.hpp"
#include "tests/sim/config/include_fixture.hpp"
#include "tests/sim/config/param_reader_fixture.hpp"

namespace {

using namespace param_reader_fixture;

TEST(Rule, SaysWhatItAllows) {
  EXPECT_EQ(sim::any_number().text(), "");
  EXPECT_EQ(sim::at_least(1).text(), ">= 1");
  EXPECT_EQ(sim::above(0).text(), "> 0");
  EXPECT_EQ(sim::at_most(100000).text(), "<= 100000");
  EXPECT_EQ(sim::between(0, 360).text(), ">= 0 and <= 360");
  EXPECT_EQ(sim::above_to(0, 0.5).text(), "> 0 and <= 0.5");
  EXPECT_EQ(sim::between(1, 1).text(), "1");
}

TEST(Rule, AllowsItsEndsUnlessTheyAreOpen) {
  EXPECT_TRUE(sim::at_least(1).allows(1));
  EXPECT_FALSE(sim::above(1).allows(1));
  EXPECT_TRUE(sim::at_most(1).allows(1));
  EXPECT_FALSE(sim::above_to(0, 1).allows(0));
  EXPECT_TRUE(sim::above_to(0, 1).allows(1));
  EXPECT_FALSE(sim::between(0, 1).allows(1.5));
}

using namespace include_fixture;

namespace fs = std::filesystem;

TEST_F(IncludeTest, TheIncludingFileLiesOverTheBase) {
  write("base.yaml", "a: 1\nm: {x: 1, y: [1, 2]}\n");
  write("w.yaml", "m: {y: [3], z: 4}\ninclude: base.yaml\nb: 2\n");
  EXPECT_EQ(sim::to_yaml(load("w.yaml")), "a: 1\nm:\n  x: 1\n  y: [3]\n  z: 4\nb: 2\n");
}

TEST_F(IncludeTest, NamedItemsMergeByName) {
  write("base.yaml", "v:\n  - {name: a, x: 1, y: 1}\n  - {name: b, x: 2}\n");
  write("w.yaml", "include: base.yaml\nv:\n  - {name: c, x: 3}\n  - {name: a, x: 9}\n");
  EXPECT_EQ(sim::to_yaml(load("w.yaml")),
            "v:\n  - name: a\n    x: 9\n    y: 1\n  - name: b\n    x: 2\n  - name: c\n    x: 3\n");
}

TEST_F(IncludeTest, ANameWrittenTwiceStaysADuplicate) {
  write("base.yaml", "v:\n  - {name: a, x: 1}\n");
  write("w.yaml", "include: base.yaml\nv:\n  - {name: a, x: 2}\n  - {name: a, x: 3}\n");
  EXPECT_EQ(load("w.yaml").find("v")->items.size(), 2u);
}

TEST_F(IncludeTest, ListsWithoutNamesAreReplaced) {
  write("base.yaml", "p: [{x: 1}, {x: 2}]\nv: [{name: a}]\n");
  write("w.yaml", "include: base.yaml\np: [{x: 3}]\nv: []\n");
  EXPECT_EQ(sim::to_yaml(load("w.yaml")), "p:\n  - x: 3\nv: []\n");
}

TEST_F(IncludeTest, LaterFilesOfAListLieOverEarlierOnes) {
  write("one.yaml", "a: 1\nb: 1\nc: 1\n");
  write("two.yaml", "b: 2\nc: 2\n");
  write("w.yaml", "include: [one.yaml, two.yaml]\nc: 3\n");
  EXPECT_EQ(sim::to_yaml(load("w.yaml")), "a: 1\nb: 2\nc: 3\n");
}

using sim::ParamInfo;

std::vector<ParamInfo> sample() {
  ParamInfo noise{"noise", "map", "", "{}", "error of each range", false, {}};
  noise.children = {{"bias", "number", "", "0", "constant offset", false, {}}};
  ParamInfo parts{"parts", "list of maps", "", "[]", "solids", false, {}};
  parts.children = {{"shape", "text", "one of: box, sphere", "box", "", false, {}}};
  return {{"file", "text", "", "", "a|b", true, {}},
          {"mass_kg", "number", "> 0", "~", "m\xc3\xa4ssig", false, {}},
          noise,
          parts};
}

TEST(ParamTable, IsATableInMarkdown) {
  EXPECT_EQ(sim::markdown_table(sample()),
            "| key | type | rule | default | meaning |\n"
            "|---|---|---|---|---|\n"
            "| `file` | text |  | required | a\\|b |\n"
            "| `mass_kg` | number | \\> 0 | unset | m\xc3\xa4ssig |\n"
            "| `noise` | map |  | `{}` | error of each range |\n"
            "| `noise.bias` | number |  | `0` | constant offset |\n"
            "| `parts` | list of maps |  | `[]` | solids |\n"
            "| `parts[].shape` | text | one of: box, sphere | `box` |  |\n");
}

TEST(ParamTable, IsAlignedForATerminal) {
  EXPECT_EQ(sim::text_table(sample()),
            "key            type          rule                 default   meaning\n"
            "file           text                               required  a|b\n"
            "mass_kg        number        > 0                  unset     m\xc3\xa4ssig\n"
            "noise          map                                {}        error of each range\n"
            "noise.bias     number                             0         constant offset\n"
            "parts          list of maps                       []        solids\n"
            "parts[].shape  text          one of: box, sphere  box\n");
}

TEST(ParamTable, OfNothingIsAHeader) {
  EXPECT_EQ(sim::text_table({}), "key  type  rule  default  meaning\n");
}

}  // namespace
