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

/// Lens and pixel grid of a camera.
///
/// The camera looks along +x of the sensor frame S, +y is to the left and +z is up.  Image
/// coordinates (u, v) are in pixels from the outer corner of the first pixel, u to the right, v downwards.  The pixel
/// in column i and row j has its center at (i + 0.5, j + 0.5).  OpenCV counts from the center of the first pixel, so
/// its principal point is smaller by 0.5.
///
/// Distortion models: Brown-Conrady (Brown 1971) for the pinhole, Kannala-Brandt (2006) for the fisheye, both with the
/// coefficients of OpenCV.
struct OpticsConfig {
  /// Projection of the lens: pinhole or equidistant fisheye.
  enum class Lens { pinhole, fisheye };
  static constexpr ChoiceWords<Lens> lens_words{{"pinhole", Lens::pinhole}, {"fisheye", Lens::fisheye}};

  int width = 320;
  int height = 240;
  Lens lens = Lens::pinhole;
  double fov_rad = degrees_to_radians(45);         ///< horizontal field of view without distortion
  std::vector<double> focal_px;                    ///< fx and fy, or one value for both; empty: from fov_rad
  std::vector<double> principal_px;                ///< principal point; empty: center of the image
  std::vector<double> distortion;                  ///< pinhole: k1, k2, p1, p2, k3; fisheye: k1 to k4; OpenCV's order
  double max_angle_rad = degrees_to_radians(180);  ///< fisheye: pixels at a larger angle to the axis are empty

  void read(ParamReader& in);
  /// Returns a description of the first invalid value; empty when the configuration is valid.
  std::string problem() const;
  /// Returns all values as YAML, for messages and for comparing lenses.
  std::string text() const;
};

/// Projection between pixels and viewing directions.
class Optics {
 public:
  /// Throws std::invalid_argument unless the focal length is > 0.  Other errors are reported by config.problem().
  explicit Optics(const OpticsConfig& config);

  int width() const { return config_.width; }
  int height() const { return config_.height; }
  double focal_x_px() const { return fx_; }
  double focal_y_px() const { return fy_; }
  const OpticsConfig& config() const { return config_; }

  /// Returns the viewing direction at (u, v) as a unit vector in S; empty outside the field of view of the lens.
  std::optional<Vector3d> direction_S(double u, double v) const;
  /// Returns the image coordinates of a point in S, inside the image or not; empty outside the field of view.
  std::optional<Vector2d> project(const Vector3d& p_S) const;

  /// Returns the distorted radius, in focal lengths from the principal point, at which the distortion stops being
  /// monotonic; infinity when it is monotonic over the whole field of view.
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
  double radial_[4] = {0, 0, 0, 0};  ///< coefficients of r^2, r^4, r^6, r^8
  double p1_ = 0, p2_ = 0;
  bool distorted_ = false;
  double last_good_ = 0;  ///< undistorted radius (pinhole) or angle (fisheye) up to which the radial curve is monotonic
  double fold_radius_ = 0;  ///< distorted_radius(last_good_), or infinity when it is monotonic everywhere
};

/// `flat_port:` of a camera: a plane window before the lens, at a right angle to its axis.
struct FlatPortConfig {
  double distance_m = 0.02;  ///< from the entrance pupil of the lens to the glass
  double glass_m = 0.005;    ///< thickness of the glass
  double glass_index = 1.49;
  bool operator==(const FlatPortConfig&) const = default;
  void read(ParamReader& in);
};

/// Refractive index of water, of all colors.
inline constexpr double water_index = 1.34;

/// Viewing directions of all pixels of an image, computed once.
struct PixelRays {
  int width = 0, height = 0;  ///< size of the image, pixels
  int per_side = 1;           ///< rays per pixel along u and along v
  float pixel_angle = 0;      ///< angle between neighboring rays at the center of the image, rad
  /// Unit vectors row by row, width * per_side in each row.  A zero vector marks a pixel outside the field of view.
  std::vector<Eigen::Vector3f> directions_S;
  /// Where the rays begin, m; empty: at the origin of S.
  std::vector<Eigen::Vector3f> starts_S;
  std::optional<Optics> optics;
  double refraction = 1;  ///< refractive index of the water before a flat port; 1: the rays continue straight

  int columns() const { return width * per_side; }
  const Eigen::Vector3f* row(int row) const { return directions_S.data() + std::size_t(row) * std::size_t(columns()); }
};

/// Returns per_side x per_side evenly spaced rays for each pixel.
std::shared_ptr<const PixelRays> make_pixel_rays(const Optics& optics, int per_side);
/// The same for a camera in water behind a flat port, with a ray from the outer face of the glass in the direction that
/// it has in the water, by Snell's law at both faces: the camera has no single viewpoint (Treibitz et al. 2012).
std::shared_ptr<const PixelRays> make_pixel_rays(const Optics& optics, int per_side, const FlatPortConfig& port);

}  // namespace sim
