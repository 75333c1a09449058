// SPDX-License-Identifier: BSD-3-Clause
#include "shoal/message_codec.hpp"

#include <gtest/gtest.h>

#include <random>

#include "all_message_types.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace shoal;

using lcm_test::PayloadBuilder;

template <class M>
class EveryType : public testing::Test {};

using AllTypes = testing::Types<SHOAL_MESSAGE_TYPE_LIST>;

TYPED_TEST_SUITE(EveryType, AllTypes);

TYPED_TEST(EveryType, HasTheFingerprintThatLcmGenComputes) {
  EXPECT_EQ(static_cast<std::uint64_t>(TypeParam::getHash()), schema_of<TypeParam>().fingerprint);
  EXPECT_EQ(fingerprint_of<TypeParam>(), TypeParam::getHash());
}

TYPED_TEST(EveryType, KeepsItsBytesWhenDecodedAndEncoded) {
  std::vector<std::byte> again;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const sim::Bytes payload = PayloadBuilder(seed).build(schema_of<TypeParam>());
    EXPECT_EQ(fingerprint(payload), TypeParam::getHash());
    encode_into(decode<TypeParam>(payload, Finite::required), again);
    EXPECT_EQ(again, payload);
  }
}

// What the validator lets through, the generated decoder reads to the last byte and no further.
TYPED_TEST(EveryType, SurvivesFlippedBits) {
  std::mt19937 random(1);
  int valid = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    sim::Bytes payload = PayloadBuilder(seed).build(schema_of<TypeParam>());
    for (unsigned flips = random() % 4 + 1; flips > 0; --flips)
      payload[8 + random() % (payload.size() - 8)] ^= static_cast<std::byte>(1u << random() % 8);
    if (validate(schema_of<TypeParam>(), payload, Finite::any)) continue;
    TypeParam message{};
    EXPECT_EQ(message.decode(payload.data(), 0, static_cast<int>(payload.size())), static_cast<int>(payload.size()));
    ++valid;
  }
  EXPECT_GT(valid, 0);
}

TYPED_TEST(EveryType, SurvivesGarbage) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    sim::Bytes payload = PayloadBuilder(1).build(schema_of<TypeParam>());
    payload.resize(8 + random() % 200);
    for (std::size_t at = 8; at < payload.size(); ++at)
      payload[at] = static_cast<std::byte>(random() % 3 == 0 ? random() : 0);
    try {
      decode<TypeParam>(payload, Finite::any);
    } catch (const MessageError&) {
    }
  }
}

TEST(MessageCodec, ThrowsWithTheReason) {
  twist_command_t twist{};
  twist.forward_mps = std::nan("");
  const auto payload = encode(twist);
  EXPECT_NO_THROW(decode<twist_command_t>(payload, Finite::any));
  try {
    decode<twist_command_t>(payload, Finite::required);
    FAIL();
  } catch (const MessageError& error) {
    EXPECT_STREQ(error.what(), "field 'forward_mps' must be finite, got nan");
  }
}

TEST(MessageCodec, RefusesToEncodeArraysOfTheWrongLength) {
  planar_lidar_t scan{};
  scan.nranges = 3;
  try {
    encode(scan);
    FAIL();
  } catch (const MessageError& error) {
    EXPECT_STREQ(error.what(), "shoal.planar_lidar_t: 'ranges' has 0 elements, its length member says 3");
  }
  sim_state_t state{};
  state.count = 1;
  state.vehicle = {"a"};
  state.position_m = {{1, 2}};  // one too few
  state.orientation = {{1, 0, 0, 0}};
  state.velocity_mps = state.angular_velocity_radps = {{0, 0, 0}};
  EXPECT_THROW(encode(state), MessageError);
  state.position_m = {{1, 2, 3}};
  EXPECT_NO_THROW(encode(state));
  raw_t raw{};
  raw.length = -1;
  EXPECT_THROW(encode(raw), MessageError);
}

TEST(MessageCodec, ReusesTheBuffer) {
  std::vector<std::byte> buffer;
  pose_t pose{};
  encode_into(pose, buffer);
  const std::byte* data = buffer.data();
  encode_into(utime_t{}, buffer);
  encode_into(pose, buffer);
  EXPECT_EQ(buffer.data(), data);
}

TEST(MessageCodec, FingerprintOfTooFewBytesIsZero) {
  EXPECT_EQ(fingerprint(sim::Bytes(7)), 0);
}

}  // namespace
