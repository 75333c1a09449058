// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/vision/ball_detector.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "shoal/message_codec.hpp"
#include "sim/base/math.hpp"

namespace autonomy {

namespace {

/// FourCC of bot_core's image_t.
constexpr std::int32_t pixel_format_rgb = 859981650;
constexpr int channels = 3;

/// Sums over the pixels of a group.
struct Group {
  int pixels = 0;
  double column_sum = 0, row_sum = 0;
  bool cut = false;
};

void check(const shoal::image_t& image) {
  if (image.pixelformat != pixel_format_rgb)
    throw shoal::MessageError("needs a raw RGB image, got pixel format " + std::to_string(image.pixelformat));
  if (image.width < 1 || image.height < 1 || image.row_stride < std::int64_t{channels} * image.width)
    throw shoal::MessageError("rows of the image are shorter than its width");
  if (std::int64_t{image.row_stride} * image.height > static_cast<std::int64_t>(image.data.size()))
    throw shoal::MessageError("the image has " + std::to_string(image.data.size()) + " bytes, fewer than its rows");
}

}  // namespace

double range_of_sphere(double radius_m, double area_px, double focal_px, double off_axis_rad) {
  const double cos2 = std::cos(off_axis_rad) * std::cos(off_axis_rad);
  const double area = area_px / (std::numbers::pi * focal_px * focal_px);
  // The area grows with s = sin^2 a, from 0 at s = 0 to infinity at s = cos^2 t.
  double low = 0, high = cos2;
  for (int i = 0; i < 60; ++i) {
    const double s = (low + high) / 2;
    (s * std::sqrt(1 - s) < area * std::pow(cos2 - s, 1.5) ? low : high) = s;
  }
  return radius_m / std::sqrt(high);
}

BallDetector::BallDetector(const Params& params) : params_(params) {
  if (!(params.fov_deg > 0 && params.fov_deg < 180))
    throw std::invalid_argument("the field of view must be above 0 and below 180 degrees");
  if (!(params.ball_radius_m > 0)) throw std::invalid_argument("the radius of the ball must be above 0");
}

bool BallDetector::is_ball(int red, int green, int blue) const {
  return red >= params_.min_red && red - blue >= params_.min_saturation * red &&
         green >= params_.min_green_share * red && green <= params_.max_green_share * red;
}

std::optional<BallSighting> BallDetector::detect(const shoal::image_t& image) {
  check(image);
  const int width = image.width, height = image.height;

  // Pixels with the color of the ball.
  mask_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  for (int row = 0; row < height; ++row) {
    const std::uint8_t* pixel = image.data.data() + std::ptrdiff_t{row} * image.row_stride;
    std::uint8_t* mask = mask_.data() + std::ptrdiff_t{row} * width;
    for (int column = 0; column < width; ++column, pixel += channels)
      mask[column] = is_ball(pixel[0], pixel[1], pixel[2]) ? 1 : 0;
  }

  // The largest group of pixels that are connected by their sides.
  Group largest;
  for (int first = 0; first < width * height; ++first) {
    if (mask_[static_cast<std::size_t>(first)] == 0) continue;
    Group group;
    const auto visit = [&](int index) {
      std::uint8_t& mask = mask_[static_cast<std::size_t>(index)];
      if (mask != 0) open_.push_back(index);
      mask = 0;
    };
    visit(first);
    while (!open_.empty()) {
      const int index = open_.back(), column = index % width, row = index / width;
      open_.pop_back();
      ++group.pixels;
      group.column_sum += column + 0.5;
      group.row_sum += row + 0.5;
      if (column == 0 || row == 0 || column == width - 1 || row == height - 1) group.cut = true;
      if (column > 0) visit(index - 1);
      if (column < width - 1) visit(index + 1);
      if (row > 0) visit(index - width);
      if (row < height - 1) visit(index + width);
    }
    if (group.pixels > largest.pixels) largest = group;
  }
  if (largest.pixels < params_.min_pixels) return std::nullopt;

  // Direction and range of the ball.
  const double focal_px = width / 2.0 / std::tan(sim::degrees_to_radians(params_.fov_deg) / 2);
  const double left_px = width / 2.0 - largest.column_sum / largest.pixels;
  const double up_px = height / 2.0 - largest.row_sum / largest.pixels;
  BallSighting sighting;
  sighting.utime = image.utime;
  sighting.bearing_rad = std::atan2(left_px, focal_px);
  sighting.elevation_rad = std::atan2(up_px, std::hypot(focal_px, left_px));
  const double off_axis_rad = std::atan2(std::hypot(left_px, up_px), focal_px);
  sighting.range_m = range_of_sphere(params_.ball_radius_m, largest.pixels, focal_px, off_axis_rad);
  sighting.pixels = largest.pixels;
  sighting.cut = largest.cut;
  return sighting;
}

}  // namespace autonomy
