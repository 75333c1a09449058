// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "shoal/image_t.hpp"

namespace autonomy {

/// A ball as seen in one image.
struct BallSighting {
  std::int64_t utime = 0;    ///< time of the image
  double bearing_rad = 0;    ///< of its center from the optical axis, positive to the left
  double elevation_rad = 0;  ///< of its center above the plane of the optical axis and the rows
  double range_m = 0;        ///< from the camera to its center, by its area in the image
  int pixels = 0;
  bool cut = false;  ///< it touches the border of the image: its range is less than `range_m`
};

/// Finds an orange ball of known radius in color images of a pinhole camera without distortion: pixels by their
/// color, then the largest connected group of them.
class BallDetector {
 public:
  struct Params {
    double fov_deg = 60;  ///< horizontal field of view of the camera
    double ball_radius_m = 0.11;
    int min_pixels = 4;                                     ///< a smaller group is noise
    int min_red = 50;                                       ///< darker pixels have no reliable hue
    double min_saturation = 0.5;                            ///< (red - blue) / red
    double min_green_share = 0.15, max_green_share = 0.72;  ///< green / red: 0 is red, 1 yellow
  };

  /// Throws std::invalid_argument for a field of view or a radius that is not possible.
  explicit BallDetector(const Params& params);
  /// Returns the largest ball in the image, if there is one.  Throws shoal::MessageError when the image is not raw RGB,
  /// or has fewer bytes than its size requires.
  std::optional<BallSighting> detect(const shoal::image_t& image);
  /// Whether a pixel has the color of the ball; levels in sRGB, 0 to 255.
  bool is_ball(int red, int green, int blue) const;

 private:
  Params params_;
  std::vector<std::uint8_t> mask_;  ///< 1: color of the ball, not yet in a group
  std::vector<int> open_;           ///< pixels of the present group whose neighbors are to be visited
};

/// Range of the center of a sphere from its area in the image of a pinhole camera.  The cone of its rays has the half
/// angle a, sin a = radius / range, and its axis the angle t to the optical axis; the image plane cuts it in an ellipse
/// with the half axes f sin a cos a / (cos^2 t - sin^2 a) and f sin a / sqrt(cos^2 t - sin^2 a).
double range_of_sphere(double radius_m, double area_px, double focal_px, double off_axis_rad);

}  // namespace autonomy
