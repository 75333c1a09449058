// SPDX-License-Identifier: BSD-3-Clause
#include "shoal/message_schema.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace shoal {
namespace {

using lcm_test::PayloadBuilder;

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

std::string error_of(const MessageSchema& schema, const sim::Bytes& payload, Finite finite = Finite::any) {
  return validate(schema, payload, finite).value_or("");
}

/// A payload from fingerprint and the bytes behind it.
sim::Bytes payload_of(const MessageSchema& schema, std::initializer_list<int> rest) {
  sim::Bytes payload;
  for (int shift = 56; shift >= 0; shift -= 8) payload.push_back(static_cast<std::byte>(schema.fingerprint >> shift));
  for (const int byte : rest) payload.push_back(static_cast<std::byte>(byte));
  return payload;
}

TEST(MessageSchema, FingerprintsAreTheKnownOnesOfBotCore) {
  const std::vector<std::pair<std::string, std::uint64_t>> golden{
      {"pose_t", 0x2e16efb052b0105e},
      {"planar_lidar_t", 0xe3d17423180b5e8d},
      {"rigid_transform_t", 0xea9ffbf2acc5c5ae},
      {"raw_t", 0x30571b45b804c18e},
      {"image_t", 0x14739ffe13d5f5f0},
      {"joint_state_t", 0x3e377b4cebc593a4},
      {"utime_t", 0x4d0d41c1f105b12f},
      {"gps_data_t", 0xd7d20e1e68a41516},
  };
  for (const auto& [name, fingerprint] : golden) {
    const MessageSchema* schema = embedded_types().find("shoal." + name);
    ASSERT_NE(schema, nullptr) << name;
    EXPECT_EQ(schema->fingerprint, fingerprint) << name;
  }
}

TEST(MessageSchema, FindsTypesByNameAndByFingerprint) {
  const MessageSchema* pose = embedded_types().find("shoal.pose_t");
  ASSERT_NE(pose, nullptr);
  EXPECT_EQ(embedded_types().find(std::uint64_t{0x2e16efb052b0105e}), pose);
  EXPECT_EQ(embedded_types().find("shoal.nothing_t"), nullptr);
  EXPECT_EQ(embedded_types().find(std::uint64_t{1}), nullptr);
  EXPECT_EQ(embedded_types().find("pose_t", pose->fingerprint), pose);
  EXPECT_EQ(embedded_types().find("pose_t", 1), nullptr);
  EXPECT_EQ(embedded_types().find("ose_t", pose->fingerprint), nullptr);
  EXPECT_EQ(pose->min_size, 8u + 16 * 8);
  EXPECT_EQ(pose->members.front().comment, "epoch + simulated time, us");
  EXPECT_NE(pose->comment.find("Equal on the wire"), std::string::npos);
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

TEST(PayloadWalker, SaysWhatIsTooShort) {
  const MessageSchema& pose = *embedded_types().find("shoal.pose_t");
  sim::Bytes payload = PayloadBuilder(1).build(pose);
  EXPECT_EQ(error_of(pose, payload), "");
  payload.resize(16);
  EXPECT_EQ(error_of(pose, payload),
            "payload of 16 bytes is too short for shoal.pose_t: field 'pos' needs 24 more bytes");
  payload.resize(12);
  EXPECT_EQ(error_of(pose, payload),
            "payload of 12 bytes is too short for shoal.pose_t: field 'utime' needs 4 more bytes");
  payload.resize(7);
  EXPECT_EQ(error_of(pose, payload), "payload of 7 bytes is too short for any message");
  EXPECT_EQ(error_of(pose, {}), "payload of 0 bytes is too short for any message");
}

TEST(PayloadWalker, SaysWhichTypeItIsNot) {
  const MessageSchema& twist = *embedded_types().find("shoal.twist_command_t");
  const std::string error = error_of(twist, PayloadBuilder(1).build(*embedded_types().find("shoal.pose_t")));
  EXPECT_TRUE(error.starts_with("fingerprint 0x2e16efb052b0105e is not shoal.twist_command_t (0x")) << error;
}

TEST(PayloadWalker, RefusesTrailingBytes) {
  const MessageSchema& utime = *embedded_types().find("shoal.utime_t");
  sim::Bytes payload = PayloadBuilder(1).build(utime);
  payload.resize(19);
  EXPECT_EQ(error_of(utime, payload),
            "payload of 19 bytes is too long for shoal.utime_t: 3 bytes follow the last field");
}

TEST(PayloadWalker, RefusesNanAndInfinityWhereFiniteIsRequired) {
  const MessageTypes types = types_of("struct b_t { float f; double d[2][2]; }");
  const MessageSchema& schema = *types.find("b_t");
  sim::Bytes payload = payload_of(schema, {0x7f, 0xc0, 0, 0});
  payload.resize(8 + 4 + 32);
  EXPECT_EQ(error_of(schema, payload), "");
  EXPECT_EQ(error_of(schema, payload, Finite::required), "field 'f' must be finite, got nan");
  payload[8] = payload[9] = std::byte{0};
  EXPECT_EQ(error_of(schema, payload, Finite::required), "");
  payload[12 + 16] = std::byte{0xff};  // d[1][0] = -inf
  payload[12 + 17] = std::byte{0xf0};
  EXPECT_EQ(error_of(schema, payload, Finite::required), "field 'd[1][0]' must be finite, got -inf");
}

TEST(PayloadWalker, RefusesBadArrayLengths) {
  const MessageTypes types = types_of("struct b_t { int32_t n; double x[n]; int8_t k; byte y[k][n]; }");
  const MessageSchema& schema = *types.find("b_t");
  EXPECT_EQ(error_of(schema, payload_of(schema, {0xff, 0xff, 0xff, 0xff})), "field 'x' has a negative size, -1 ('n')");
  EXPECT_EQ(error_of(schema, payload_of(schema, {0x7f, 0xff, 0xff, 0xff})),
            "payload of 12 bytes is too short for b_t: field 'x' needs 17179869176 more bytes");
  EXPECT_EQ(error_of(schema, payload_of(schema, {0, 0, 0, 0, 0})), "");
  EXPECT_EQ(error_of(schema, payload_of(schema, {0, 0, 0, 0, 0x80})), "field 'y' has a negative size, -128 ('k')");
}

// A decoder makes the outer vectors before it looks at the inner size: 2^31 of them for a message of 16
// bytes.
TEST(PayloadWalker, RefusesArraysThatAreLargeWithoutAnyBytes) {
  const MessageTypes types = types_of(
      "struct empty_t {}\n"
      "struct rows_t { int32_t a; int32_t b; double x[a][b]; }\n"
      "struct empties_t { int32_t n; empty_t x[n]; }\n"
      "struct cube_t { int64_t a; int64_t b; double x[a][b][a][b]; }\n");
  const MessageSchema& rows = *types.find("rows_t");
  EXPECT_EQ(error_of(rows, payload_of(rows, {0x7f, 0, 0, 0, 0, 0, 0, 0})), "field 'x' has 2130706432 empty rows");
  EXPECT_EQ(error_of(rows, payload_of(rows, {0, 0, 1, 0, 0, 0, 0, 0})), "");
  EXPECT_EQ(error_of(rows, payload_of(rows, {0, 0, 0, 0, 0x7f, 0, 0, 0})), "");  // no row at all
  const MessageSchema& empties = *types.find("empties_t");
  EXPECT_EQ(error_of(empties, payload_of(empties, {0x7f, 0, 0, 0})), "field 'x' has 2130706432 empty elements");
  const MessageSchema& cube = *types.find("cube_t");
  EXPECT_NE(error_of(cube, payload_of(cube, {0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0})), "");
}

TEST(PayloadWalker, RefusesBadStrings) {
  const MessageTypes types = types_of("struct in_t { string s; } struct b_t { int8_t n; in_t a[n]; }");
  const MessageSchema& schema = *types.find("b_t");
  EXPECT_EQ(error_of(schema, payload_of(schema, {1, 0, 0, 0, 3, 'a', 'b', 0})), "");
  EXPECT_EQ(error_of(schema, payload_of(schema, {1, 0, 0, 0, 3, 'a', 'b', 'c'})),
            "field 'a[0].s' is a string without a final NUL");
  EXPECT_EQ(error_of(schema, payload_of(schema, {1, 0, 0, 0, 0, 0})),
            "field 'a[0].s' has the string length 0, must be >= 1");
  EXPECT_EQ(error_of(schema, payload_of(schema, {1, 0xff, 0, 0, 0, 0})),
            "field 'a[0].s' has the string length -16777216, must be >= 1");
  EXPECT_EQ(error_of(schema, payload_of(schema, {1, 0, 0, 0, 9, 'a', 0})),
            "payload of 15 bytes is too short for b_t: field 'a[0].s' needs 7 more bytes");
}

TEST(PayloadWalker, StopsAtTypesThatNestWithoutEnd) {
  const MessageTypes types = types_of("struct rec_t { int8_t n; rec_t kids[n]; }");
  const MessageSchema& schema = *types.find("rec_t");
  sim::Bytes payload = payload_of(schema, {});
  payload.resize(8 + 1'000'000, std::byte{1});
  EXPECT_NE(error_of(schema, payload).find("is nested deeper than 32"), std::string::npos) << error_of(schema, payload);
  EXPECT_EQ(error_of(schema, payload_of(schema, {1, 1, 0})), "");
}

TEST(PayloadWalker, ShowsEveryFieldWithItsIndices) {
  const MessageTypes types = types_of(
      "struct in_t { string key; boolean on; }\n"
      "struct b_t { int16_t n; in_t a[n]; float f[2]; byte raw[n]; byte one; }\n");
  const MessageSchema& schema = *types.find("b_t");
  const sim::Bytes payload = payload_of(schema, {0, 1, 0, 0, 0, 2, 'k', 0, 1, 0x3f, 0x80, 0, 0, 0xc0, 0, 0, 0, 7, 200});
  std::string shown;
  const auto error = visit_fields(schema, payload, [&](std::string_view name, const FieldValue& value) {
    shown += std::string(name) + "=";
    if (const auto* b = std::get_if<bool>(&value)) shown += *b ? "true" : "false";
    if (const auto* i = std::get_if<std::int64_t>(&value)) shown += std::to_string(*i);
    if (const auto* d = std::get_if<double>(&value)) shown += std::to_string(static_cast<int>(*d)) + ".";
    if (const auto* s = std::get_if<std::string_view>(&value)) shown += "'" + std::string(*s) + "'";
    if (const auto* x = std::get_if<std::span<const std::byte>>(&value)) shown += std::to_string(x->size()) + " bytes";
    shown += " ";
  });
  EXPECT_EQ(error.value_or(""), "");
  EXPECT_EQ(shown, "n=1 a[0].key='k' a[0].on=true f[0]=1. f[1]=-2. raw=1 bytes one=200 ");
}

TEST(PayloadWalker, ShowsNothingOfABadPayload) {
  const MessageSchema& pose = *embedded_types().find("shoal.pose_t");
  sim::Bytes payload = PayloadBuilder(1).build(pose);
  payload.pop_back();
  int shown = 0;
  EXPECT_TRUE(visit_fields(pose, payload, [&](std::string_view, const FieldValue&) { ++shown; }).has_value());
  EXPECT_EQ(shown, 0);
}

TEST(PayloadWalker, RefusesEveryTruncationOfEveryType) {
  for (const auto& [name, schema] : embedded_types().all())
    for (unsigned seed = 0; seed < 5; ++seed) {
      const sim::Bytes payload = PayloadBuilder(seed).build(schema);
      EXPECT_EQ(error_of(schema, payload, Finite::required), "") << name;
      for (std::size_t size = 0; size < payload.size(); ++size) {
        // A copy of exactly this size lets the address sanitizer see a byte too many.
        const sim::Bytes cut(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_NE(error_of(schema, cut), "") << name << " cut to " << size;
      }
    }
}

}  // namespace
}  // namespace shoal
