// SPDX-License-Identifier: BSD-3-Clause
#include "messages/shoal/message_schema.hpp"

#include <gtest/gtest.h>

#include "shoal/message_schema.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace shoal;

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

}  // namespace
