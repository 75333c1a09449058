// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/acoustics/propagation/multipath.hpp"
#include "sim/acoustics/propagation/signal.hpp"
#include "sim/acoustics/rays/eigenrays.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/random/random.hpp"

namespace sim {

class RayTables;
struct SoundRay;

/// Propagation of sound through the water of a world, configured by `acoustics:`.
class Propagation {
 public:
  /// The arguments must outlive the object.
  Propagation(const AcousticsConfig& config, const Medium& medium, const PhysicsWorld& physics);
  ~Propagation();

  /// Whether sound travels along rays instead of straight lines.
  bool bends() const { return rays_ != nullptr; }
  /// The arrival to which a receiver locks: see first_path().  Without any, the straight line.
  struct First {
    double travel_time_s = 0;
    Vector3d leaves_W = Vector3d::UnitX(), arrives_W = Vector3d::UnitX();  ///< unit vectors along the sound
    bool shadow = false;  ///< no ray without a bounce reaches the receiver
  };
  First first_arrival(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const;

  /// Path gain: received level relative to the source level at 1 m on the axis.
  struct Gain {
    Decibels signal;             ///< minus infinity: no reception
    PowerRatio disturbing;       ///< power of echoes that arrive after the window
    bool blocked = false;        ///< the direct path is blocked
    double later_s = 0;          ///< delay of an echo relative to the blocked direct path
    std::optional<First> first;  ///< rays: the first arrival
    /// Echo with the loss of its path relative to that of the first arrival.
    struct Echo {
      double later_s = 0;
      PowerRatio relative;
      Vector3d arrives_W = Vector3d::UnitX();
    };
    std::vector<Echo> echoes;  ///< within the window; only for `echo_lock:`
  };
  /// Computes the gain of a path.  Random draws: phases of the echoes, then fading.  The groups are those of the
  /// vehicles at both ends, whose hulls do not block the path.
  Gain gain(const Vector3d& from_W, int from_group, const Vector3d& to_W, int to_group, double frequency_Hz,
            Random& random) const;
  /// Loss by spreading and absorption along the straight line.
  Decibels transmission_loss(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const;
  /// Whether gain() draws random numbers.
  bool draws() const { return config_.multipath.has_value() || config_.fading.type != FadingConfig::Type::none; }
  /// Ambient noise of a band: re 1 uPa.
  Decibels ambient_level(double centre_Hz, double bandwidth_Hz) const;
  /// Power of the same, reduced by a directivity index, re 1 uPa^2.
  PowerRatio ambient_power(double centre_Hz, double bandwidth_Hz, Decibels less) const;
  /// Range beyond which a signal is more than `below` under the noise on any path at most `deepest_m` below the
  /// surface.  With rays practical spreading (15 log r) covers ducts and convergence zones: these are louder than
  /// spherical spreading by up to 10 dB at 100 m, 20 dB at 10 km.
  double audible_range_m(const Signal& signal, Decibels below, double deepest_m = deepest_sea_m) const;
  static constexpr double deepest_sea_m = 12000;
  /// Free fraction of the first Fresnel zone with terrain, objects and hulls as obstacles: 1 all, 0 none.
  double free_part(const Vector3d& from_W, int from_group, const Vector3d& to_W, int to_group,
                   double frequency_Hz) const;

 private:
  /// Sound between two points: gain and elevation at both ends of each ray, and of what leaks into a shadow.
  struct Arrivals;
  Arrivals arrivals(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const;
  std::vector<SoundRay> rays_between(const Vector3d& from_W, const Vector3d& to_W) const;
  bool is_at_edge_of_shadow(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const;
  /// As gain() without fading.  `direct`: gain of rays without a bounce due to an obstacle.
  Gain gain_of_rays(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz, Decibels direct,
                    Random& random) const;
  /// Echoes of straight paths, for `echo_lock:`.
  std::vector<Gain::Echo> straight_echoes(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const;
  LinkDepths link_depths(const Vector3d& from_W, const Vector3d& to_W) const;
  MultipathMedium water_between(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz) const;
  Echoes echoes_of(const Vector3d& from_W, const Vector3d& to_W, double frequency_Hz, Decibels direct,
                   Random& random) const;
  /// Depths at which the minimum absorption is tabulated.
  static constexpr std::array<double, 12> depths_m{0, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, deepest_sea_m};
  /// Minimum absorption between the surface and each of depths_m.
  std::array<double, depths_m.size()> min_absorption_dBpkm(double frequency_Hz) const;
  /// Depth of the bottom below the surface; infinite when there is no bottom.
  double water_depth_m(const Vector3d& p_W) const;

  std::unique_ptr<RayTables> rays_;  // null: straight lines

  /// Values of a band that are constant in a run, as mean wind and water are.
  struct Band {
    double centre_Hz, bandwidth_Hz;
    Decibels ambient;
    PowerRatio ambient_power;
    std::array<double, depths_m.size()> min_dBpkm;
  };
  Band band(double centre_Hz, double bandwidth_Hz) const;

  const AcousticsConfig& config_;
  const Medium& medium_;
  const PhysicsWorld& physics_;
  mutable std::vector<Band> bands_;  // cache
};

/// Returns how sound travels in water with or without a profile of its speed.
inline SoundPaths sound_paths(const AcousticsConfig& acoustics, bool has_profile) {
  return acoustics.propagation.value_or(has_profile ? SoundPaths::rays : SoundPaths::straight);
}

/// Returns the spreading of sound along straight lines: spherical where the other sound travels along rays, whose tubes
/// are the spreading.
inline SpreadingConfig straight_spreading(const AcousticsConfig& acoustics, bool has_profile) {
  SpreadingConfig spherical;
  spherical.factor = 2;
  return sound_paths(acoustics, has_profile) == SoundPaths::rays ? spherical : acoustics.spreading;
}

/// Computes gain and phase of rays, in their order: spreading by the ray tube (nothing is louder than at 1 m), by waves
/// where twins merge at a caustic, absorption, bounces, and the caustics that they have passed.  `multipath`: needed
/// for rays with bounces.
std::vector<PathGain> ray_gains(std::span<const SoundRay> rays, const MultipathConfig* multipath,
                                const MultipathMedium& water);

/// Path to which a receiver locks: the earliest one at most `first_path_dB` weaker than the strongest.  There
/// must be a path.
std::size_t first_path(std::span<const PathGain> paths);
inline constexpr double first_path_dB = 10;

}  // namespace sim
