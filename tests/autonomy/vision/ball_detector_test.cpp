// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/vision/ball_detector.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>

#include "shoal/message_codec.hpp"
#include "sim/base/math.hpp"

namespace {

using autonomy::BallDetector;
using autonomy::BallSighting;

using Color = std::array<std::uint8_t, 3>;
constexpr Color grass{74, 140, 60}, orange{240, 120, 24};
constexpr int width = 160, height = 120;
const double focal_px = width / 2.0 / std::tan(std::numbers::pi / 6);  // 60 degrees

shoal::image_t image_of(const Color& background) {
  shoal::image_t image{};
  image.utime = 70'000;
  image.width = width;
  image.height = height;
  image.row_stride = 3 * width;
  image.pixelformat = 859981650;
  for (int i = 0; i < width * height; ++i) image.data.insert(image.data.end(), background.begin(), background.end());
  image.size = static_cast<std::int32_t>(image.data.size());
  return image;
}

void set_pixel(shoal::image_t& image, int column, int row, const Color& color) {
  std::copy(color.begin(), color.end(), image.data.begin() + row * image.row_stride + 3 * column);
}

/// Paints the pixels whose ray meets a sphere.  Its center is in the frame of the camera: x ahead, y left, z up.
void paint_ball(shoal::image_t& image, const sim::Vector3d& center_m, double radius_m, const Color& color = orange) {
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const sim::Vector3d ray =
          sim::Vector3d(focal_px, width / 2.0 - column - 0.5, height / 2.0 - row - 0.5).normalized();
      const double along_m = ray.dot(center_m);
      if (along_m > 0 && center_m.squaredNorm() - along_m * along_m <= radius_m * radius_m)
        set_pixel(image, column, row, color);
    }
  }
}

BallDetector detector() {
  return BallDetector({.fov_deg = 60, .ball_radius_m = 0.11});
}

TEST(RangeOfSphere, OnTheAxisIsThatOfACircleWithTheTangentOfTheHalfAngle) {
  for (const double range_m : {0.2, 0.5, 2.0, 10.0}) {
    const double radius_px = focal_px * std::tan(std::asin(0.11 / range_m));
    EXPECT_NEAR(autonomy::range_of_sphere(0.11, std::numbers::pi * radius_px * radius_px, focal_px, 0), range_m,
                1e-9 * range_m);
  }
}

TEST(RangeOfSphere, OffTheAxisIsThatOfTheEllipse) {
  // Pixels of 0.002 f: about 20 000. Those on the border, about 500, add an error of about the square root of 500,
  // 0.1 % of the area and half of that in the range.
  const double off_axis_rad = 0.4, range_m = 0.8, step = 0.002;
  const sim::Vector3d center_m = range_m * sim::Vector3d(std::cos(off_axis_rad), std::sin(off_axis_rad), 0);
  int count = 0;
  for (double left = 0.2; left < 0.7; left += step)
    for (double up = -0.2; up < 0.2; up += step) {
      const sim::Vector3d ray = sim::Vector3d(1, left, up).normalized();
      if (ray.cross(center_m).norm() <= 0.11) ++count;
    }
  EXPECT_NEAR(autonomy::range_of_sphere(0.11, count * step * step, 1, off_axis_rad), range_m, 1e-3 * range_m);
}

TEST(BallDetector, FindsDirectionAndRange) {
  for (const sim::Vector3d& center_m :
       {sim::Vector3d(1, 0.2, -0.1), sim::Vector3d(2, -0.8, 0.3), sim::Vector3d(5, 1, -0.4)}) {
    shoal::image_t image = image_of(grass);
    paint_ball(image, center_m, 0.11);
    const auto ball = detector().detect(image);
    ASSERT_TRUE(ball);
    EXPECT_EQ(ball->utime, 70'000);
    EXPECT_FALSE(ball->cut);
    // Half a pixel.  The middle of the ellipse differs from the projected center by less than that.
    EXPECT_NEAR(ball->bearing_rad, std::atan2(center_m.y(), center_m.x()), 0.5 / focal_px);
    EXPECT_NEAR(ball->elevation_rad, std::atan2(center_m.z(), std::hypot(center_m.x(), center_m.y())), 0.5 / focal_px);
    // The number of pixels is off by about the square root of its border, here at most by 5 %, the range by half of it.
    EXPECT_NEAR(ball->range_m, center_m.norm(), 0.025 * center_m.norm()) << ball->pixels;
  }
}

TEST(BallDetector, ChoosesTheLargerOfTwoBalls) {
  shoal::image_t image = image_of(grass);
  paint_ball(image, {3, 1, 0}, 0.11);
  paint_ball(image, {2, -0.6, 0}, 0.11);
  const auto ball = detector().detect(image);
  ASSERT_TRUE(ball);
  EXPECT_NEAR(ball->bearing_rad, std::atan2(-0.6, 2), 0.5 / focal_px);
}

TEST(BallDetector, IgnoresFewerPixelsThanItsLimit) {
  shoal::image_t image = image_of(grass);
  for (int column = 20; column < 23; ++column) set_pixel(image, column, 30, orange);
  set_pixel(image, 80, 60, orange);  // another group
  EXPECT_FALSE(detector().detect(image));
  set_pixel(image, 23, 30, orange);
  const auto ball = detector().detect(image);
  ASSERT_TRUE(ball);
  EXPECT_EQ(ball->pixels, 4);
  EXPECT_NEAR(ball->bearing_rad, std::atan2(width / 2.0 - 22, focal_px), 1e-12);
  EXPECT_NEAR(ball->elevation_rad, std::atan2(height / 2.0 - 30.5, std::hypot(focal_px, width / 2.0 - 22)), 1e-12);
}

TEST(BallDetector, ReportsABallThatIsCutByTheBorder) {
  shoal::image_t image = image_of(grass);
  paint_ball(image, {1, 0, -0.45}, 0.11);
  const auto ball = detector().detect(image);
  ASSERT_TRUE(ball);
  EXPECT_TRUE(ball->cut);
  EXPECT_GT(ball->range_m, std::hypot(1, 0.45));
}

TEST(BallDetector, KnowsOrangeInLightAndShade) {
  const BallDetector all = detector();
  EXPECT_TRUE(all.is_ball(240, 120, 24));
  EXPECT_TRUE(all.is_ball(120, 60, 12));
  EXPECT_TRUE(all.is_ball(255, 140, 60));
  EXPECT_FALSE(all.is_ball(24, 12, 2)) << "too dark";
  EXPECT_FALSE(all.is_ball(74, 140, 60)) << "grass";
  EXPECT_FALSE(all.is_ball(216, 176, 112)) << "the table of the Segway";
  EXPECT_FALSE(all.is_ball(232, 232, 232)) << "boards";
  EXPECT_FALSE(all.is_ball(255, 220, 0)) << "yellow";
  EXPECT_FALSE(all.is_ball(200, 10, 10)) << "red";
}

TEST(BallDetector, ForgetsTheLastImage) {
  BallDetector of_two = detector();
  shoal::image_t image = image_of(grass);
  paint_ball(image, {1, 0, 0}, 0.11);
  ASSERT_TRUE(of_two.detect(image));
  EXPECT_FALSE(of_two.detect(image_of(grass)));
}

TEST(BallDetector, RefusesOtherImages) {
  shoal::image_t grey = image_of(grass), short_rows = grey, short_data = grey, empty = grey;
  grey.pixelformat = 1497715271;
  short_rows.row_stride = 3 * width - 1;
  short_data.data.pop_back();
  empty.width = 0;
  EXPECT_THROW(detector().detect(grey), shoal::MessageError);
  EXPECT_THROW(detector().detect(short_rows), shoal::MessageError);
  EXPECT_THROW(detector().detect(short_data), shoal::MessageError);
  EXPECT_THROW(detector().detect(empty), shoal::MessageError);
  EXPECT_THROW(BallDetector({.fov_deg = 180}), std::invalid_argument);
  EXPECT_THROW(BallDetector({.ball_radius_m = 0}), std::invalid_argument);
}

}  // namespace
