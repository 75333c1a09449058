// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/rosbridge_command.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bridges/ros2/ros2_schema.hpp"
#include "bridges/web/web_error.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/thrust_rudder_command_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/waypoints_command_t.hpp"

namespace {

using namespace bridges::rosbridge;
using testing::HasSubstr;
using Json = nlohmann::json;

bool helm_is_unchanged(std::string_view type) {
  return type == "shoal.helm_command_t" || type == "shoal.waypoints_command_t";
}

std::vector<CommandTopic> topics() {
  return command_topics("auv-1", {"auv-1.drive.cmd", "", "auv-1.autopilot.cmd"},
                        {"shoal.wheel_speeds_command_t, shoal.twist_command_t", "",
                         "shoal.helm_command_t, shoal.waypoints_command_t, other.type_t"},
                        helm_is_unchanged);
}

const CommandTopic& topic(const std::vector<CommandTopic>& all, const std::string& name) {
  for (const CommandTopic& each : all)
    if (each.topic == name) return each;
  throw std::out_of_range(name);
}

RosType type_of(const CommandTopic::Type& type) {
  const std::string text = type.name == twist_type
                               ? bridges::ros2::standard_schema_text(type.name)
                               : bridges::ros2::schema_text(*shoal::embedded_types().find(type.lcm_type));
  return {type.name, text};
}

template <class Message>
Message command(const CommandTopic::Type& type, const Json& message) {
  return shoal::decode<Message>(command_payload(type_of(type), type, message), shoal::Finite::any);
}

std::string error_of(const CommandTopic::Type& type, const Json& message) {
  try {
    command_payload(type_of(type), type, message);
  } catch (const bridges::WebError& error) {
    return error.what();
  }
  return "";
}

TEST(RosbridgeCommand, EachDeviceAndTheVelocityOfTheVehicleHaveATopic) {
  const auto all = topics();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(topic(all, "/auv_1/autopilot/cmd").types.size(), 2u);  // a type without a schema is none
  EXPECT_EQ(topic(all, "/auv_1/autopilot/cmd").channel, "auv-1.autopilot.cmd");
  EXPECT_EQ(topic(all, "/auv_1/cmd_vel").channel, "auv-1.drive.cmd");
  EXPECT_EQ(topic(all, "/auv_1/cmd_vel").types.front().name, "geometry_msgs/msg/Twist");
}

TEST(RosbridgeCommand, ATwistIsSpeedAheadAndTurnRate) {
  const auto all = topics();
  const auto& type = topic(all, "/auv_1/cmd_vel").types.front();
  const auto twist = command<shoal::twist_command_t>(type, {{"linear", {{"x", 0.5}}}, {"angular", {{"z", -0.25}}}});
  EXPECT_EQ(twist.forward_mps, 0.5);
  EXPECT_EQ(twist.turn_radps, -0.25);
  EXPECT_THAT(error_of(type, {{"linear", {{"y", 1}}}}), HasSubstr("'msg.linear.y': must be 0"));
  EXPECT_EQ(error_of(type, {{"angular", {{"z", nullptr}}}}), "'msg.angular.z': must be finite");
}

TEST(RosbridgeCommand, WhatAHelmIsNotToldStaysAsItIs) {
  const auto all = topics();
  const auto& type = topic(all, "/auv_1/autopilot/cmd").types.front();
  const auto helm = command<shoal::helm_command_t>(type, {{"speed_mps", 1.5}, {"depth_m", 10}});
  EXPECT_EQ(helm.speed_mps, 1.5);
  EXPECT_EQ(helm.depth_m, 10);
  EXPECT_TRUE(std::isnan(helm.heading_rad));
  EXPECT_TRUE(std::isnan(helm.altitude_m));
}

TEST(RosbridgeCommand, AnArrayNeedsItsLength) {
  const auto all = topics();
  const auto& type = command_type_of(topic(all, "/auv_1/autopilot/cmd"), "shoal_interfaces/WaypointsCommand");
  const Json two{{"n", 2}, {"x_m", {1, 2}}, {"y_m", {3, 4}}, {"depth_m", {5, nullptr}}};
  EXPECT_THAT(command<shoal::waypoints_command_t>(type, two).y_m, testing::ElementsAre(3, 4));
  Json one = two;
  one["n"] = 1;
  EXPECT_THAT(error_of(type, one), HasSubstr("shoal.waypoints_command_t: its CDR does not have the members"));
}

TEST(RosbridgeCommand, NothingThatIsNotFiniteReachesADevice) {
  const CommandTopic::Type type{"shoal_interfaces/msg/ThrustRudderCommand", "shoal.thrust_rudder_command_t"};
  EXPECT_EQ(command<shoal::thrust_rudder_command_t>(type, {{"thrust", 1}}).rudder, 0);
  EXPECT_THAT(error_of(type, {{"thrust", nullptr}}), HasSubstr("thrust"));
}

TEST(RosbridgeCommand, AnotherTypeIsRefusedWithThoseThatFit) {
  const auto all = topics();
  try {
    command_type_of(topic(all, "/auv_1/drive/cmd"), "std_msgs/String");
    FAIL();
  } catch (const bridges::WebError& error) {
    EXPECT_STREQ(error.what(),
                 "/auv_1/drive/cmd: its type must be shoal_interfaces/msg/WheelSpeedsCommand, "
                 "shoal_interfaces/msg/TwistCommand, "
                 "got std_msgs/String");
  }
}

}  // namespace
