// SPDX-License-Identifier: BSD-3-Clause
#include "messages/yaml/message_writer.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "shoal/helm_command_t.hpp"
#include "shoal/image_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/waypoints_command_t.hpp"

namespace {

using testing::HasSubstr;

struct Written {
  std::vector<std::byte> payload;
  std::string errors;
};

Written write(const std::string& type, const std::string& yaml) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::parse_config_text(yaml, "m.yaml", diagnostics);
  Written written{shoal::encode_own_message(type, node, diagnostics), ""};
  for (const std::string& line : diagnostics.lines()) written.errors += line + "\n";
  return written;
}

TEST(MessageWriter, WritesWhatTheGeneratedTypesRead) {
  const Written written = write("shoal.pose_t", "{utime: 5, pos: [1, -2, 3.5], orientation: [1, 0, 0, 0]}");
  ASSERT_EQ(written.errors, "");
  const auto pose = shoal::decode<shoal::pose_t>(written.payload, shoal::Finite::required);
  EXPECT_EQ(pose.utime, 5);
  EXPECT_EQ(pose.pos[1], -2);
  EXPECT_EQ(pose.pos[2], 3.5);
  EXPECT_EQ(pose.orientation[0], 1);
  EXPECT_EQ(pose.vel[0], 0);  // missing: 0
}

TEST(MessageWriter, CountsArraysItself) {
  const Written written = write("shoal.planar_lidar_t", "{ranges: [1, 2, 3], rad0: -1.5}");
  ASSERT_EQ(written.errors, "");
  const auto scan = shoal::decode<shoal::planar_lidar_t>(written.payload, shoal::Finite::required);
  EXPECT_EQ(scan.nranges, 3);
  EXPECT_EQ(scan.ranges[2], 3);
  EXPECT_EQ(scan.nintensities, 0);
  EXPECT_EQ(scan.rad0, -1.5f);
}

TEST(MessageWriter, TakesBytesAsTextAndStrings) {
  const Written written = write("shoal.modem_send_t", "{destination: auv2, data: hello}");
  ASSERT_EQ(written.errors, "");
  const auto message = shoal::decode<shoal::modem_send_t>(written.payload, shoal::Finite::required);
  EXPECT_EQ(message.destination, "auv2");
  EXPECT_EQ(message.size, 5);
  EXPECT_EQ(message.data[4], 'o');
}

TEST(MessageWriter, WritesNestedTypes) {
  const Written written = write("shoal.image_t", "{width: 2, metadata: [{key: lens, value: abc}]}");
  ASSERT_EQ(written.errors, "");
  const auto image = shoal::decode<shoal::image_t>(written.payload, shoal::Finite::required);
  EXPECT_EQ(image.width, 2);
  ASSERT_EQ(image.nmetadata, 1);
  EXPECT_EQ(image.metadata[0].key, "lens");
  EXPECT_EQ(image.metadata[0].n, 3);
}

TEST(MessageWriter, WritesEveryTypeFromNothing) {
  for (const auto& [name, schema] : shoal::embedded_types().all()) {
    const Written written = write(name, "{}");
    EXPECT_EQ(written.errors, "") << name;
    EXPECT_FALSE(shoal::validate(schema, written.payload, shoal::Finite::any)) << name;
  }
}

TEST(MessageWriter, LeavesAsBeforeWhatACommandDoesNotName) {
  const Written helm = write("shoal.helm_command_t", "{speed_mps: 1.5, depth_m: .nan}");
  ASSERT_EQ(helm.errors, "");
  const auto command = shoal::decode<shoal::helm_command_t>(helm.payload, shoal::Finite::any);
  EXPECT_EQ(command.utime, 0);
  EXPECT_EQ(command.speed_mps, 1.5);
  for (const double number : {command.heading_rad, command.depth_m, command.altitude_m})
    EXPECT_TRUE(std::isnan(number)) << number;
  const Written route = write("shoal.waypoints_command_t", "{x_m: [1, 2], y_m: [3, 4]}");
  ASSERT_EQ(route.errors, "");
  const auto points = shoal::decode<shoal::waypoints_command_t>(route.payload, shoal::Finite::any);
  ASSERT_EQ(points.n, 2);
  EXPECT_TRUE(std::isnan(points.depth_m[1]));
  EXPECT_TRUE(std::isnan(points.speed_mps));
  const Written mixed = write("shoal.waypoints_command_t", "{x_m: [1, 2], y_m: [3, 4], depth_m: [.nan, 7]}");
  EXPECT_EQ(shoal::decode<shoal::waypoints_command_t>(mixed.payload, shoal::Finite::any).depth_m[1], 7);
}

TEST(MessageWriter, TakesNaNOnlyWhereItMeansSomething) {
  EXPECT_THAT(write("shoal.waypoints_command_t", "{x_m: [.nan], y_m: [1]}").errors, HasSubstr("must be finite"));
  EXPECT_THAT(write("shoal.pose_t", "{pos: [.nan, 0, 0]}").errors, HasSubstr("'pos[0]' must be finite, got '.nan'"));
  EXPECT_THAT(write("shoal.helm_command_t", "{depth_m: .inf}").errors, HasSubstr("must be finite"));
}

TEST(MessageWriter, SaysWhatDoesNotFitAndWhere) {
  EXPECT_THAT(write("shoal.posse_t", "{}").errors, HasSubstr("unknown message type 'shoal.posse_t'; did you mean"));
  EXPECT_THAT(write("shoal.pose_t", "{position: [1, 2, 3]}").errors,
              HasSubstr("m.yaml:1:2: shoal.pose_t: unknown member 'position'"));
  EXPECT_THAT(write("shoal.pose_t", "{pos: [1, 2]}").errors, HasSubstr("'pos' must be a list of 3, got [1, 2]"));
  EXPECT_THAT(write("shoal.pose_t", "{pos: [1, x, 3]}").errors, HasSubstr("'pos[1]' must be a number, got 'x'"));
  EXPECT_THAT(write("shoal.image_t", "{width: 3e9}").errors, HasSubstr("'width' must be"));
  EXPECT_THAT(write("shoal.planar_lidar_t", "{ranges: [1, 2], nranges: 3}").errors,
              HasSubstr("'nranges' follows from its array, which has 2 elements"));
  EXPECT_THAT(write("shoal.pose_t", "7").errors, HasSubstr("must be a map of members"));
}

}  // namespace
