// SPDX-License-Identifier: BSD-3-Clause
#include "tools/navigation/driver/nav_frame.hpp"

#include <gtest/gtest.h>

namespace {

using namespace navigation;

constexpr Time noon = 1'767'268'800'000'000;

TEST(NavFrame, ComesBackWithItsTimeToAMillisecond) {
  NavFrame sent;
  sent.sender = 3;
  sent.payload_time = noon + 123'456;
  sent.depth_m = 15.254;
  sent.payload = {1, 2, 3};
  const Bytes bytes = encode_frame(sent, 32);
  EXPECT_EQ(bytes.size(), 32U);
  for (const Time after_us : {-20'000'000, 0, 500'000, 30'000'000}) {
    const auto read = decode_frame(bytes, sent.payload_time + after_us);
    ASSERT_TRUE(read) << after_us;
    EXPECT_EQ(read->sender, 3);
    EXPECT_EQ(read->payload_time, noon + 123'000);
    EXPECT_NEAR(read->depth_m, 15.25, 1e-9);
    EXPECT_EQ(read->payload, sent.payload);
  }
}

TEST(NavFrame, IsAlwaysAsLongAsTheOthers) {
  EXPECT_EQ(encode_frame({}, 128).size(), 128U);
  EXPECT_EQ(payload_room(32), 22U);
  EXPECT_EQ(payload_room(9), 0U);
  EXPECT_EQ(payload_room(256), 0U);
}

TEST(NavFrame, APayloadThatDoesNotFitIsRefused) {
  NavFrame frame;
  frame.payload.resize(23);
  try {
    encode_frame(frame, 32);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "a frame of 32 bytes has room for 22 bytes of payload, got 23");
  }
}

TEST(NavFrame, EachWrongBitIsFound) {
  NavFrame sent;
  sent.payload = {7, 8};
  Bytes bytes = encode_frame(sent, 16);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_FALSE(decode_frame(bytes, 0)) << bit;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
  EXPECT_TRUE(decode_frame(bytes, 0));
}

TEST(NavFrame, BytesOfOtherProgramsAreNone) {
  EXPECT_FALSE(decode_frame({}, 0));
  EXPECT_FALSE(decode_frame(Bytes(28, 0), 0));
  EXPECT_FALSE(decode_frame(Bytes(300, 78), 0));
}

}  // namespace
