// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/camera/marine_snow.hpp"
#include "sim/camera/texture.hpp"
#include "sim/camera/water_light.hpp"
#include "sim/camera/water_optics.hpp"
#include "sim/medium/medium.hpp"
#include "sim/scene/light.hpp"
#include "sim/scene/scene.hpp"

namespace sim {

/// What a WaterView shows.
struct WaterLook {
  WaterOptics optics;
  double waves_range_m = 2500;  ///< waves farther away only roughen the surface
  bool caustics = false;        ///< sunlight that ripples focus
  double particles_per_m3 = 0;  ///< marine snow
  std::uint64_t seed = 0;       ///< of caustics and particles
};

/// Look of water in images: its surface with the waves of the run, reflections of the sky, and the light in it.  Only
/// single scattering and straight rays: objects seen through the surface are where they would be without refraction.
class WaterView {
 public:
  /// `medium` must outlive this and have water.
  WaterView(const Medium& medium, const LightConfig& light, const WaterLook& look);

  /// Computes the surface around a camera at the present time of the medium.  To be called before each image.
  void update(const Vector3d& eye_W);

  /// Whether the camera is under water.
  bool is_under() const { return light_.is_under; }
  /// Returns the exposure of the image, a gain of each color: under water it follows the daylight at the depth of the
  /// camera and the water before what it shows, so that a gray surface 3 m away looks gray.  The gain of a color is at
  /// most 24 times that of another.
  const LinearColor& gain() const { return gain_; }
  /// Returns the range at which a ray from the camera crosses the surface; infinity: not before `range_max_m`.
  double crossing_m(const Vector3d& direction_W, double range_max_m) const;
  /// Returns the share of daylight at a height.
  LinearColor daylight(double z_m) const;
  /// Whether sunlight under water has a pattern.
  bool has_caustics() const { return has_caustics_; }
  /// Returns the factor of the sunlight at a point by the focusing of ripples; 1 above the water.  Its mean over a
  /// horizontal plane is 1.  Ripples of lengths from 0.2 to 2 m share the mean square slope of the wind (Cox and Munk
  /// 1954); the light is that of their curvature, to first order in the depth, with a log-normal distribution, and
  /// smooths out with depth.
  float caustic(const Vector3d& p_W) const;
  /// Draws particles before a camera under water into rows of its image.
  void draw_particles(const Pose& X_WS, const Optics& optics, double refraction, std::span<const LampLight> lamps,
                      const MarineSnow::Target& target) const;
  bool has_particles() const { return !snow_.empty(); }

  /// Sets directions, crossings and the surface there of `lit`, for rays from the camera; lit.range_m is already set.
  void find_surface(std::span<const Ray> rays, WaterRays& lit) const;
  /// Replaces the light of what the rays see by that of the rays.
  void light(WaterRays& rays) const { light_water(light_, sky_, rays); }
  const WaterLight& water_light() const { return light_; }

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

  /// Ripple that focuses sunlight.
  struct Ripple {
    float x_radpm = 0, y_radpm = 0;  ///< wave number
    float omega_radps = 0, phase_rad = 0;
    float focus_pm = 0;  ///< amplitude of the change of the light with depth, 1/m
    float now_rad = 0;   ///< phase at the time of the image
  };

  void make_ripples(std::uint64_t seed);
  void set_gain();
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
  LinearColor gain_ = LinearColor::Ones();
  double now_s_ = 0;
  double steep_ = 0;  // slope that waves seldom exceed: twice the root mean square
  std::vector<Level> levels_;
  double waves_range_m_;
  bool has_caustics_;
  std::array<Ripple, 8> ripples_;
  Eigen::Vector2f sun_slant_ = Eigen::Vector2f::Zero();  // horizontal way of sunlight per meter of depth
  MarineSnow snow_;
};

}  // namespace sim
