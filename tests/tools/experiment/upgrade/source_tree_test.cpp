// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/source_tree.hpp"

#include <gmock/gmock.h>

namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using tools::SourceNode;
using tools::SourceText;

std::string text_of(const SourceText& source, const SourceNode& node) {
  return source.text().substr(node.span.begin, node.span.end - node.span.begin);
}

/// The text of the value of `key` at the top.
std::string written(const std::string& text, const char* key) {
  const SourceText source(text);
  EXPECT_FALSE(source.doubt()) << source.doubt()->what();
  return text_of(source, source.root().find(key)->value);
}

std::string doubt(const std::string& text) {
  const SourceText source(text);
  return source.doubt() ? source.doubt()->what() : "";
}

TEST(SourceTree, KnowsTheBytesOfEveryStyleOfScalar) {
  EXPECT_EQ(written("a: plain text  # c\n", "a"), "plain text");
  EXPECT_EQ(written("a: \"with \\\" quotes\" \n", "a"), "\"with \\\" quotes\"");
  EXPECT_EQ(written("a: 'it''s'\n", "a"), "'it''s'");
  EXPECT_EQ(written("a: |  # c\n  one\n\n  two\nb: 1\n", "a"), "|  # c\n  one\n\n  two\n");
  EXPECT_EQ(written("a: >-\n    one\n    two\n\n# c\nb: 1\n", "a"), ">-\n    one\n    two\n");
  EXPECT_EQ(written("a: one\n  two\n\n  three\nb: 1\n", "a"), "one\n  two\n\n  three");
  EXPECT_EQ(written("{a: one, b: 1}", "a"), "one");
  EXPECT_EQ(written("{a: {b: [1, 2], }, c: 1}", "a"), "{b: [1, 2], }");
  EXPECT_EQ(written("a: &x !!str 12\n", "a"), "12");
}

TEST(SourceTree, KnowsWhereNothingIsWritten) {
  EXPECT_EQ(written("a:\nb: 1\n", "a"), "");
  EXPECT_EQ(written("a: ~\nb: 1\n", "a"), "~");
  EXPECT_EQ(written("a: null\n", "a"), "null");
  EXPECT_EQ(written("a: [null, , ~]\n", "a"), "[null, , ~]");
  const SourceText source("a: 1\nb:  # nothing\n  # more\nc: 1\n");
  EXPECT_EQ(source.root().find("b")->value.span, (tools::TextSpan{7, 7}));
  EXPECT_THAT(source.comment_texts(), ElementsAre("# nothing", "# more"));
}

TEST(SourceTree, ABlockEndsWithItsLastNode) {
  EXPECT_EQ(written("a:\n  - b: 1\n    c: 2  # x\n  - d\n\n# end\n", "a"), "- b: 1\n    c: 2  # x\n  - d");
  EXPECT_EQ(written("a:\n- - x\n  - y\nb: 1\n", "a"), "- - x\n  - y");
}

TEST(SourceTree, FindsCommentsAndNothingElse) {
  const SourceText source("# top\na: 'x # y'  # one\nb: |\n  # text\nc: [1, # two\n  2]\nd: e#f\n");
  EXPECT_FALSE(source.doubt());
  EXPECT_THAT(source.comment_texts(), ElementsAre("# top", "# one", "# two"));
}

TEST(SourceTree, FollowsDocumentMarkersAndTheByteOrderMark) {
  EXPECT_EQ(written("%YAML 1.2\n--- # c\na: x\n...\n# end\n", "a"), "x");
  const SourceText source(
      "\xef\xbb\xbf"
      "a: x\r\nb: y\r\n");
  EXPECT_EQ(text_of(source, source.root().find("b")->value), "y");
  EXPECT_STREQ(source.line_break(), "\r\n");
  EXPECT_EQ(source.place(6, nullptr).column, 4);
  EXPECT_EQ(source.place(source.root().find("b")->value.span.begin, nullptr).line, 2);
}

TEST(SourceTree, AliasesLeadToWhatTheyName) {
  const SourceText source("a: &x [1, 2]\nb: *x\n");
  const SourceNode& alias = source.root().find("b")->value;
  EXPECT_EQ(alias.kind, SourceNode::Kind::alias);
  EXPECT_EQ(text_of(source, alias), "*x");
  EXPECT_EQ(alias.target, &source.root().find("a")->value);
  EXPECT_EQ(text_of(source, *alias.target), "[1, 2]");
}

TEST(SourceTree, SaysWhichFormsAreNotFollowed) {
  EXPECT_EQ(doubt("? a\n: 1\n"), "this form of YAML is not followed by 'shoal upgrade'");
  EXPECT_EQ(doubt("a: |2\n    x\n"), "'shoal upgrade' does not follow a block of text with an indentation indicator");
  EXPECT_EQ(doubt("{a, b: 1}"), "a key has no value");
}

TEST(SourceTree, AnEmptyTextHasNoNodes) {
  for (const char* text : {"", "\n", "# c\n", "---\n"}) {
    const SourceText source(text);
    EXPECT_FALSE(source.doubt()) << text;
    EXPECT_EQ(source.root().kind, SourceNode::Kind::null);
    EXPECT_THAT(source.root().entries, IsEmpty());
  }
}

}  // namespace
