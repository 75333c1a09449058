// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/merged_keys.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "sim/config/config_node.hpp"
#include "tests/sim/config/include_fixture.hpp"

namespace {

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

}  // namespace
