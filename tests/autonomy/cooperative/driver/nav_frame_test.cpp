// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/nav_frame.hpp"

#include <gtest/gtest.h>

#include "autonomy/acomms/acoustic_frame.hpp"
#include "autonomy/cooperative/estimator/payload.hpp"

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

TEST(NavFrame, HasAsManySightsAsThereIsRoomFor) {
  NavFrame sent;
  sent.payload_time = noon;
  sent.payload = {1, 2, 3};
  for (int i = 0; i < 3; ++i) sent.relatives.push_back({i, 250'400, {-12.344 - i, 4000.5}});
  // 10 bytes of the frame, 3 of the payload, the number, and 9 of each.
  const auto relatives_of = [&](std::size_t frame_bytes) {
    return decode_frame(encode_frame(sent, frame_bytes), noon)->relatives;
  };
  EXPECT_EQ(relatives_of(10 + 3 + 1 + 27).size(), 3U);
  EXPECT_EQ(relatives_of(10 + 3 + 1 + 26).size(), 2U);
  EXPECT_EQ(relatives_of(13).size(), 0U);
  const NavFrame::RelativePosition relative = relatives_of(64).at(1);
  EXPECT_EQ(relative.other, 1);
  EXPECT_EQ(relative.age, 250'000);
  EXPECT_NEAR(relative.d_W.x(), -13.34, 1e-9);
  EXPECT_NEAR(relative.d_W.y(), 4000.5, 1e-9);
  EXPECT_EQ(decode_frame(encode_frame(sent, 64), noon)->payload, sent.payload);
}

TEST(NavFrame, WithMoreSightsThanItsBytesIsNone) {
  NavFrame sent;
  sent.payload = {1};  // the number of relative measurements, if the length of the payload were 0
  Bytes bytes = encode_frame(sent, 18);
  bytes[7] = 0;
  bytes.resize(16);
  PayloadWriter(bytes).whole(autonomy::acoustic_frame::checksum(bytes), 2);
  EXPECT_FALSE(decode_frame(bytes, 0));
}

TEST(NavFrame, BytesOfOtherProgramsAreNone) {
  EXPECT_FALSE(decode_frame({}, 0));
  EXPECT_FALSE(decode_frame(Bytes(28, 0), 0));
  EXPECT_FALSE(decode_frame(Bytes(300, 78), 0));
}

}  // namespace
