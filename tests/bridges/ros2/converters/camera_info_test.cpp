// SPDX-License-Identifier: BSD-3-Clause
// What REP 103 (axes, units), 105 (frames), 117 (ranges), 118 (depth) and 145 (inertial) ask of the standard messages.
#include <gmock/gmock.h>

#include "shoal/image_t.hpp"
#include "tests/bridges/ros2/converted.hpp"
#include "tests/bridges/ros2/known_devices.hpp"

namespace {

using namespace known_devices;

using test::converted;
using test::expect_header;

/// Reads the calibration: model; D; K; R; P.
void expect_camera_info(const std::string& optics, const std::string& model, const std::vector<double>& d) {
  auto in = converted(image_of(1497715271, "optics", optics), "camera_info");
  ASSERT_TRUE(in) << optics;
  expect_header(*in, "auv1/x_optical");
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);  // height
  EXPECT_EQ(in->number<std::uint32_t>(), 2u);
  EXPECT_EQ(in->text(), model);
  ASSERT_EQ(in->number<std::uint32_t>(), d.size());
  for (const double value : d) EXPECT_EQ(in->number<double>(), value);
  // The principal point of OpenCV and ROS counts from the center of the first pixel.
  for (const double value : {300.0, 0.0, 0.5, 0.0, 310.0, 0.0, 0.0, 0.0, 1.0}) EXPECT_EQ(in->number<double>(), value);
  for (const double value : {1, 0, 0, 0, 1, 0, 0, 0, 1}) EXPECT_EQ(in->number<double>(), value);
  for (const double value : {300.0, 0.0, 0.5, 0.0, 0.0, 310.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0})
    EXPECT_EQ(in->number<double>(), value);
  in->skip<std::uint32_t>(6);
  EXPECT_EQ(in->number<std::uint8_t>(), 0);
  EXPECT_TRUE(in->at_end());
}

TEST(RosConventions, AnImageHasTheCalibrationOfItsLens) {
  const std::string size = "width: 2, height: 1, focal_px: [300, 310], principal_px: [1, 0.5], ";
  expect_camera_info("{lens: pinhole, " + size + "distortion: [0.1, -0.2]}", "plumb_bob", {0.1, -0.2, 0, 0, 0});
  expect_camera_info("{lens: fisheye, " + size + "distortion: [], max_angle_deg: 90}", "equidistant", {0, 0, 0, 0});
  // The right camera of a stereo pair: -fx B.
  shoal::image_t right = image_of(1497715271, "optics", "{" + size + "distortion: []}");
  const std::string baseline = "0.12";
  right.metadata.push_back(
      {"baseline_m", static_cast<std::int32_t>(baseline.size()), {baseline.begin(), baseline.end()}});
  right.nmetadata = 2;
  auto in = converted(right, "camera_info");
  expect_header(*in, "auv1/x_optical");
  in->skip<std::uint32_t>(2);
  in->text();
  in->skip<double>(in->number<std::uint32_t>() + 9 + 9);
  for (const double value : {300.0, 0.0, 0.5, -300 * 0.12, 0.0, 310.0}) EXPECT_EQ(in->number<double>(), value);
  // Images of others may have no lens, or anything in its place.
  for (const char* optics : {"", "[", "{focal_px: [1]}", "{focal_px: [1, 1], principal_px: 3}", "\x01"})
    EXPECT_FALSE(converted(image_of(1497715271, "optics", optics), "camera_info")) << optics;
  EXPECT_FALSE(converted(image_of(1497715271, "exposure", "1"), "camera_info"));
}

}  // namespace
