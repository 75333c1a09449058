// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/camera/texture.hpp"
#include "sim/medium/medium.hpp"
#include "sim/scene/light.hpp"

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
  bool is_under() const { return is_under_; }
  /// Returns the exposure of the image: under water it follows the daylight at the depth of the camera.
  float gain() const { return gain_; }
  /// Returns the range at which a ray from the camera crosses the surface; infinity: not before `range_max_m`.
  double crossing_m(const Vector3d& direction_W, double range_max_m) const;
  /// Returns the share of daylight at a height.
  LinearColor daylight(double z_m) const;

  /// Returns the light on a ray from the camera: `seen` at `range_m` behind a surface at `crossing_m`; both may be
  /// infinite.  `sky` returns the light of the sky in a direction.
  template <typename Sky>
  LinearColor light(const Vector3d& direction_W, double crossing_m, double range_m, const LinearColor& seen,
                    Sky&& sky) const {
    const Crossing at =
        is_under_ ? from_below(direction_W, crossing_m, range_m) : from_above(direction_W, crossing_m, range_m);
    LinearColor sum = at.own + at.passed.cwiseProduct(seen);
    if (at.sky_share > 0) sum += at.through.cwiseProduct(at.sky_share * sky(at.sky_direction_W));
    return sum;
  }

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
    Eigen::Vector3f normal_W() const { return Eigen::Vector3f(-slope_x, -slope_y, 1).normalized(); }
  };
  /// Parts of the light on a ray.
  struct Crossing {
    LinearColor own = LinearColor::Zero();     // light of the water and of the sun on it
    LinearColor passed = LinearColor::Ones();  // share of the light at the end of the ray
    LinearColor through = LinearColor::Ones();
    float sky_share = 0;
    Eigen::Vector3f sky_direction_W = Eigen::Vector3f::UnitZ();
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
  LinearColor share_after(float path_m) const;
  /// Returns the daylight that the water scatters into a ray; `source`: per metre at its start.
  LinearColor veil(const LinearColor& source, float down, float path_m) const;
  Crossing from_above(const Vector3d& direction_W, double crossing_m, double range_m) const;
  Crossing from_below(const Vector3d& direction_W, double crossing_m, double range_m) const;

  const Medium& medium_;
  WaterOptics optics_;
  Eigen::Vector3f to_sun_W_;
  LinearColor sun_;
  float day_;             // strength of daylight on the surface
  float wind_slope_ = 0;  // mean square slope of ripples (Cox and Munk 1954)
  Vector3d eye_W_ = Vector3d::Zero();
  double level_m_ = 0;    // of the still surface
  double highest_m_ = 0;  // bound of waves over it
  bool is_under_ = false;
  float gain_ = 1;
  double now_s_ = 0;
  double steep_ = 0;  // slope that waves seldom exceed: twice the root mean square
  LinearColor at_surface_ = LinearColor::Zero(), at_eye_ = LinearColor::Zero();  // daylight scattered per metre
  std::vector<Level> levels_;
};

}  // namespace sim
