// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/door/ros2_door.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "shoal/message_codec.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/utime_t.hpp"
#include "tests/bridges/dds/dds_test_support.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace std::chrono_literals;
using bridges::DdsNetwork;
using bridges::DdsParticipant;
using bridges::ros2::CdrReader;
using bridges::ros2::CdrWriter;
using bridges::ros2::Ros2Door;
using dds_test::next;
using dds_test::own_network;
using lcm_test::own_url;

constexpr double turn_radps = 0.25;

/// A node of ROS 2: reads the clock, finds the node in the graph, asks for the state, and turns the rover.
bool act_as_node(const DdsNetwork& network) {
  DdsParticipant node(network, "enclave=/;");
  const auto clock = node.add_reader("rt/clock", "rosgraph_msgs::msg::dds_::Clock_", {1, false, ""});
  const auto now = next(node, clock);
  CdrReader time(now);
  const bool is_time = time.get<std::int32_t>() == 1 && time.get<std::uint32_t>() == 500'000'000;
  node.remove(clock);

  const auto graph =
      node.add_reader("ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_", {1, true, ""});
  const auto told = next(node, graph);
  CdrReader info(told);
  info.array<std::uint8_t, 16>();
  const bool is_node = info.count(1) == 1 && info.text() == "/" && info.text() == "shoal";
  node.remove(graph);

  const std::string service = "simulation_interfaces::srv::dds_::StepSimulation";
  const auto calls = node.add_writer("rq/shoal/step_simulationRequest", service + "_Request_", {});
  if (!lcm_test::await([&] { return node.has_readers(calls); })) return false;
  std::vector<std::byte> request;
  CdrWriter out(request);
  out.put(std::uint64_t{11});
  out.put(std::int64_t{22});
  out.put(std::uint64_t{1});
  node.write(calls, request);
  // On a busy machine the reader of the answers is known long after the call.
  std::this_thread::sleep_for(300ms);
  const auto answers = node.add_reader("rr/shoal/step_simulationReply", service + "_Response_", {});
  const auto answer = next(node, answers);
  CdrReader response(answer);
  const bool is_refused = response.get<std::uint64_t>() == 11 && response.get<std::int64_t>() == 22 &&
                          response.get<std::uint8_t>() == 4 && response.text().find("--control") != std::string::npos;

  const auto velocity = node.add_writer("rt/rover1/cmd_vel", "geometry_msgs::msg::dds_::Twist_", {});
  if (!lcm_test::await([&] { return node.has_readers(velocity); })) return false;
  std::vector<std::byte> wrong;
  CdrWriter(wrong).put(1.0);
  node.write(velocity, wrong);  // is ignored
  std::vector<std::byte> twist;
  CdrWriter command(twist);
  for (const double value : {0.5, 0.0, 0.0, 0.0, 0.0, turn_radps}) command.put(value);
  node.write(velocity, twist);
  const bool is_over = lcm_test::await([&] { return !node.has_readers(velocity); });
  return is_time && is_node && is_refused && is_over;
}

/// A bus with a vehicle, as the simulator publishes it.
class Simulator {
 public:
  Simulator() : bus_(own_url()) {
    bus_.listen("sim.control");
    bus_.listen("rover1.drive.cmd");
  }
  void publish_time() {
    shoal::utime_t time{};
    time.utime = 1'500'000;
    bus_.publish("sim.clock", shoal::encode(time));
    shoal::sim_state_t state{};
    state.count = 1;
    state.vehicle = {"rover1"};
    state.position_m.assign(1, std::vector<double>(3));
    state.orientation.assign(1, std::vector<double>{1, 0, 0, 0});
    state.velocity_mps = state.angular_velocity_radps = state.position_m;
    bus_.publish("sim.state", shoal::encode(state));
  }
  /// Describes the vehicle when the door asks; returns the command that came.
  std::optional<shoal::twist_command_t> take() {
    while (const auto message = bus_.next(10ms)) {
      if (message->channel == "rover1.drive.cmd")
        return shoal::decode<shoal::twist_command_t>(message->payload, shoal::Finite::required);
      const auto request = shoal::decode<shoal::sim_control_request_t>(message->payload, shoal::Finite::any);
      EXPECT_EQ(request.command, "describe");
      EXPECT_EQ(request.text, "rover1");
      shoal::sim_vehicle_t vehicle{};
      vehicle.vehicle = "rover1";
      vehicle.present = 1;
      vehicle.count = 1;
      vehicle.rate_hz = {0};
      vehicle.device = vehicle.device_type = {"drive"};
      vehicle.report_channel = vehicle.report_type = {""};
      vehicle.command_channel = {"rover1.drive.cmd"};
      vehicle.command_types = {"shoal.twist_command_t"};
      bus_.publish("sim.vehicle", shoal::encode(vehicle));
    }
    return std::nullopt;
  }

 private:
  bridges::LcmListener bus_;
};

TEST(Ros2DoorTest, ANodeReadsTheClockAndDrivesAndCannotControlTheRunUnasked) {
  const DdsNetwork network = own_network();
  dds_test::Peer node([&] { return act_as_node(network); });
  {
    Simulator simulator;
    Ros2Door::Options options;
    options.lcm_url = own_url();
    options.network = network;
    Ros2Door door(options);
    std::atomic<bool> ends = false;
    std::thread runs([&] { door.run([&] { return ends.load(); }); });
    std::optional<shoal::twist_command_t> command;
    EXPECT_TRUE(lcm_test::await(
        [&] {
          simulator.publish_time();
          command = simulator.take();
          return command.has_value();
        },
        120s));
    ends = true;
    runs.join();
    ASSERT_TRUE(command);
    EXPECT_EQ(command->forward_mps, 0.5);
    EXPECT_EQ(command->turn_radps, turn_radps);
    EXPECT_EQ(command->utime, 1'500'000);
    EXPECT_EQ(door.counts().refused, 1u);
    EXPECT_GE(door.counts().commands, 3u);  // a call, a message that is none, a command
  }
  EXPECT_TRUE(node.wait());
}

}  // namespace
