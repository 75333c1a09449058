// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <ctime>
#include <random>
#include <string>

#include "sim/config/config_node.hpp"
#include "tests/sim/config/parse.hpp"

namespace {

using sim::ConfigNode;
using sim::Diagnostics;
using Kind = ConfigNode::Kind;

using test::parse;

/// All errors, one a line.
std::string errors_of(const std::string& text) {
  Diagnostics diagnostics;
  const ConfigNode node = sim::parse_config_text(text, "w.yaml", diagnostics);
  if (!diagnostics.ok()) {
    EXPECT_EQ(node.kind, Kind::null) << text;
  }
  std::string joined;
  for (const std::string& line : diagnostics.lines()) joined += (joined.empty() ? "" : "\n") + line;
  return joined;
}

TEST(YamlParser, ReadsMapsListsAndScalarsInOrder) {
  const ConfigNode root = parse("b: 1\na: [x, 'y', 2]\nc:\n  d: {e: f}\n");
  ASSERT_EQ(root.kind, Kind::map);
  ASSERT_EQ(root.entries.size(), 3u);
  EXPECT_EQ(root.entries[0].key, "b");
  EXPECT_EQ(root.entries[1].key, "a");
  ASSERT_EQ(root.find("a")->items.size(), 3u);
  EXPECT_EQ(root.find("a")->items[1].scalar, "y");
  EXPECT_EQ(root.find("c")->find("d")->find("e")->scalar, "f");
  EXPECT_EQ(root.find("nothing"), nullptr);
}

TEST(YamlParser, CountsLinesAndColumnsFromOne) {
  const ConfigNode root = parse("# a comment\nname:  harbor\nlist:\n  - key: 5\n");
  EXPECT_EQ(root.find("name")->place.text(), "w.yaml:2:8");
  EXPECT_EQ(root.entries[1].place.text(), "w.yaml:3:1");
  const ConfigNode& item = root.find("list")->items[0];
  EXPECT_EQ(item.place.text(), "w.yaml:4:5");
  EXPECT_EQ(item.entries[0].place.text(), "w.yaml:4:5");
  EXPECT_EQ(item.find("key")->place.text(), "w.yaml:4:10");
}

TEST(YamlParser, CountsLinesThatEndAsOnWindows) {
  EXPECT_EQ(parse("a: 1\r\nb: 2\r\n").find("b")->place.text(), "w.yaml:2:4");
}

TEST(YamlParser, KnowsQuotedFromPlain) {
  const ConfigNode root = parse("a: 5\nb: '5'\nc: \"5\"\nd: |\n  5\ne: !!str 5\n");
  EXPECT_FALSE(root.find("a")->quoted);
  for (const char* key : {"b", "c", "d", "e"}) EXPECT_TRUE(root.find(key)->quoted) << key;
  EXPECT_EQ(root.find("d")->scalar, "5\n");
}

TEST(YamlParser, PlainNullAndNothingAreNull) {
  const ConfigNode root = parse("a: ~\nb: null\nc:\nd: 'null'\ne: [~, '']\n");
  for (const char* key : {"a", "b", "c"}) EXPECT_EQ(root.find(key)->kind, Kind::null) << key;
  EXPECT_EQ(root.find("d")->kind, Kind::scalar);
  EXPECT_EQ(root.find("e")->items[0].kind, Kind::null);
  EXPECT_EQ(root.find("e")->items[1].kind, Kind::scalar);
}

TEST(YamlParser, AnEmptyTextIsNullAndNoError) {
  EXPECT_EQ(parse("").kind, Kind::null);
  EXPECT_EQ(parse("# only a comment\n").kind, Kind::null);
}

TEST(YamlParser, AnAliasIsACopyThatKeepsItsPlace) {
  const ConfigNode root = parse("a: &wheel {r: 0.1}\nb: *wheel\n");
  EXPECT_EQ(root.find("b")->find("r")->scalar, "0.1");
  EXPECT_EQ(root.find("b")->find("r")->place.text(), "w.yaml:1:15");
}

TEST(YamlParser, ReportsADuplicateKey) {
  EXPECT_EQ(errors_of("x: 1\ny: 2\nx: 3\n"), "w.yaml:3:1: duplicate key 'x', first at line 1");
}

TEST(YamlParser, ReportsEveryDuplicateKey) {
  EXPECT_EQ(errors_of("x: 1\nx: 3\nm: {y: 1, y: 2}\n"),
            "w.yaml:2:1: duplicate key 'x', first at line 1\nw.yaml:3:11: duplicate key 'y', first at line 3");
}

TEST(YamlParser, RefusesMergeKeys) {
  EXPECT_EQ(errors_of("a: &a {x: 1}\nb:\n  <<: *a\n"),
            "w.yaml:3:3: merge keys ('<<') are not supported; use include, overrides or parameters");
}

TEST(YamlParser, RefusesKeysThatAreNoText) {
  EXPECT_EQ(errors_of("[a, b]: 1\n"), "w.yaml:1:1: a key must be text, got a list");
  EXPECT_EQ(errors_of("? {a: b}\n: 1\n"), "w.yaml:1:3: a key must be text, got a map");
  EXPECT_EQ(errors_of("~: 1\n"), "w.yaml:1:1: a key must be text, got nothing");
  EXPECT_EQ(errors_of("a: &x y\n*x : 1\n"), "w.yaml:2:1: a key must be text, got an alias");
}

TEST(YamlParser, RefusesASecondDocument) {
  EXPECT_EQ(errors_of("a: 1\n---\nb: 2\n"), "w.yaml:2:1: a second YAML document; a file holds one");
  EXPECT_EQ(errors_of("---\na: 1\n...\n"), "");
}

TEST(YamlParser, RefusesTags) {
  EXPECT_EQ(errors_of("a: !robot x\n"), "w.yaml:1:4: the tag '!robot' is not supported");
  EXPECT_EQ(errors_of("a: !!binary x\n"), "w.yaml:1:4: the tag '!!binary' is not supported");
}

TEST(YamlParser, RefusesAnAliasInsideItself) {
  EXPECT_EQ(errors_of("a: &a [1, *a]\n"), "w.yaml:1:11: an alias inside the node it stands for");
}

TEST(YamlParser, ReportsASyntaxErrorWithItsPlace) {
  EXPECT_EQ(errors_of("a: 1\nb: [1, 2\nc: 3\n"), "w.yaml:3:2: not valid YAML: end of sequence flow not found");
  EXPECT_EQ(errors_of("a: b: c\n"), "w.yaml:1:5: not valid YAML: illegal map value");
  EXPECT_EQ(errors_of("a: 1\nname shoal\nrun: 2\n"),
            "w.yaml:3:4: not valid YAML: illegal map value; line 2 has no colon");
  EXPECT_EQ(errors_of("points: [[1, 2],\n  [3, 4]]\nname: a: b\n"), "w.yaml:3:8: not valid YAML: illegal map value");
  EXPECT_EQ(errors_of("a: *nowhere\n"), "w.yaml:1:4: not valid YAML: the referenced anchor is not defined");
}

TEST(YamlParser, RefusesBytesThatAreNoText) {
  EXPECT_EQ(errors_of(std::string("a: b\nc: \0d\n", 11)), "w.yaml:2:4: control character 0x00; is this a text file?");
  EXPECT_EQ(errors_of("a: \x04\n"), "w.yaml:1:4: control character 0x04; is this a text file?");
  // A lone continuation byte, a cut character, the overlong slash, a surrogate, beyond U+10FFFF.
  for (const char* bad : {"\x80", "\xe2\x82", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff\xfe"})
    EXPECT_EQ(errors_of(std::string("a: ") + bad), "w.yaml:1:4: not valid UTF-8; is this a text file?");
}

TEST(YamlParser, TakesTextOfAllLengthsOfUtf8) {
  EXPECT_EQ(parse("a: \xc3\xa9\xe2\x82\xac\xf0\x9f\x90\x9f\n").find("a")->scalar,
            "\xc3\xa9\xe2\x82\xac\xf0\x9f\x90\x9f");
  EXPECT_EQ(parse("\xef\xbb\xbf"
                  "a: 1\n")
                .find("a")
                ->scalar,
            "1");  // a byte order mark
}

TEST(YamlParser, NestsAHundredDeepAndNoDeeper) {
  const auto nested = [](int depth) {
    return "a: " + std::string(static_cast<std::size_t>(depth), '[') +
           std::string(static_cast<std::size_t>(depth), ']');
  };
  EXPECT_EQ(errors_of(nested(99)), "");  // the map around it is the hundredth
  EXPECT_EQ(errors_of(nested(100)), "w.yaml:1:103: nested more than 100 deep");
  EXPECT_EQ(errors_of(nested(9000)), "w.yaml:1:103: nested more than 100 deep");
  EXPECT_EQ(errors_of(nested(20000)), "w.yaml:1:10004: more than 10000 brackets are never closed");
  std::string dashes;
  for (int i = 0; i < 20000; ++i) dashes += "- ";
  EXPECT_EQ(errors_of(dashes), "w.yaml:1:201: nested more than 100 deep");
}

TEST(YamlParser, AliasesCannotNestDeeperEither) {
  std::string text = "k0: &a0 [1]\n";
  for (int i = 1; i < 200; ++i)
    text += "k" + std::to_string(i) + ": &a" + std::to_string(i) + " [*a" + std::to_string(i - 1) + "]\n";
  // k98 holds 99 lists, with the map around them a hundred; k99 is one too many.
  EXPECT_EQ(errors_of(text), "w.yaml:100:12: nested more than 100 deep");
}

/// Ten aliases of ten aliases of ... : 10^levels values from a few lines.
std::string alias_bomb(int levels) {
  std::string text = "l0: &l0 x\n";
  for (int level = 1; level <= levels; ++level) {
    const std::string name = "l" + std::to_string(level);
    text += name + ": &" + name + " [";
    for (int i = 0; i < 10; ++i) text += (i > 0 ? ", *l" : "*l") + std::to_string(level - 1);
    text += "]\n";
  }
  return text;
}

/// Processor time of this process, which other programs do not lengthen.
double cpu_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

TEST(YamlParser, AnAliasBombEndsInOneErrorSoon) {
  const double start_s = cpu_s();
  const std::string errors = errors_of(alias_bomb(20));
  EXPECT_NE(errors.find("more than 2000000 values or 256 MB of text, aliases expanded"), std::string::npos) << errors;
  EXPECT_EQ(errors.find('\n'), std::string::npos);
  EXPECT_LT(cpu_s() - start_s, 10.0);  // 0.1 s; a sanitizer is some 50 times slower
}

TEST(YamlParser, AnAliasOfALongTextCannotFillTheMemory) {
  std::string text = "a: &a " + std::string(1000000, 'x') + "\nb: [";
  for (int i = 0; i < 1000; ++i) text += "*a, ";
  EXPECT_NE(errors_of(text + "]\n").find("more than 2000000 values or 256 MB of text"), std::string::npos);
}

TEST(YamlParser, TenMegabytesOfGarbageEndInAnErrorSoon) {
  std::mt19937 random(1);
  std::string bytes(10'000'000, ' ');
  for (char& byte : bytes) byte = static_cast<char>(random());
  const double start_s = cpu_s();
  EXPECT_NE(errors_of(bytes), "");
  EXPECT_NE(errors_of(std::string(10'000'000, '[')), "");
  EXPECT_LT(cpu_s() - start_s, 10.0);  // 0.1 s; a sanitizer is some 50 times slower
}

const char* const document =
    "# a world\nshoal: 1\nname: \"har\\u00e9bor\"\nlist: [1, {a: b}, 'it''s', *x]\nwheel: &w\n  - r: 0.1\n   "
    " w: ~\n  - *w\n"
    "text: |\n  two\n  lines\nfolded: >-\n  one\n  line\n? key\n: \xe2\x82\xac\n!!str tagged: !!map {x: y}\n";

TEST(YamlParser, ATextCutAnywhereDoesNotCrash) {
  const std::string text = document;
  for (std::size_t length = 0; length <= text.size(); ++length) {
    Diagnostics diagnostics;
    sim::parse_config_text(text.substr(0, length), "w.yaml", diagnostics);
  }
}

TEST(YamlParser, RandomTextOfYamlSignsDoesNotCrash) {
  const std::string signs = "[]{}:,-?&*!|>'\"%#~ \n\t\\ab1<";
  std::mt19937 random(2);
  for (int round = 0; round < 3000; ++round) {
    std::string text(random() % 200, ' ');
    for (char& c : text) c = signs[random() % signs.size()];
    Diagnostics diagnostics;
    const ConfigNode node = sim::parse_config_text(text, "w.yaml", diagnostics);
    if (!diagnostics.ok()) continue;
    Diagnostics again;
    sim::parse_config_text(sim::to_yaml(node), "w.yaml", again);
    EXPECT_TRUE(again.ok()) << text << "\nbecame\n" << sim::to_yaml(node);
  }
}

TEST(YamlParser, ASampleWithAChangedByteDoesNotCrash) {
  std::mt19937 random(3);
  for (int round = 0; round < 3000; ++round) {
    std::string text = document;
    for (int i = 0; i < 3; ++i) text[random() % text.size()] = static_cast<char>(random() % 128);
    Diagnostics diagnostics;
    sim::parse_config_text(text, "w.yaml", diagnostics);
  }
}

}  // namespace
