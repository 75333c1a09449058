// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/coop_rover.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shoal/message_codec.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/autonomy/second.hpp"

namespace {

using autonomy::CoopRover;
using autonomy::Vector2d;
using Outgoing = std::vector<CoopRover::Outgoing>;

using test::second;

CoopRover::Params params_of(const std::string& name) {
  CoopRover::Params params;
  params.name = name;
  params.waypoints_W = {{100, 0}};
  return params;
}

std::vector<std::byte> odometry(std::int64_t utime, double x_m) {
  shoal::odometry_t message{};
  message.utime = utime;
  message.x_m = x_m;
  message.forward_mps = 1;
  return shoal::encode(message);
}

std::vector<std::byte> free_scan(std::int64_t utime) {
  shoal::planar_lidar_t message{};
  message.utime = utime;
  message.nranges = 180;
  message.ranges.assign(180, 20.0F);
  message.rad0 = -1.5707963F;
  message.radstep = 0.01755F;
  return shoal::encode(message);
}

std::vector<std::byte> gps(std::int64_t utime, double x_m, int lock = 1) {
  shoal::gps_data_t message{};
  message.utime = utime;
  message.gps_lock = lock;
  message.horizontal_accuracy = 0.5;
  message.xyz_pos[0] = lock > 0 ? x_m : std::numeric_limits<double>::quiet_NaN();
  return shoal::encode(message);
}

std::vector<std::byte> sighting(std::int64_t utime, const std::string& vehicle, double x_m) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  shoal::swarm_position_t message{};
  message.utime = utime;
  message.count = 1;
  message.vehicle = {vehicle};
  message.relative_m = {{x_m, 0, 0}};
  message.absolute_m = {{nan, nan, nan}};
  return shoal::encode(message);
}

const CoopRover::Outgoing* find(const Outgoing& out, const std::string& channel) {
  for (const CoopRover::Outgoing& each : out)
    if (each.channel == channel) return &each;
  return nullptr;
}

double forward_mps(const Outgoing& out) {
  return shoal::decode<shoal::twist_command_t>(find(out, "rover1.drive.cmd")->payload, shoal::Finite::required)
      .forward_mps;
}

TEST(CoopRover, StandsStillUntilItSees) {
  CoopRover rover(params_of("rover1"));
  EXPECT_EQ(forward_mps(rover.step(second)), 0);
  rover.receive("lidar", free_scan(second));
  EXPECT_GT(forward_mps(rover.step(second)), 0.5);
  EXPECT_EQ(forward_mps(rover.step(2 * second)), 0);  // that scan is a second old
}

TEST(CoopRover, EstimatesCarryTheTimeOfTheMeasurement) {
  CoopRover rover(params_of("rover1"));
  EXPECT_EQ(find(rover.step(second), "rover1.estimate"), nullptr);
  rover.receive("odometry", odometry(2 * second - 30'000, 1.5));
  const Outgoing out = rover.step(2 * second);
  for (const char* channel : {"rover1.estimate", "rover1.odometry_only"}) {
    ASSERT_NE(find(out, channel), nullptr);
    const auto pose = shoal::decode<shoal::pose_t>(find(out, channel)->payload, shoal::Finite::required);
    EXPECT_EQ(pose.utime, 2 * second - 30'000);
    EXPECT_DOUBLE_EQ(pose.pos[0], 1.5);
    EXPECT_DOUBLE_EQ(pose.vel[0], 1);
    EXPECT_DOUBLE_EQ(pose.orientation[0], 1);
  }
}

TEST(CoopRover, ReportsItsPlaceOnceASecondWhenItHasGps) {
  CoopRover rover(params_of("rover1"));
  int reports = 0;
  for (int i = 1; i <= 100; ++i) {
    const std::int64_t now = i * second / 10;
    rover.receive("odometry", odometry(now, 0));
    rover.receive("gps", gps(now, 0));
    if (find(rover.step(now), "rover1.modem.cmd") != nullptr) ++reports;
  }
  EXPECT_EQ(reports, 10);
}

TEST(CoopRover, ReportsNothingWithoutAFix) {
  CoopRover rover(params_of("rover1"));
  for (int i = 1; i <= 30; ++i) {
    rover.receive("odometry", odometry(i * second / 10, 0));
    rover.receive("gps", gps(i * second / 10, 0, 0));
    EXPECT_EQ(find(rover.step(i * second / 10), "rover1.modem.cmd"), nullptr);
  }
  EXPECT_TRUE(rover.filter().pose().p_W.allFinite());
}

/// Takes what rover1 gave its modem to the modem of another.
std::vector<std::byte> arrived(const Outgoing& out, std::int64_t utime) {
  const auto sent = shoal::decode<shoal::modem_send_t>(find(out, "rover1.modem.cmd")->payload, shoal::Finite::any);
  shoal::modem_received_t packet{};
  packet.sent_utime = utime;
  packet.utime = utime;
  packet.source = "rover1";
  packet.size = sent.size;
  packet.data = sent.data;
  return shoal::encode(packet);
}

TEST(CoopRover, FindsItsPlaceByARoverWithGps) {
  CoopRover with_gps(params_of("rover1"));
  // rover1 stands at 20 m east.  rover3 believes to be at the origin, and is 3 m farther; it is not sure at
  // all.
  auto params = params_of("rover3");
  params.start_position_std_m = 5;
  params.start_yaw_std_rad = 0.001;
  CoopRover lost(params);
  with_gps.receive("odometry", odometry(second, 20));
  with_gps.receive("gps", gps(second, 20));
  const std::vector<std::byte> packet = arrived(with_gps.step(second), second + 10'000);
  lost.receive("odometry", odometry(second + 20'000, 0));
  lost.receive("modem", packet);
  lost.receive("swarm_position", sighting(second + 20'000, "rover1", 17));
  // rover1 says it drives at 1 m/s, so that it was 2 cm farther by then.  The variance of the sighting is
  // 0.15^2 + 0.5^2, the gain 25 / (25 + 0.27).
  EXPECT_NEAR(lost.filter().pose().p_W.x(), 3.02, 0.05);
  EXPECT_NEAR(lost.filter().position_std_m(), std::sqrt(25 * 0.2725 / 25.2725), 1e-3);
}

TEST(CoopRover, RefusesBytesThatAreNoReport) {
  CoopRover rover(params_of("rover1"));
  const std::vector<std::byte> noise(40, std::byte{0x5a});
  for (const std::string_view device : CoopRover::devices())
    EXPECT_THROW(rover.receive(device, noise), shoal::MessageError) << device;
}

TEST(CoopRover, SameMessagesGiveTheSameBytes) {
  const auto run = [] {
    CoopRover rover(params_of("rover1"));
    std::vector<std::byte> all;
    for (int i = 1; i <= 100; ++i) {
      rover.receive("odometry", odometry(i * second / 10, 0.05 * i));
      rover.receive("lidar", free_scan(i * second / 10));
      if (i % 10 == 0) rover.receive("gps", gps(i * second / 10, 0.05 * i));
      for (const CoopRover::Outgoing& out : rover.step(i * second / 10))
        all.insert(all.end(), out.payload.begin(), out.payload.end());
    }
    return all;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
