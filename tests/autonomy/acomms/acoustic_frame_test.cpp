// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/acoustic_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/random/random.hpp"
#include "tests/autonomy/second.hpp"

namespace {

namespace frame = autonomy::acoustic_frame;
using autonomy::AcousticOrder;
using autonomy::AcousticState;

using test::second;
constexpr std::int64_t week = 7 * 24 * 3600 * second;

AcousticState some_state(sim::Random& random) {
  AcousticState state;
  state.sender = static_cast<int>(random.integer_below(256));
  state.utime = 1'700'000'000 * second + static_cast<std::int64_t>(random.integer_below(2'000'000'000));
  state.east_m = 2e4 * (2 * random.uniform() - 1);
  state.north_m = 2e4 * (2 * random.uniform() - 1);
  state.depth_m = 6000 * random.uniform();
  state.east_std_m = 600 * random.uniform();
  state.north_std_m = 600 * random.uniform();
  state.correlation = 2 * random.uniform() - 1;
  state.speed_mps = 20 * random.uniform();
  state.course_rad = std::numbers::pi * (2 * random.uniform() - 1);
  return state;
}

AcousticOrder some_order(sim::Random& random) {
  AcousticOrder order;
  order.sender = static_cast<int>(random.integer_below(256));
  order.receiver = static_cast<int>(random.integer_below(256));
  order.number = 1 + static_cast<int>(random.integer_below(255));
  order.utime = 1'700'000'000 * second + static_cast<std::int64_t>(random.integer_below(2'000'000'000));
  order.east_m = 2e4 * (2 * random.uniform() - 1);
  order.north_m = 2e4 * (2 * random.uniform() - 1);
  order.depth_m = 6000 * random.uniform();
  order.speed_mps = 0.1 + 20 * random.uniform();
  return order;
}

/// One frame of each kind.
std::vector<frame::Bytes> one_of_each_kind(std::uint64_t seed) {
  sim::Random random(seed, "frame");
  random.begin_step(0);
  AcousticState state = some_state(random);
  const frame::Bytes plain = *frame::encode(state);
  state.order = 17;
  const frame::Bytes obeying = *frame::encode(state);
  state.refused_order = 19;
  state.refusal = autonomy::OrderRefusal::too_fast;
  return {plain, *frame::encode(some_order(random)), obeying, *frame::encode(state)};
}

bool is_good(std::span<const std::uint8_t> bytes) {
  return frame::decode(bytes, 1'700'000'000 * second) || frame::decode_order(bytes, 1'700'000'000 * second);
}

TEST(AcousticFrame, FitsIntoAFrameOfThe32ByteRate) {
  const std::vector<std::size_t> sizes = {frame::state_bytes, frame::order_bytes, frame::executing_state_bytes,
                                          frame::refusing_state_bytes};
  const std::vector<frame::Bytes> frames = one_of_each_kind(6);
  ASSERT_EQ(frames.size(), sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    EXPECT_EQ(frames[i].size(), sizes[i]);
    EXPECT_LE(sizes[i], 32u);
  }
}

TEST(AcousticFrame, ChecksumIsThePublishedOne) {
  // The check value of CRC-16/CCITT-FALSE, of the digits 1 to 9.
  constexpr std::string_view digits = "123456789";
  EXPECT_EQ(frame::checksum({reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()}), 0x29b1);
}

TEST(AcousticFrame, BytesAreWhereTheTableSays) {
  AcousticState state;
  state.sender = 7;
  state.utime = (3 * 86400 + 1) * second;  // one second after the first Sunday began
  state.east_m = 1;
  state.north_m = -1;
  state.depth_m = 2.55;
  state.east_std_m = 0.301;  // rounded up
  state.north_std_m = 1e6;   // as large as it gets
  state.correlation = -1;
  state.speed_mps = 1.5;
  state.course_rad = std::numbers::pi / 2;
  const auto bytes = frame::encode(state);
  ASSERT_TRUE(bytes);
  const std::vector<std::uint8_t> expected = {0x10, 7, 0, 0,   0x03, 0xe8, 0,    0,    0,    100, 0xff, 0xff, 0xff,
                                              0x9c, 0, 0, 255, 0,    31,   0xff, 0xff, 0x81, 0,   150,  0x40, 0};
  EXPECT_EQ(std::vector<std::uint8_t>(bytes->begin(), bytes->end() - 2), expected);
}

TEST(AcousticFrame, ComesBackWithinItsQuantization) {
  sim::Random random(1, "frame");
  for (int i = 0; i < 2000; ++i) {
    random.begin_step(i);
    const AcousticState sent = some_state(random);
    const auto bytes = frame::encode(sent);
    ASSERT_TRUE(bytes);
    const auto received = frame::decode(*bytes, sent.utime + 5 * second);
    ASSERT_TRUE(received);
    constexpr double half_cm = 0.005 + 1e-9;
    EXPECT_EQ(received->sender, sent.sender);
    EXPECT_LE(received->utime, sent.utime);
    EXPECT_GT(received->utime, sent.utime - 1000);
    EXPECT_NEAR(received->east_m, sent.east_m, half_cm);
    EXPECT_NEAR(received->north_m, sent.north_m, half_cm);
    EXPECT_NEAR(received->depth_m, sent.depth_m, half_cm);
    // No one is commanded to be surer than it is.
    EXPECT_GE(received->east_std_m, sent.east_std_m - 1e-9);
    EXPECT_LE(received->east_std_m, sent.east_std_m + 0.01 + 1e-9);
    EXPECT_NEAR(received->north_std_m, sent.north_std_m, 0.01 + 1e-9);
    EXPECT_NEAR(received->correlation, sent.correlation, 0.5 / 127 + 1e-9);
    EXPECT_NEAR(received->speed_mps, sent.speed_mps, half_cm);
    EXPECT_NEAR(sim::wrap_angle(received->course_rad - sent.course_rad), 0, std::numbers::pi / 65536 + 1e-9);
  }
}

TEST(AcousticFrame, EveryErrorOfOneOrTwoBitsIsFound) {
  for (const frame::Bytes& good : one_of_each_kind(2)) {
    ASSERT_TRUE(is_good(good));
    for (std::size_t i = 0; i < 8 * good.size(); ++i)
      for (std::size_t j = i; j < 8 * good.size(); ++j) {
        frame::Bytes bad = good;
        bad[i / 8] ^= static_cast<std::uint8_t>(1u << (i % 8));
        if (j != i) bad[j / 8] ^= static_cast<std::uint8_t>(1u << (j % 8));
        ASSERT_FALSE(is_good(bad)) << i << ' ' << j;
      }
  }
}

TEST(AcousticFrame, EveryOtherLengthIsRefused) {
  for (const frame::Bytes& good : one_of_each_kind(3)) {
    std::vector<std::uint8_t> bytes = good;
    bytes.resize(64);
    for (std::size_t length = 0; length <= bytes.size(); ++length)
      EXPECT_EQ(is_good(std::span(bytes).first(length)), length == good.size());
  }
}

TEST(AcousticFrame, RandomBytesPassAsRarelyAsTheChecksumSays) {
  sim::Random random(4, "frame");
  int passed = 0;
  for (int i = 0; i < 200'000; ++i) {
    random.begin_step(i);
    frame::Bytes bytes(frame::state_bytes);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.bits());
    bytes[0] = frame::version << 4;  // else hardly any comes as far as the checksum
    const auto state = frame::decode(bytes, 0);
    if (!state) continue;
    ++passed;
    EXPECT_TRUE(std::isfinite(state->east_m) && std::abs(state->correlation) <= 1 && state->east_std_m > 0);
  }
  EXPECT_LE(passed, 15);  // 3 expected, of which 14 % have a time of the week
}

TEST(AcousticFrame, OtherVersionsAndKindsAreRefused) {
  // With a good checksum: each length has its one kind.
  const std::vector<frame::Bytes> frames = one_of_each_kind(5);
  for (std::size_t kind = 0; kind < frames.size(); ++kind)
    for (int first = 0; first < 256; ++first) {
      frame::Bytes bytes = frames[kind];
      bytes[0] = static_cast<std::uint8_t>(first);
      const std::uint16_t checksum = frame::checksum(std::span(bytes).first(bytes.size() - 2));
      bytes[bytes.size() - 2] = static_cast<std::uint8_t>(checksum >> 8);
      bytes[bytes.size() - 1] = static_cast<std::uint8_t>(checksum);
      EXPECT_EQ(is_good(bytes), first == 0x10 + static_cast<int>(kind)) << kind << ' ' << first;
    }
}

TEST(AcousticFrame, AnOrderIsNoStateAndAStateIsNoOrder) {
  const std::vector<frame::Bytes> frames = one_of_each_kind(7);
  for (std::size_t kind = 0; kind < frames.size(); ++kind) {
    EXPECT_EQ(frame::decode(frames[kind], 1'700'000'000 * second).has_value(), kind != 1);
    EXPECT_EQ(frame::decode_order(frames[kind], 1'700'000'000 * second).has_value(), kind == 1);
  }
}

TEST(AcousticFrame, StateReportsAnOrderInOneByteMore) {
  sim::Random random(8, "frame");
  random.begin_step(0);
  AcousticState state = some_state(random);
  const frame::Bytes plain = *frame::encode(state);
  EXPECT_EQ(frame::decode(plain, state.utime)->order, 0);
  for (const int order : {1, 17, 255}) {
    state.order = order;
    const frame::Bytes bytes = *frame::encode(state);
    EXPECT_EQ(frame::decode(bytes, state.utime)->order, order);
    EXPECT_TRUE(std::equal(plain.begin() + 1, plain.end() - 2, bytes.begin() + 1));
  }
}

TEST(AcousticFrame, StateReportsARefusedOrderInThreeBytesMore) {
  sim::Random random(9, "frame");
  random.begin_step(0);
  AcousticState state = some_state(random);
  const frame::Bytes plain = *frame::encode(state);
  for (const int order : {0, 1, 254})
    for (const auto refusal : {autonomy::OrderRefusal::too_deep, autonomy::OrderRefusal::too_fast}) {
      state.order = order;
      state.refused_order = order + 1;
      state.refusal = refusal;
      const frame::Bytes bytes = *frame::encode(state);
      const auto decoded = frame::decode(bytes, state.utime);
      ASSERT_TRUE(decoded);
      EXPECT_EQ(decoded->order, order);
      EXPECT_EQ(decoded->refused_order, order + 1);
      EXPECT_EQ(decoded->refusal, refusal);
      EXPECT_TRUE(std::equal(plain.begin() + 1, plain.end() - 2, bytes.begin() + 1));
    }
}

/// Of a later version of the other program, perhaps.
TEST(AcousticFrame, AReasonThatIsNotKnownComesThroughAndNoneDoesNot) {
  sim::Random random(10, "frame");
  random.begin_step(0);
  AcousticState state = some_state(random);
  state.refused_order = 3;
  state.refusal = static_cast<autonomy::OrderRefusal>(7);
  frame::Bytes bytes = *frame::encode(state);
  ASSERT_TRUE(frame::decode(bytes, state.utime));
  EXPECT_EQ(autonomy::to_text(frame::decode(bytes, state.utime)->refusal), "reason 7");
  bytes[28] = 0;
  const std::uint16_t checksum = frame::checksum(std::span(bytes).first(29));
  bytes[29] = static_cast<std::uint8_t>(checksum >> 8);
  bytes[30] = static_cast<std::uint8_t>(checksum);
  EXPECT_FALSE(frame::decode(bytes, state.utime));
}

TEST(AcousticFrame, OrderComesBackWithinItsQuantization) {
  sim::Random random(9, "frame");
  for (int i = 0; i < 2000; ++i) {
    random.begin_step(i);
    const AcousticOrder sent = some_order(random);
    const auto bytes = frame::encode(sent);
    ASSERT_TRUE(bytes);
    const auto received = frame::decode_order(*bytes, sent.utime + 5 * second);
    ASSERT_TRUE(received);
    constexpr double half_cm = 0.005 + 1e-9;
    EXPECT_EQ(received->sender, sent.sender);
    EXPECT_EQ(received->receiver, sent.receiver);
    EXPECT_EQ(received->number, sent.number);
    EXPECT_EQ(received->utime, sent.utime - sent.utime % 1000);
    EXPECT_NEAR(received->east_m, sent.east_m, half_cm);
    EXPECT_NEAR(received->north_m, sent.north_m, half_cm);
    EXPECT_NEAR(received->depth_m, sent.depth_m, half_cm);
    EXPECT_NEAR(received->speed_mps, sent.speed_mps, half_cm);
  }
}

TEST(AcousticFrame, BytesOfAnOrderAreWhereTheTableSays) {
  const AcousticOrder order{200, 3, 5, (3 * 86400 + 1) * second, 1, -1, 2.55, 1.5};
  const auto bytes = frame::encode(order);
  ASSERT_TRUE(bytes);
  const std::vector<std::uint8_t> expected = {0x11, 200,  3,    5,    0,    0, 0x03, 0xe8, 0, 0,  0,
                                              100,  0xff, 0xff, 0xff, 0x9c, 0, 0,    255,  0, 150};
  EXPECT_EQ(std::vector<std::uint8_t>(bytes->begin(), bytes->end() - 2), expected);
}

TEST(AcousticFrame, OrderThatDoesNotFitIsNotSent) {
  AcousticOrder good;
  good.speed_mps = 1;
  EXPECT_TRUE(frame::encode(good));
  const auto refused = [&](auto change) {
    AcousticOrder order = good;
    change(order);
    return !frame::encode(order);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused([](AcousticOrder& o) { o.sender = 256; }));
  EXPECT_TRUE(refused([](AcousticOrder& o) { o.receiver = -1; }));
  EXPECT_TRUE(refused([](AcousticOrder& o) { o.number = 0; }));
  EXPECT_TRUE(refused([](AcousticOrder& o) { o.number = 256; }));
  EXPECT_TRUE(refused([&](AcousticOrder& o) { o.east_m = nan; }));
  EXPECT_TRUE(refused([](AcousticOrder& o) { o.north_m = -3e7; }));
  EXPECT_TRUE(refused([](AcousticOrder& o) { o.depth_m = -1; }));
  EXPECT_TRUE(refused([&](AcousticOrder& o) { o.depth_m = nan; }));
  EXPECT_TRUE(refused([](AcousticOrder& o) { o.speed_mps = 0; }));
  EXPECT_TRUE(refused([](AcousticOrder& o) { o.speed_mps = 700; }));
  EXPECT_TRUE(refused([&](AcousticOrder& o) { o.speed_mps = nan; }));
}

TEST(AcousticFrame, WhatWouldNotBeSentIsNotReceived) {
  sim::Random random(17, "frame");
  random.begin_step(0);
  const AcousticState state = some_state(random);
  const AcousticOrder order = some_order(random);
  const auto signed_again = [](frame::Bytes bytes) {
    const std::uint16_t sum = frame::checksum(std::span(bytes).first(bytes.size() - 2));
    bytes[bytes.size() - 2] = static_cast<std::uint8_t>(sum >> 8);
    bytes[bytes.size() - 1] = static_cast<std::uint8_t>(sum);
    return bytes;
  };
  // East of a state is in bytes 6 to 9, of an order in 8 to 11: 0x7fffffff cm are 21 475 km, and the limit is 21 000.
  frame::Bytes far_state = *frame::encode(state), far_order = *frame::encode(order);
  far_state[6] = far_order[8] = 0x7f;
  std::fill_n(far_state.begin() + 7, 3, 0xff);
  std::fill_n(far_order.begin() + 9, 3, 0xff);
  EXPECT_FALSE(frame::decode(signed_again(far_state), state.utime));
  EXPECT_FALSE(frame::decode_order(signed_again(far_order), order.utime));
}

TEST(AcousticFrame, TimeIsRightAcrossTheEndOfTheWeek) {
  AcousticState state;
  state.east_std_m = state.north_std_m = 1;
  const std::int64_t sunday = 3000 * week + 3 * 24 * 3600 * second;
  for (const std::int64_t sent : {sunday - second, sunday, sunday + second, std::int64_t{0}, -5 * second})
    for (const std::int64_t late : {-2 * second, std::int64_t{0}, 3 * second, week / 2 - second, second - week / 2}) {
      state.utime = sent;
      const auto received = frame::decode(*frame::encode(state), sent + late);
      ASSERT_TRUE(received);
      EXPECT_EQ(received->utime, sent);
    }
}

TEST(AcousticFrame, WhatDoesNotFitIsNotSent) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  AcousticState good;
  EXPECT_TRUE(frame::encode(good));
  const auto refused = [&](auto change) {
    AcousticState state = good;
    change(state);
    return !frame::encode(state);
  };
  EXPECT_TRUE(refused([](AcousticState& s) { s.sender = 256; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.sender = -1; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.order = 256; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.refused_order = 3; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.refusal = autonomy::OrderRefusal::too_deep; }));
  EXPECT_TRUE(refused([&](AcousticState& s) { s.east_m = nan; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.north_m = 3e7; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.depth_m = -1; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.depth_m = 2e5; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.east_std_m = -1; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.correlation = 1.5; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.speed_mps = -0.1; }));
  EXPECT_TRUE(refused([](AcousticState& s) { s.course_rad = std::numeric_limits<double>::infinity(); }));
}

}  // namespace
