// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

#include "sim/config/config_node.hpp"

namespace {

using sim::ConfigNode;
using sim::Diagnostics;
using Kind = ConfigNode::Kind;

bool same_tree(const ConfigNode& a, const ConfigNode& b) {
  if (a.kind != b.kind || a.quoted != b.quoted || a.scalar != b.scalar || a.items.size() != b.items.size() ||
      a.entries.size() != b.entries.size())
    return false;
  for (std::size_t i = 0; i < a.items.size(); ++i)
    if (!same_tree(a.items[i], b.items[i])) return false;
  for (std::size_t i = 0; i < a.entries.size(); ++i)
    if (a.entries[i].key != b.entries[i].key || !same_tree(a.entries[i].value, b.entries[i].value)) return false;
  return true;
}

ConfigNode parse(const std::string& text, Diagnostics& diagnostics) {
  return sim::parse_config_text(text, "w.yaml", diagnostics);
}

ConfigNode scalar(const std::string& text, bool quoted) {
  ConfigNode node;
  node.kind = Kind::scalar;
  node.scalar = text;
  node.quoted = quoted;
  return node;
}

std::string arbitrary_text() {
  // Signs that mean something in YAML, controls, letters, and characters of 2 to 4 bytes; U+0085 and U+FEFF
  // are line break and byte order mark to some readers.
  static const std::vector<std::string> pieces = {"a",
                                                  "b",
                                                  "0",
                                                  "1",
                                                  ".",
                                                  "-",
                                                  ":",
                                                  ": ",
                                                  " #",
                                                  "#",
                                                  " ",
                                                  "  ",
                                                  "\n",
                                                  "\t",
                                                  "\r",
                                                  "\"",
                                                  "'",
                                                  "\\",
                                                  "[",
                                                  "]",
                                                  "{",
                                                  "}",
                                                  ",",
                                                  "&",
                                                  "*",
                                                  "!",
                                                  "|",
                                                  ">",
                                                  "%",
                                                  "@",
                                                  "`",
                                                  "?",
                                                  "? ",
                                                  "- ",
                                                  "~",
                                                  "<<",
                                                  "null",
                                                  "---",
                                                  "...",
                                                  std::string(1, '\0'),
                                                  "\x1b",
                                                  "\x7f",
                                                  "\xc3\xa9",
                                                  "\xc2\x85",
                                                  "\xe2\x80\xa8",
                                                  "\xef\xbb\xbf",
                                                  "\xf0\x9f\x90\x9f",
                                                  "${x}"};
  const auto chosen = *rc::gen::container<std::vector<std::string>>(rc::gen::elementOf(pieces));
  std::string text;
  for (const std::string& piece : chosen) text += piece;
  return text;
}

ConfigNode arbitrary_tree(int depth) {
  const int choice = *rc::gen::inRange(0, depth > 0 ? 6 : 4);
  ConfigNode node;
  if (choice == 0) return node;
  if (choice == 1)
    return scalar(*rc::gen::elementOf(std::vector<std::string>{"1.5", "-3", "true", "auv1", "a b"}), false);
  if (choice <= 3) return scalar(arbitrary_text(), true);
  const int size = *rc::gen::inRange(0, 5);
  node.kind = choice == 4 ? Kind::list : Kind::map;
  for (int i = 0; i < size; ++i) {
    ConfigNode child = arbitrary_tree(depth - 1);
    if (node.kind == Kind::list) {
      node.items.push_back(std::move(child));
      continue;
    }
    std::string key = arbitrary_text();
    if (*rc::gen::inRange(0, 20) == 0) key += std::string(1500, 'k');
    if (node.find(key) == nullptr) node.entries.push_back({key, {}, std::move(child)});
  }
  return node;
}

TEST(YamlWriter, AnyTreeParsesToTheSameTree) {
  EXPECT_TRUE(rc::check("to_yaml round trip", [] {
    const ConfigNode tree = arbitrary_tree(4);
    const std::string text = sim::to_yaml(tree);
    Diagnostics diagnostics;
    const ConfigNode again = parse(text, diagnostics);
    RC_LOG() << text << "\n";
    for (const std::string& line : diagnostics.lines()) RC_LOG() << line << "\n";
    RC_ASSERT(diagnostics.ok());
    RC_ASSERT(same_tree(tree, again));
  }));
}

TEST(YamlWriter, WhatWasParsedIsWrittenTheSameWayTwice) {
  EXPECT_TRUE(rc::check("to_yaml is stable", [] {
    Diagnostics diagnostics;
    const std::string text = sim::to_yaml(arbitrary_tree(4));
    RC_ASSERT(sim::to_yaml(parse(text, diagnostics)) == text);
  }));
}

TEST(YamlWriter, WritesAsAPersonWould) {
  const std::string text =
      "shoal: 1\n"
      "name: harbor\n"
      "empty: {}\n"
      "nothing: ~\n"
      "vehicles:\n"
      "  - name: auv1\n"
      "    position_m: [0, 1.5, -2]\n"
      "    devices:\n"
      "      - name: \"5\"\n"
      "matrix: [[1, 0], [0, 1]]\n"
      "time: 12:30\n";
  Diagnostics diagnostics;
  EXPECT_EQ(sim::to_yaml(parse(text, diagnostics)), text);
  EXPECT_TRUE(diagnostics.ok());
}

TEST(YamlWriter, LongListsStandOneItemALine) {
  ConfigNode list;
  list.kind = Kind::list;
  for (int i = 0; i < 30; ++i) list.items.push_back(scalar("1.25", false));
  const std::string text = sim::to_yaml(list);
  EXPECT_EQ(text.substr(0, 14), "- 1.25\n- 1.25\n");
}

TEST(YamlWriter, PlainTextThatFlowWouldSplitKeepsItsForm) {
  Diagnostics diagnostics;
  const ConfigNode tree = parse("list:\n  - a, b\n  - ${x}\n  - c\n", diagnostics);
  EXPECT_TRUE(same_tree(tree, parse(sim::to_yaml(tree), diagnostics))) << sim::to_yaml(tree);
}

TEST(YamlWriter, OneLineStopsAtItsLimit) {
  ConfigNode list;
  list.kind = Kind::list;
  list.items.assign(100000, scalar("1", false));
  EXPECT_LT(sim::to_flow_yaml(list, 50).size(), 100u);
  Diagnostics diagnostics;
  EXPECT_EQ(sim::to_flow_yaml(parse("a: [1, x]\nb: {c: ~}\n", diagnostics)), "{a: [1, x], b: {c: ~}}");
}

}  // namespace
