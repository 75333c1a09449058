// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/ros2_names.hpp"

#include <gmock/gmock.h>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/ros2_schema.hpp"

namespace {

using namespace bridges::ros2;

using testing::ElementsAre;

shoal::MessageTypes types_of(const std::string& lcm) {
  const shoal::LcmSource source{"a.lcm", lcm};
  return shoal::MessageTypes(std::span(&source, 1));
}

TEST(Ros2Names, TypesAreInCamelCaseInAPackageOfMessages) {
  EXPECT_EQ(type_name("shoal.gps_data_t"), "shoal_interfaces/msg/GpsData");
  EXPECT_EQ(short_type_name("shoal.sim_info_t"), "shoal_interfaces/SimInfo");
  EXPECT_EQ(type_name("my.Own.odd_type"), "my_own_interfaces/msg/OddType");
  EXPECT_EQ(type_name("alone_t"), "lcm_interfaces/msg/Alone");
}

TEST(Ros2Names, MembersAreInLowerCaseAndUnique) {
  const auto types = types_of("package p; struct a_t { int32_t numSatellites; float dB; float db; float x__y_; }");
  EXPECT_THAT(field_names(*types.find("p.a_t")), ElementsAre("numsatellites", "db", "db_2", "x_y"));
}

TEST(Ros2Names, TopicsAreValidInRos2) {
  EXPECT_EQ(topic_of("rover1.lidar"), "/rover1/lidar");
  EXPECT_EQ(topic_of("a..b"), "/a/b");
  EXPECT_EQ(topic_of("2nd.\xc3\xa4 x"), "/_2nd/___x");
  EXPECT_EQ(topic_of("."), "/_");
}

TEST(Ros2Names, TheTruthIsInTheFrameOfTheSensor) {
  EXPECT_EQ(frame_of("rover1.lidar"), "rover1/lidar");
  EXPECT_EQ(frame_of("rover1.lidar.truth"), "rover1/lidar");
}

}  // namespace
