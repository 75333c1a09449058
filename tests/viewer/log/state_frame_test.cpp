// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/state_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace {

using viewer::StateFrame;

template <typename Number>
Number at(std::span<const std::byte> bytes, std::size_t offset) {
  Number number{};
  std::memcpy(&number, bytes.data() + offset, sizeof number);
  return number;
}

TEST(StateFrame, HasTheLayoutOfThePageProtocol) {
  StateFrame frame;
  frame.begin(
      {.time_us = 123'456, .branch = 2, .revision = 7, .speed = 0.5F, .paused = true, .jump = false, .past = true});
  frame.add({1, -2, 3.5}, {0.5, -0.5, 0.5, 0.5});
  const auto bytes = frame.end();
  ASSERT_EQ(bytes.size(), 32 + StateFrame::body_bytes);
  EXPECT_EQ(at<std::uint8_t>(bytes, 0), 1);      // a state
  EXPECT_EQ(at<std::uint8_t>(bytes, 1), 1 | 4);  // paused, past
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 1u);
  EXPECT_EQ(at<std::int64_t>(bytes, 8), 123'456);
  EXPECT_EQ(at<std::int32_t>(bytes, 16), 2);
  EXPECT_EQ(at<std::uint32_t>(bytes, 20), 7u);
  EXPECT_EQ(at<std::uint32_t>(bytes, 24), 1u);
  EXPECT_EQ(at<float>(bytes, 28), 0.5F);
  EXPECT_EQ(at<float>(bytes, 32), 1);
  EXPECT_EQ(at<float>(bytes, 36), -2);
  EXPECT_EQ(at<float>(bytes, 40), 3.5F);
  EXPECT_EQ(at<std::int16_t>(bytes, 44), 16384);  // 0.5 of 32767 is 16383.5
  EXPECT_EQ(at<std::int16_t>(bytes, 46), -16384);
}

TEST(StateFrame, NumbersItsFramesAndBeginsEachEmpty) {
  StateFrame frame;
  frame.begin({});
  frame.add({0, 0, 0}, sim::Quaterniond::Identity());
  frame.end();
  frame.begin({});
  const auto bytes = frame.end();
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 2u);
  EXPECT_EQ(at<std::uint32_t>(bytes, 24), 0u);
  EXPECT_EQ(bytes.size(), 32u);
}

TEST(StateFrame, BodiesOfAnotherFrameAreTakenAsTheyAre) {
  StateFrame one, other;
  one.begin({});
  one.add({1, 2, 3}, sim::Quaterniond::Identity());
  one.add_unknown();
  other.begin({});
  other.add(one.bodies());
  ASSERT_EQ(other.bodies().size(), 2 * StateFrame::body_bytes);
  EXPECT_EQ(std::memcmp(one.bodies().data(), other.bodies().data(), other.bodies().size()), 0);
  EXPECT_EQ(at<std::uint32_t>(other.end(), 24), 2u);
}

TEST(StateFrame, AnUnknownBodyIsNowhere) {
  StateFrame frame;
  frame.begin({});
  frame.add_unknown();
  EXPECT_TRUE(std::isnan(at<float>(frame.bodies(), 0)));
}

TEST(StateFrame, AQuaternionThatIsTooLongIsCut) {
  StateFrame frame;
  frame.begin({});
  frame.add({0, 0, 0}, {2, -2, 0, 0});
  EXPECT_EQ(at<std::int16_t>(frame.bodies(), 12), 32767);
  EXPECT_EQ(at<std::int16_t>(frame.bodies(), 14), -32767);
}

}  // namespace
