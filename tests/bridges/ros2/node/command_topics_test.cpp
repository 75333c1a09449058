// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/node/command_topics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "bridges/ros2/cdr.hpp"
#include "shoal/actuator_command_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/joint_command_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/waypoints_command_t.hpp"

namespace {

using namespace bridges::ros2;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t now = 1'500'000;

shoal::sim_vehicle_t vehicle(const std::string& device, const std::string& types) {
  shoal::sim_vehicle_t message{};
  message.vehicle = "v";
  message.present = 1;
  message.count = 2;
  message.device = {"lidar", device};
  message.device_type = {"lidar", device};
  message.command_channel = {"", "v." + device + ".cmd"};
  message.command_types = {"", types};
  return message;
}

/// The topic of this name and type; the test fails without it.
CommandTopic topic(const shoal::sim_vehicle_t& of, const std::string& name, const std::string& type) {
  for (const CommandTopic& each : command_topics(of))
    if (each.name == name && each.type == type) return each;
  ADD_FAILURE() << "no topic " << name << " of type " << type;
  return {};
}

/// CDR of the values that `write` puts.
template <class Write>
std::vector<std::byte> cdr(const Write& write) {
  std::vector<std::byte> bytes;
  CdrWriter out(bytes);
  write(out);
  return bytes;
}

std::vector<std::byte> twist_cdr(double forward_mps, double turn_radps, bool stamped = false) {
  return cdr([&](CdrWriter& out) {
    if (stamped) {
      out.put(std::int32_t{1});
      out.put(std::uint32_t{2});
      out.put(std::string_view("base"));
    }
    for (const double value : {forward_mps, 0.0, 0.0, 0.0, 0.0, turn_radps}) out.put(value);
  });
}

template <class Message>
Message converted(const CommandTopic& topic, const std::vector<std::byte>& bytes) {
  return shoal::decode<Message>(topic.convert(bytes, now), shoal::Finite::any);
}

TEST(CommandTopicsTest, ADriveTakesTwistsWithAndWithoutAStamp) {
  const auto drive = vehicle("drive", "shoal.twist_command_t, shoal.wheel_speeds_command_t");
  for (const bool stamped : {false, true}) {
    const char* type = stamped ? "geometry_msgs/msg/TwistStamped" : "geometry_msgs/msg/Twist";
    const char* name = stamped ? "/v/cmd_vel_stamped" : "/v/cmd_vel";
    const auto command = converted<shoal::twist_command_t>(topic(drive, name, type), twist_cdr(0.5, -0.25, stamped));
    EXPECT_EQ(command.utime, now);
    EXPECT_EQ(command.forward_mps, 0.5);
    EXPECT_EQ(command.turn_radps, -0.25);
  }
  std::vector<std::string> names;
  for (const CommandTopic& each : command_topics(drive)) {
    names.push_back(each.name);
    EXPECT_EQ(each.channel, "v.drive.cmd");
  }
  EXPECT_THAT(names, ElementsAre("/v/drive/cmd/twist_command", "/v/cmd_vel", "/v/cmd_vel_stamped",
                                 "/v/drive/cmd/wheel_speeds_command"));
}

TEST(CommandTopicsTest, TheFirstOfTwoDrivesHasTheTopicOfTheVehicle) {
  auto two = vehicle("front", "shoal.twist_command_t");
  two.command_channel[0] = "v.rear.cmd";
  two.command_types[0] = "shoal.twist_command_t";
  int topics = 0;
  for (const CommandTopic& each : command_topics(two)) {
    if (!each.name.starts_with("/v/cmd_vel")) continue;
    ++topics;
    EXPECT_EQ(each.channel, "v.rear.cmd");
  }
  EXPECT_EQ(topics, 2);  // Twist and TwistStamped
}

TEST(CommandTopicsTest, ANumberIsTheValueOfAnActuatorAndTheTargetOfAJoint) {
  const auto half = cdr([](CdrWriter& out) { out.put(0.5); });
  constexpr const char* float64 = "std_msgs/msg/Float64";
  const auto thruster = topic(vehicle("port", "shoal.actuator_command_t"), "/v/port/cmd", float64);
  EXPECT_EQ(converted<shoal::actuator_command_t>(thruster, half).value, 0.5);
  const auto motor = topic(vehicle("arm", "shoal.joint_command_t"), "/v/arm/cmd", float64);
  EXPECT_EQ(converted<shoal::joint_command_t>(motor, half).velocity, 0.5);
  const auto servo = topic(vehicle("knee", "shoal.joint_servo_command_t"), "/v/knee/cmd", float64);
  EXPECT_EQ(converted<shoal::joint_servo_command_t>(servo, half).position, 0.5);
  EXPECT_EQ(converted<shoal::joint_servo_command_t>(servo, half).mode, 0);
}

TEST(CommandTopicsTest, APathInTheWorldBecomesARouteWithDepths) {
  const auto autopilot = vehicle("autopilot", "shoal.waypoints_command_t");
  const auto header = [](CdrWriter& out) {
    out.put(std::int32_t{0});
    out.put(std::uint32_t{0});
    out.put(std::string_view("world"));
  };
  const auto bytes = cdr([&](CdrWriter& out) {
    header(out);
    out.put_count(2);
    for (const double x_m : {10.0, 20.0}) {
      header(out);
      for (const double value : {x_m, -3.0, -5.0, 0.0, 0.0, 0.0, 1.0}) out.put(value);
    }
  });
  const auto route =
      converted<shoal::waypoints_command_t>(topic(autopilot, "/v/autopilot/path", "nav_msgs/msg/Path"), bytes);
  EXPECT_THAT(route.x_m, ElementsAre(10, 20));
  EXPECT_THAT(route.y_m, ElementsAre(-3, -3));
  EXPECT_THAT(route.depth_m, ElementsAre(5, 5));
  EXPECT_TRUE(std::isnan(route.speed_mps));
}

TEST(CommandTopicsTest, AMessageOfShoalsTypesIsTakenAsItIsWithPaddingToo) {
  const auto modem =
      topic(vehicle("modem", "shoal.modem_send_t"), "/v/modem/cmd/modem_send", "shoal_interfaces/msg/ModemSend");
  shoal::modem_send_t send{};
  send.utime = 7;
  send.destination = "w";
  send.data = {1, 2, 3};
  send.size = 3;
  std::vector<std::byte> bytes;
  ASSERT_FALSE(to_cdr(shoal::schema_of<shoal::modem_send_t>(), shoal::encode(send), bytes));
  bytes.resize((bytes.size() + 3) / 4 * 4);
  const auto received = converted<shoal::modem_send_t>(modem, bytes);
  EXPECT_EQ(received.utime, 7);
  EXPECT_EQ(received.destination, "w");
  EXPECT_THAT(received.data, ElementsAre(1, 2, 3));
  // A set point that is not given is NaN.
  const auto helm =
      topic(vehicle("pilot", "shoal.helm_command_t"), "/v/pilot/cmd/helm_command", "shoal_interfaces/msg/HelmCommand");
  shoal::helm_command_t command{};
  command.depth_m = not_a_number;
  ASSERT_FALSE(to_cdr(shoal::schema_of<shoal::helm_command_t>(), shoal::encode(command), bytes));
  EXPECT_TRUE(std::isnan(converted<shoal::helm_command_t>(helm, bytes).depth_m));
}

TEST(CommandTopicsTest, BytesThatAreNotOfTheTypeAreRefused) {
  const auto drive = topic(vehicle("drive", "shoal.twist_command_t"), "/v/cmd_vel", "geometry_msgs/msg/Twist");
  const auto good = twist_cdr(1, 0);
  const auto convert = [&](std::vector<std::byte> bytes) { return [&drive, bytes] { drive.convert(bytes, now); }; };
  EXPECT_THAT(convert({good.begin(), good.end() - 1}), ThrowsMessage<shoal::MessageError>("ends too early"));
  EXPECT_THAT(convert(twist_cdr(not_a_number, 0)), ThrowsMessage<shoal::MessageError>("linear.x must be finite"));
  auto big_endian = good;
  big_endian[1] = std::byte{0};
  EXPECT_THAT(convert(big_endian), ThrowsMessage<shoal::MessageError>(HasSubstr("little-endian")));
  const auto path = topic(vehicle("a", "shoal.waypoints_command_t"), "/v/a/path", "nav_msgs/msg/Path");
  const auto huge = cdr([](CdrWriter& out) {
    for (int i = 0; i < 3; ++i) out.put(std::uint32_t{0});
    out.put_count(4'000'000'000u);
  });
  EXPECT_THAT(([&] { path.convert(huge, now); }),
              ThrowsMessage<shoal::MessageError>(HasSubstr("longer than the message")));
}

}  // namespace
