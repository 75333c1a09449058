// SPDX-License-Identifier: BSD-3-Clause
#include "messages/shoal/lcm_parser.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "shoal/message_schema.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace shoal;

MessageTypes types_of(const std::string& text) {
  const std::vector<LcmSource> sources{{"test.lcm", text}};
  return MessageTypes(sources);
}

std::string parse_error(const std::string& text) {
  try {
    types_of(text);
  } catch (const MessageError& error) {
    return error.what();
  }
  return "no error";
}

// The hash of lcm-gen -p, for enums, types in types, and types that contain themselves.
TEST(MessageSchema, FingerprintsOfNestedAndRecursiveTypesAreThoseOfLcmGen) {
  const MessageTypes types = types_of(
      "package q;\n"
      "enum color_t { RED=0, GREEN=1 }\n"
      "struct uses_t { color_t c; int32_t n; double a, b[3]; color_t d[n]; }\n"
      "struct rec_t { int32_t n; rec_t kids[n]; }\n"
      "struct empty_t { const int32_t A = 1, B=0x10; const double D=1.5; }\n");
  const auto rotated = [](std::uint64_t h) { return (h << 1) + (h >> 63); };
  const std::uint64_t color = 0x7636f6d82a7e5b6;
  EXPECT_EQ(types.find("q.color_t")->fingerprint, color);
  EXPECT_EQ(types.find("q.uses_t")->fingerprint, rotated(0x4f92695aecd4332d + 2 * color));
  EXPECT_EQ(types.find("q.rec_t")->fingerprint, rotated(0x90afa2d13a5ee21c));
  EXPECT_EQ(types.find("q.empty_t")->fingerprint, rotated(0x12345678));
}

TEST(MessageSchema, ErrorsOfLcmFilesSayWhere) {
  EXPECT_EQ(parse_error("package a;\nstruct b_t {\n  double x[n];\n}"),
            "test.lcm:3:12: array size 'n' is not a member declared before");
  EXPECT_EQ(parse_error("struct b_t { double n; float x[n]; }"),
            "test.lcm:1:32: array size 'n' must be a plain integer member");
  EXPECT_EQ(parse_error("struct b_t { double x }"), "test.lcm:1:23: expected ';', got '}'");
  EXPECT_EQ(parse_error("struct b_t { double x; float x; }"), "test.lcm:1:30: duplicate member 'x'");
  EXPECT_EQ(parse_error("struct b_t { c_t x; }"), "type b_t: member 'x' has the unknown type c_t");
  EXPECT_EQ(parse_error("struct b_t { b_t x; }"), "type b_t contains itself");
  EXPECT_EQ(parse_error("struct b_t { double x[0]; }"),
            "test.lcm:1:23: array size must be between 1 and 16777216, got 0");
  EXPECT_EQ(parse_error("struct b_t { /* double x; }"), "test.lcm:1:12: comment without end");
  EXPECT_EQ(parse_error("class b_t { }"), "test.lcm:1:1: expected 'package', 'struct' or 'enum', got 'class'");
  EXPECT_NE(parse_error("struct b_t {"), "no error");
  EXPECT_NE(parse_error("struct b_t { const int32_t A = "), "no error");
  EXPECT_NE(parse_error("enum b_t { A"), "no error");
  EXPECT_EQ(parse_error("struct a_t {}\nstruct a_t {}"), "test.lcm: duplicate type a_t");
}

TEST(MessageSchema, ReadsLcmFilesOfTheUser) {
  const lcm_test::ScratchFolder folder;
  std::ofstream(folder.file("own.lcm")) << "package own;\nstruct dvl_t { shoal.pose_t pose; double btv[4]; }\n";
  const MessageTypes types = types_with({folder.file("own.lcm")});
  ASSERT_NE(types.find("own.dvl_t"), nullptr);
  EXPECT_EQ(types.find("own.dvl_t")->members[0].compound, types.find("shoal.pose_t"));
  EXPECT_THROW(types_with({folder.file("missing.lcm")}), MessageError);
}

}  // namespace
