// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/moos_variables.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "shoal/actuator_command_t.hpp"
#include "shoal/autopilot_command_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/thrust_rudder_elevator_command_t.hpp"

namespace {

using bridges::ChannelPayload;
using bridges::MoosCommands;
using bridges::MoosMessage;
using bridges::MoosValue;
using bridges::VehicleNavigation;
using testing::ElementsAre;

MoosMessage posted(const std::string& key, double number) {
  MoosMessage message;
  message.key = key;
  message.number = number;
  return message;
}
MoosMessage posted(const std::string& key, const std::string& text) {
  MoosMessage message;
  message.key = key;
  message.value_type = 'S';
  message.text = text;
  return message;
}

MoosCommands::Options options_with(MoosCommands::Control control) {
  return {control, "a.autopilot.cmd", "a.drive.cmd", "a.modem.cmd", {}};
}

template <class Message>
Message decoded(const ChannelPayload& command) {
  return shoal::decode<Message>(command.payload, shoal::Finite::any);
}

VehicleNavigation navigation_at(double east_m, double north_m) {
  VehicleNavigation navigation("a");
  shoal::gps_data_t gps{};
  gps.gps_lock = 1;
  gps.latitude = 43.5;
  gps.longitude = -70.25;
  gps.speed = 1.5;
  gps.xyz_pos[0] = east_m;
  gps.xyz_pos[1] = north_m;
  navigation.take(gps);
  return navigation;
}

TEST(MoosVariables, NavigationHasTheNamesOfMoos) {
  VehicleNavigation navigation = navigation_at(1, 2);
  shoal::compass_t compass{};
  compass.heading_true_rad = std::numbers::pi / 2;
  const auto fields = navigation.take(compass);
  const auto values = bridges::nav_values(navigation, fields);
  ASSERT_EQ(values.size(), 1U);
  EXPECT_EQ(values[0].key, "NAV_HEADING");
  EXPECT_EQ(std::get<double>(values[0].value), 90);
  const bridges::NavField all[] = {bridges::NavField::x, bridges::NavField::depth};
  EXPECT_EQ(bridges::nav_values(navigation, all).size(), 1U);  // without a pressure sensor there is no depth
}

TEST(MoosVariables, ANodeReportHasAllThatIsKnown) {
  VehicleNavigation navigation = navigation_at(1, 2);
  EXPECT_TRUE(bridges::node_report({"alpha"}, navigation, 10).empty());  // no heading yet
  shoal::compass_t compass{};
  navigation.take(compass);
  const auto report = bridges::node_report({"alpha", "kayak", 3}, navigation, 10);
  ASSERT_EQ(report.size(), 1U);
  EXPECT_EQ(report[0].key, "NODE_REPORT_LOCAL");
  EXPECT_EQ(std::get<std::string>(report[0].value),
            "NAME=alpha,TYPE=kayak,TIME=10.000,X=1.000,Y=2.000,LAT=43.50000000,LON=-70.25000000,SPD=1.500,HDG=0.00,"
            "DEP=0.000,LENGTH=3.00,MODE=SHOAL");
}

TEST(MoosVariables, AScanAndOdometryAreText) {
  shoal::planar_lidar_t scan{};
  scan.utime = 2'000'000;
  scan.nranges = 3;
  scan.ranges = {1, 2.5, 3};
  scan.rad0 = static_cast<float>(-std::numbers::pi / 2);
  scan.radstep = static_cast<float>(std::numbers::pi / 2);
  EXPECT_EQ(std::get<std::string>(bridges::laser_value(scan).value),
            "Time=2.000000,MinAngle=-90.0000,AngularResolution=90.0000,Range=[3]{1.000,2.500,3.000}");
  shoal::odometry_t odometry{};
  odometry.x_m = 1;
  odometry.y_m = -2;
  odometry.theta_rad = 0.5;
  EXPECT_EQ(std::get<std::string>(bridges::odometry_value(odometry).value),
            "Time=0.000000,X=1.0000,Y=-2.0000,O=0.50000");
}

TEST(MoosCommands, SetPointsOfAHelmAreOneCommand) {
  MoosCommands commands(options_with(MoosCommands::Control::helm));
  EXPECT_THAT(commands.variables(), ElementsAre("DESIRED_HEADING", "DESIRED_SPEED", "DESIRED_DEPTH",
                                                "NODE_MESSAGE_LOCAL", "SHOAL_MODEM_SEND"));
  EXPECT_TRUE(commands.take_commands(0).empty());
  commands.take(posted("DESIRED_HEADING", 180));
  commands.take(posted("DESIRED_SPEED", "1.5"));
  const auto sent = commands.take_commands(7);
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].channel, "a.autopilot.cmd");
  const auto helm = decoded<shoal::helm_command_t>(sent[0]);
  EXPECT_EQ(helm.utime, 7);
  EXPECT_NEAR(helm.heading_rad, -std::numbers::pi / 2, 1e-12);  // south
  EXPECT_EQ(helm.speed_mps, 1.5);
  EXPECT_TRUE(std::isnan(helm.depth_m));
  EXPECT_TRUE(commands.take_commands(8).empty());
}

TEST(MoosCommands, ActuatorsTurnToTheRightAndDiveWithPositiveValues) {
  MoosCommands commands(options_with(MoosCommands::Control::actuators));
  commands.take(posted("DESIRED_RUDDER", 50));
  commands.take(posted("DESIRED_THRUST", 250));  // more than all
  commands.take(posted("DESIRED_ELEVATOR", 25));
  const auto sent = commands.take_commands(0);
  ASSERT_EQ(sent.size(), 1U);
  const auto drive = decoded<shoal::thrust_rudder_elevator_command_t>(sent[0]);
  EXPECT_EQ(drive.rudder, -0.5);  // clockwise
  EXPECT_EQ(drive.thrust, 1);
  EXPECT_EQ(drive.elevator, 0.25);
}

TEST(MoosCommands, TwoPropellersTurnTheBoatTogether) {
  MoosCommands::Options options = options_with(MoosCommands::Control::actuators);
  options.thrusters = {"a.port.cmd", "a.starboard.cmd", 100, "a.autopilot.cmd"};
  MoosCommands commands(options);
  commands.take(posted("DESIRED_THRUST", 40));
  commands.take(posted("DESIRED_RUDDER", 10));
  const auto sent = commands.take_commands(0);
  ASSERT_EQ(sent.size(), 3U);
  EXPECT_EQ(sent[0].channel, "a.autopilot.cmd");
  EXPECT_EQ(decoded<shoal::autopilot_command_t>(sent[0]).mode, 0);           // off
  EXPECT_NEAR(decoded<shoal::actuator_command_t>(sent[1]).value, 50, 1e-9);  // to the right: port pushes more
  EXPECT_NEAR(decoded<shoal::actuator_command_t>(sent[2]).value, 30, 1e-9);
}

TEST(MoosCommands, MessagesGoToTheModemAndComeBack) {
  MoosCommands commands(options_with(MoosCommands::Control::none));
  commands.take(posted("NODE_MESSAGE_LOCAL", "src_node=a,dest_node=b,var_name=GO,string_val=true"));
  commands.take(posted("SHOAL_MODEM_SEND", "dest=c,hex=0aFF"));
  const auto sent = commands.take_commands(0);
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[0].channel, "a.modem.cmd");
  const auto node = decoded<shoal::modem_send_t>(sent[0]), raw = decoded<shoal::modem_send_t>(sent[1]);
  EXPECT_EQ(node.destination, "b");
  EXPECT_EQ(raw.destination, "c");
  EXPECT_THAT(raw.data, ElementsAre(0x0a, 0xff));
  shoal::modem_received_t received{};
  received.source = "a";
  received.destination = "b";
  received.data = node.data;
  received.size = node.size;
  EXPECT_EQ(bridges::modem_value(received).key, "NODE_MESSAGE");
  EXPECT_EQ(std::get<std::string>(bridges::modem_value(received).value),
            "src_node=a,dest_node=b,var_name=GO,string_val=true");
  received.data = raw.data;
  received.size = raw.size;
  EXPECT_EQ(bridges::modem_value(received).key, "SHOAL_MODEM_RECEIVED");
  EXPECT_EQ(std::get<std::string>(bridges::modem_value(received).value), "src=a,dest=b,hex=0AFF");
}

TEST(MoosCommands, WhatHasNoMeaningIsRefusedAndCounted) {
  MoosCommands commands(options_with(MoosCommands::Control::helm));
  commands.take(posted("DESIRED_SPEED", std::numeric_limits<double>::infinity()));
  commands.take(posted("DESIRED_SPEED", "fast"));
  commands.take(posted("SHOAL_MODEM_SEND", "dest=c,hex=0"));
  commands.take(posted("SHOAL_MODEM_SEND", ""));
  commands.take(posted("NODE_MESSAGE_LOCAL", "hello"));
  EXPECT_EQ(commands.refused(), 5U);
  EXPECT_TRUE(commands.take_commands(0).empty());
  for (int i = 0; i < 100; ++i) commands.take(posted("SHOAL_MODEM_SEND", "hex=00"));
  EXPECT_EQ(commands.take_commands(0).size(), MoosCommands::max_modem_messages);
  EXPECT_EQ(commands.refused(), 5U + 100U - MoosCommands::max_modem_messages);
}

}  // namespace
