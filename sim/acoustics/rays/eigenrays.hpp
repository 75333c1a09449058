// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/acoustics/rays/ray_legs.hpp"
#include "sim/acoustics/rays/sound_profile.hpp"

namespace sim {

/// Ray from a source to a receiver.  Elevations are angles over the horizontal, upwards positive, of the direction in
/// which the sound travels.
struct SoundRay {
  double travel_time_s = 0;
  double launch_rad = 0, arrival_rad = 0;
  int surface_bounces = 0, bottom_bounces = 0;
  int turns = 0;                                           ///< turning points inside the water
  int caustics = 0;                                        ///< passed; each delays the phase by a quarter period
  double surface_grazing_rad = 0, bottom_grazing_rad = 0;  ///< at each bounce
  double power_per_m2 = 0;  ///< squared pressure relative to that at 1 m, by the ray tube; large near a caustic
  /// The ray with which it merges at a caustic.
  struct Twin {
    double later_s = 0;            ///< its travel time less that of this ray
    double fold_power_per_m2 = 0;  ///< as power_per_m2, of a caustic at the middle of both: near it
  };
  std::optional<Twin> twin;  ///< unset: it has none
  int bounces() const { return surface_bounces + bottom_bounces; }
};

/// Ends of the rays that are sought.
struct RayQuery {
  double source_m = 0, receiver_m = 0;  ///< depths, in the water
  double range_m = 0;                   ///< horizontal
  double water_m = 0;                   ///< depth of a flat bottom; infinite: none
  int max_bounces = 0;                  ///< at surface and bottom together
};

/// Searches the rays between two points in water whose speed of sound depends on the depth alone.
///
/// Rays form families by their launch direction and the number of upper and lower turning points or bounces.  Within a
/// family the range is a smooth function of xi between the values of 1 / c at the knots of the profile; it is tabulated
/// there once, and each crossing of the wanted range is solved by Newton's method inside a bracket.  All results are
/// functions of the profile and the query alone.  docs/models/acoustic_rays.md has the equations.
class Eigenrays {
 public:
  explicit Eigenrays(SoundProfile profile);
  const SoundProfile& profile() const { return profile_; }

  /// Finds the rays, sorted by travel time.  Depths outside the water are moved to its border.  Replaces `rays`.
  void find(const RayQuery& query, std::vector<SoundRay>& rays) const;

  static constexpr int nodes = 3;  ///< of the table in each interval of xi

 private:
  /// Interval of xi between the values of 1 / c at two knots.
  struct Interval {
    double low_mps, high_mps;        ///< speeds at which its rays turn
    std::vector<std::int32_t> last;  ///< for each knot the last one of the rays through it; -1: beyond a turning point
    std::vector<std::int32_t> first;
    std::array<double, nodes> xi;
    std::vector<RayReach> from_end;  ///< node by node: from the upper end of the ray to each knot
    std::vector<RayReach> whole;     ///< node by node, by last knot: from the upper to the lower end
  };
  struct Search;

  Interval tabulate(double low_mps, double high_mps) const;
  RayLegs legs_of(const Interval& interval, int node, const RayDepths& depths) const;

  SoundProfile profile_;
  std::vector<Interval> intervals_;  // by falling xi: rising speed
};

}  // namespace sim
