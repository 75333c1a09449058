// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/message_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "shoal/message_codec.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/sim_bodies_t.hpp"
#include "shoal/sim_sound_t.hpp"

namespace {

using Json = nlohmann::json;

/// A frame, read as a page does.
struct Frame {
  explicit Frame(const std::string& bytes) : kind(bytes[0]) {
    std::uint32_t header_bytes = 0;
    std::memcpy(&header_bytes, bytes.data() + 4, 4);
    std::memcpy(&time_us, bytes.data() + 8, 8);
    header_size = header_bytes;
    header = Json::parse(bytes.substr(32, header_bytes));
    blob = bytes.substr(32 + header_bytes);
  }
  template <typename Number>
  std::vector<Number> array(const Json& place) const {
    std::vector<Number> numbers(place["count"].get<std::size_t>());
    std::memcpy(numbers.data(), blob.data() + place["offset"].get<std::size_t>(), numbers.size() * sizeof(Number));
    return numbers;
  }
  int kind;
  std::int64_t time_us = 0;
  std::size_t header_size = 0;
  Json header;
  std::string blob;
};

Frame frame_of(const std::vector<std::byte>& payload) {
  return Frame(viewer::message_frame(shoal::embedded_types(), "rover1.x", payload, 1'234'567));
}

TEST(MessageFrame, HasTheFieldsOfAMessage) {
  shoal::pose_t pose{};
  pose.utime = 42;
  pose.pos[1] = 2.5;
  pose.vel[0] = std::numeric_limits<double>::quiet_NaN();
  const Frame frame = frame_of(shoal::encode(pose));
  EXPECT_EQ(frame.kind, 2);
  EXPECT_EQ(frame.time_us, 1'234'567);
  EXPECT_EQ(frame.header_size % 8, 0u);
  EXPECT_EQ(frame.header["channel"], "rover1.x");
  EXPECT_EQ(frame.header["type"], "shoal.pose_t");
  EXPECT_EQ(frame.header["fields"]["utime"], 42);
  EXPECT_EQ(frame.header["fields"]["pos"], Json({0.0, 2.5, 0.0}));
  EXPECT_EQ(frame.header["fields"]["vel"][0], nullptr);
}

TEST(MessageFrame, AnArrayOfMoreThan16NumbersIsInTheBlob) {
  shoal::planar_lidar_t lidar{};
  lidar.nranges = 17;
  lidar.ranges.resize(17);
  for (int i = 0; i < 17; ++i) lidar.ranges[static_cast<std::size_t>(i)] = 0.5f * static_cast<float>(i);
  lidar.ranges[3] = std::numeric_limits<float>::infinity();
  lidar.nintensities = 16;
  lidar.intensities.resize(16, 1);
  const Frame frame = frame_of(shoal::encode(lidar));
  const Json& ranges = frame.header["fields"]["ranges"];
  EXPECT_EQ(ranges["array"], "f32");
  EXPECT_EQ(ranges["offset"].get<int>() % 8, 0);
  EXPECT_EQ(frame.array<float>(ranges), lidar.ranges);
  EXPECT_EQ(frame.header["fields"]["intensities"].size(), 16u);
}

TEST(MessageFrame, AnArrayOfTwoDimensionsHasItsShape) {
  shoal::sim_bodies_t bodies{};
  bodies.count = 10;
  bodies.body.resize(10, 3);
  bodies.position_m.resize(10, std::vector<double>(3, 1.5));
  bodies.orientation.resize(10, std::vector<float>(4, 0.5f));
  const Frame frame = frame_of(shoal::encode(bodies));
  const Json& position = frame.header["fields"]["position_m"];
  EXPECT_EQ(position["array"], "f64");
  EXPECT_EQ(position["shape"], Json({10, 3}));
  EXPECT_EQ(frame.array<double>(position), std::vector<double>(30, 1.5));
}

TEST(MessageFrame, TextThatIsNotUtf8IsRepaired) {
  shoal::sim_sound_t sound{};
  sound.source = "auv\xff";
  EXPECT_EQ(frame_of(shoal::encode(sound)).header["fields"]["source"], "auv\xef\xbf\xbd");
}

TEST(MessageFrame, AMessageThatCannotBeReadHasItsSizeOnly) {
  std::vector<std::byte> payload = shoal::encode(shoal::pose_t{});
  payload.resize(100);
  const Frame broken = frame_of(payload);
  EXPECT_EQ(broken.header["type"], "shoal.pose_t");
  EXPECT_EQ(broken.header["fields"], Json::object());
  EXPECT_EQ(broken.header["bytes"], 100);
  payload.resize(3);
  EXPECT_EQ(frame_of(payload).header["bytes"], 3);
  const Frame unknown = frame_of(std::vector<std::byte>(20, std::byte{7}));
  EXPECT_EQ(unknown.header["type"], "");
  EXPECT_EQ(unknown.header["bytes"], 20);
}

}  // namespace
