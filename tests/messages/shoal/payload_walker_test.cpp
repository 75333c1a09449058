// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "shoal/message_schema.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace shoal;

using lcm_test::PayloadBuilder;

MessageTypes types_of(const std::string& text) {
  const std::vector<LcmSource> sources{{"test.lcm", text}};
  return MessageTypes(sources);
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
