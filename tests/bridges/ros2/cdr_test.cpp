// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/cdr.hpp"

#include <gmock/gmock.h>

#include <random>

#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using bridges::ros2::CdrWriter;
using bridges::ros2::from_cdr;
using bridges::ros2::to_cdr;
using testing::ElementsAreArray;
using Cdr = std::vector<std::byte>;

/// Bytes in hexadecimal, with blanks anywhere.
Cdr hex(std::string_view text) {
  Cdr bytes;
  std::string pair;
  for (const char c : text) {
    if (c == ' ') continue;
    pair += c;
    if (pair.size() < 2) continue;
    bytes.push_back(static_cast<std::byte>(std::stoi(pair, nullptr, 16)));
    pair.clear();
  }
  return bytes;
}

/// A type by its text; `body`: the payload after the fingerprint.
Cdr transcoded(const std::string& lcm, std::string_view body) {
  const shoal::LcmSource source{"a.lcm", lcm};
  const shoal::MessageTypes types(std::span(&source, 1));
  const shoal::MessageSchema& schema = *types.find("p.a_t");
  Cdr payload(8);
  for (int i = 0; i < 8; ++i)
    payload[static_cast<std::size_t>(i)] = static_cast<std::byte>(schema.fingerprint >> (56 - 8 * i));
  const Cdr rest = hex(body);
  payload.insert(payload.end(), rest.begin(), rest.end());
  Cdr cdr;
  EXPECT_EQ(to_cdr(schema, payload, cdr), std::nullopt);
  return cdr;
}

TEST(CdrTranscoder, ReversesTheBytesOfEachNumber) {
  EXPECT_THAT(transcoded("package p; struct a_t { int64_t a; int32_t b; int16_t c; int8_t d; }",
                         "0102030405060708 11121314 2122 31"),
              ElementsAreArray(hex("00010000 0807060504030201 14131211 2221 31")));
}

TEST(CdrTranscoder, AlignsNumbersToTheirSizeAfterTheHeader) {
  // A byte, 7 bytes of padding, a double of 1; a byte, 3 of padding, a float of 1; a byte, 1 of padding, a short.
  EXPECT_THAT(transcoded("package p; struct a_t { byte a; double b; byte c; float d; byte e; int16_t f; }",
                         "01 3ff0000000000000 02 3f800000 03 0405"),
              ElementsAreArray(hex("00010000 01 00000000000000 000000000000f03f 02 000000 0000803f 03 00 0504")));
}

TEST(CdrTranscoder, WritesAStringWithItsLengthAndNul) {
  // The length after a byte is aligned to 4; the number behind 5 + 3 bytes of text as well.
  EXPECT_THAT(transcoded("package p; struct a_t { byte a; string s; int32_t b; }", "09 00000003 686900 00000001"),
              ElementsAreArray(hex("00010000 09 000000 03000000 686900 00 01000000")));
}

TEST(CdrTranscoder, CountsSequencesAndNotArrays) {
  EXPECT_THAT(transcoded("package p; struct a_t { int32_t n; int16_t v[n]; int16_t w[2]; }", "00000001 0102 0304 0506"),
              ElementsAreArray(hex("00010000 01000000 01000000 0201 0403 0605")));
}

TEST(CdrTranscoder, WritesRowsOfSeveralDimensionsAsOneSequence) {
  EXPECT_THAT(transcoded("package p; struct a_t { int32_t n; byte v[n][3]; }", "00000002 010203 040506"),
              ElementsAreArray(hex("00010000 02000000 06000000 010203040506")));
}

TEST(CdrTranscoder, DoesNotAlignTheElementsOfAnEmptySequence) {
  EXPECT_THAT(transcoded("package p; struct a_t { int32_t n; double v[n]; byte b; }", "00000000 07"),
              ElementsAreArray(hex("00010000 00000000 00000000 07")));
}

TEST(CdrTranscoder, AlignsEachElementOfASequenceOfTypes) {
  EXPECT_THAT(transcoded("package p; struct b_t { byte x; int16_t y; } struct a_t { int32_t n; b_t v[n]; }",
                         "00000002 01 0002 03 0004"),
              ElementsAreArray(hex("00010000 02000000 02000000 01 00 0200 03 00 0400")));
}

TEST(CdrTranscoder, MakesBooleansZeroOrOne) {
  EXPECT_THAT(transcoded("package p; struct a_t { boolean a; boolean b[2]; }", "7f 00 01"),
              ElementsAreArray(hex("00010000 01 00 01")));
}

TEST(CdrTranscoder, GivesATypeWithoutMembersOneByte) {
  EXPECT_THAT(transcoded("package p; struct a_t { }", ""), ElementsAreArray(hex("00010000 00")));
}

TEST(CdrTranscoder, RefusesAnInvalidPayload) {
  const shoal::MessageSchema& schema = *shoal::embedded_types().find("shoal.utime_t");
  lcm_test::PayloadBuilder builder(1);
  sim::Bytes payload = builder.build(schema);
  Cdr cdr;
  EXPECT_EQ(to_cdr(schema, payload, cdr), std::nullopt);
  payload.pop_back();
  EXPECT_THAT(to_cdr(schema, payload, cdr).value_or(""), testing::HasSubstr("too short"));
  EXPECT_TRUE(cdr.empty());
}

TEST(CdrTranscoder, TranscodesEveryTypeIntoABoundedSize) {
  lcm_test::PayloadBuilder builder(2);
  for (const auto& [name, schema] : shoal::embedded_types().all()) {
    SCOPED_TRACE(name);
    for (int i = 0; i < 20; ++i) {
      const sim::Bytes payload = builder.build(schema);
      Cdr cdr;
      EXPECT_EQ(to_cdr(schema, payload, cdr), std::nullopt);
      EXPECT_GE(cdr.size(), 4u);
      EXPECT_LE(cdr.size(), 8 * payload.size());
    }
  }
}

TEST(CdrTranscoder, TranscodesEveryTypeThereAndBack) {
  lcm_test::PayloadBuilder builder(3);
  for (const auto& [name, schema] : shoal::embedded_types().all()) {
    SCOPED_TRACE(name);
    for (int i = 0; i < 20; ++i) {
      const sim::Bytes payload = builder.build(schema);
      Cdr cdr, again, back;
      ASSERT_EQ(to_cdr(schema, payload, cdr), std::nullopt);
      ASSERT_EQ(from_cdr(schema, cdr, back), std::nullopt);
      // A boolean may be any byte in a payload, but 0 or 1 in CDR.
      ASSERT_EQ(to_cdr(schema, back, again), std::nullopt);
      EXPECT_EQ(again, cdr);
      EXPECT_EQ(back.size(), payload.size());
    }
  }
}

TEST(CdrTranscoder, RefusesDamagedCdr) {
  lcm_test::PayloadBuilder builder(4);
  std::mt19937 random(4);
  std::size_t refused = 0;
  for (const auto& [name, schema] : shoal::embedded_types().all()) {
    SCOPED_TRACE(name);
    Cdr cdr, back;
    ASSERT_EQ(to_cdr(schema, builder.build(schema), cdr), std::nullopt);
    Cdr cut = cdr;
    cut.pop_back();
    EXPECT_NE(from_cdr(schema, cut, back), std::nullopt);
    EXPECT_TRUE(back.empty());
    cdr.push_back(std::byte{0});
    EXPECT_NE(from_cdr(schema, cdr, back), std::nullopt);
    cdr.pop_back();
    for (int i = 0; i < 50; ++i) {
      Cdr changed = cdr;
      changed[random() % changed.size()] = static_cast<std::byte>(random());
      if (from_cdr(schema, changed, back))
        ++refused;
      else
        EXPECT_EQ(shoal::validate(schema, back, shoal::Finite::any), std::nullopt);
    }
  }
  EXPECT_GT(refused, 100u);
}

}  // namespace
