// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

using Vector2d = Eigen::Vector2d;

/// The lens of a camera and the grid of its pixels.
///
/// The camera looks along +x of the sensor frame S, +y is to the left and +z is up.  A place in the image is (u, v) in
/// pixels from the outer corner of the first pixel: u to the right, v downwards; the pixel in column i and row j has
/// its centre at (i + 0.5, j + 0.5).  OpenCV counts from the centre of the first pixel: its principal point is 0.5
/// less.
struct OpticsConfig {
  enum class Lens { pinhole, fisheye };
  static constexpr ChoiceWords<Lens> lens_words{{"pinhole", Lens::pinhole}, {"fisheye", Lens::fisheye}};

  int width = 320;
  int height = 240;
  Lens lens = Lens::pinhole;
  double fov_rad = degrees_to_radians(45);         ///< horizontal, of the lens without distortion
  std::vector<double> focal_px;                    ///< fx, fy or one for both; empty: from the field of view
  std::vector<double> principal_px;                ///< empty: the middle of the image
  std::vector<double> distortion;                  ///< pinhole: k1, k2, p1, p2, k3; fisheye: k1 to k4; OpenCV's order
  double max_angle_rad = degrees_to_radians(180);  ///< fisheye: pixels farther off the axis are empty

  void read(ParamReader& in);
  /// What is wrong with it; empty: nothing.
  std::string problem() const;
  /// All values as YAML, for messages and to tell lenses apart.
  std::string text() const;
};

/// Viewing direction of each pixel.
class Optics {
 public:
  /// Throws std::invalid_argument when there is no focal length > 0; the rest is up to config.problem().
  explicit Optics(const OpticsConfig& config);

  int width() const { return config_.width; }
  int height() const { return config_.height; }
  double focal_x_px() const { return fx_; }
  double focal_y_px() const { return fy_; }
  const OpticsConfig& config() const { return config_; }

  /// Unit vector in S of the viewing direction at (u, v) in the image; nothing outside the lens's field of view.
  std::optional<Vector3d> direction_S(double u, double v) const;
  /// Where a point in S is seen, inside the image or not; nothing when the lens cannot see it.
  std::optional<Vector2d> project(const Vector3d& p_S) const;

  /// The distortion folds over at this distance from the principal point (in units of the focal length, distorted);
  /// infinity: nowhere.
  double fold_radius() const { return fold_radius_; }

 private:
  double distorted_radius(double undistorted) const;
  double distorted_slope(double undistorted) const;
  void find_fold();
  double undistorted_radius(double distorted) const;
  Vector2d distort(const Vector2d& p) const;
  Eigen::Matrix2d distort_slope(const Vector2d& p) const;
  std::optional<Vector2d> undistort(const Vector2d& distorted) const;

  OpticsConfig config_;
  bool fisheye_;
  double fx_ = 1, fy_ = 1, cx_ = 0, cy_ = 0;
  double radial_[4] = {0, 0, 0, 0};  ///< of r^2, r^4, r^6, r^8
  double p1_ = 0, p2_ = 0;
  bool distorted_ = false;
  double last_good_ = 0;    ///< undistorted radius (pinhole) or angle (fisheye) up to which the radial curve rises
  double fold_radius_ = 0;  ///< distorted_radius(last_good_), or infinity when it never folds
};

/// The directions of a whole image, computed once.
struct PixelRays {
  int width = 0, height = 0;  ///< of the image
  int per_side = 1;           ///< rays of a pixel along u and along v
  float pixel_angle = 0;      ///< angle between neighbouring rays in the middle of the image
  /// Row by row, (width * per_side) in a row.  Zero: sees nothing.
  std::vector<Eigen::Vector3f> directions_S;

  int columns() const { return width * per_side; }
  const Eigen::Vector3f* row(int row) const { return directions_S.data() + std::size_t(row) * std::size_t(columns()); }
};

/// `per_side` x `per_side` rays for each pixel, evenly spread.
std::shared_ptr<const PixelRays> make_pixel_rays(const Optics& optics, int per_side);

}  // namespace sim
