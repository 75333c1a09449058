// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/camera/texture.hpp"
#include "sim/camera/water_light.hpp"
#include "sim/medium/medium.hpp"
#include "sim/scene/light.hpp"
#include "sim/scene/scene.hpp"

namespace sim {

/// Optical properties of water at 650, 550 and 450 nm: red, green and blue, 1/m.
struct WaterOptics {
  LinearColor absorption = LinearColor::Zero();
  LinearColor scattering = LinearColor::Zero();
  LinearColor attenuation = LinearColor::Zero();  ///< of a beam: the sum of both
  LinearColor downward = LinearColor::Zero();     ///< of daylight with depth
};

/// Returns the properties of water in which a black target disappears at `visibility_m`, seen horizontally: 4.8 over
/// the beam attenuation at 550 nm (Zaneveld and Pegau 2003).  Absorption of pure water after Pope and Fry (1997),
/// scattering after Morel (1974); particles scatter all colors equally and come with dissolved matter that absorbs blue
/// (Bricaud et al. 1981).  Daylight with depth after Kirk (1984).  More than the 60 m of the clearest natural water
/// thin all properties equally.
WaterOptics water_optics(double visibility_m);

/// Look of water in images: its surface with the waves of the run, reflections of the sky, and the light in it.  Only
/// single scattering and straight rays: objects seen through the surface are where they would be without refraction.
class WaterView {
 public:
  /// `medium` must outlive this and have water.
  WaterView(const Medium& medium, const LightConfig& light, double visibility_m);

  /// Computes the surface around a camera at the present time of the medium.  To be called before each image.
  void update(const Vector3d& eye_W);

  /// Whether the camera is under water.
  bool is_under() const { return light_.is_under; }
  /// Returns the exposure of the image: under water it follows the daylight at the depth of the camera.
  float gain() const { return gain_; }
  /// Returns the range at which a ray from the camera crosses the surface; infinity: not before `range_max_m`.
  double crossing_m(const Vector3d& direction_W, double range_max_m) const;
  /// Returns the share of daylight at a height.
  LinearColor daylight(double z_m) const;

  /// Sets directions, crossings and the surface there of `lit`, for rays from the camera; lit.range_m is already set.
  void find_surface(std::span<const Ray> rays, WaterRays& lit) const;
  /// Replaces the light of what the rays see by that of the rays.
  void light(WaterRays& rays) const { light_water(light_, sky_, rays); }

 private:
  /// Surface at a point of a grid.
  struct Point {
    float elevation_m = 0, slope_x = 0, slope_y = 0;
  };
  /// Waves on a square grid around the camera, row by row from the south-west.
  struct Level {
    double spacing_m = 0;
    std::vector<Point> points;
    float rough = 0;  // mean square slope of the waves that the grid cannot show
  };
  struct Surface {
    float elevation_m = 0, slope_x = 0, slope_y = 0, rough = 0;
  };
  /// South-west corner of the cell that contains a place, and the place in it, 0 to 1.
  struct Cell {
    const Point* corner = nullptr;
    float right = 0, up = 0;
  };
  /// Finest grid for a place, and how far it is towards the border of this grid, 0 to 1.
  struct Place {
    std::size_t level = 0;
    float share = 0;
  };

  void fill(Level& level) const;
  Cell cell_of(const Level& level, double x_m, double y_m) const;
  Place place_of(const Vector3d& p_W) const;
  float elevation_m(const Vector3d& p_W) const;
  Surface sample(const Level& level, double x_m, double y_m) const;
  Surface surface_at(const Vector3d& p_W) const;
  double wave_crossing_m(const Vector3d& direction_W, double range_max_m) const;

  const Medium& medium_;
  WaterOptics optics_;
  SkyLight sky_;
  WaterLight light_;
  float day_;  // strength of daylight on the surface
  Vector3d eye_W_ = Vector3d::Zero();
  double level_m_ = 0;    // of the still surface
  double highest_m_ = 0;  // bound of waves over it
  float gain_ = 1;
  double now_s_ = 0;
  double steep_ = 0;  // slope that waves seldom exceed: twice the root mean square
  std::vector<Level> levels_;
};

}  // namespace sim
