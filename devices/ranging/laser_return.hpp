// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/physics/physics_world.hpp"
#include "sim/random/noise.hpp"
#include "sim/scene/scene.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Rain, fog or dust between a laser and what it measures.
struct LaserWeather {
  double extinction_per_m = 0;     ///< of the power, each way
  double false_returns_per_m = 0;  ///< returns from drops, per metre of beam: they are 1/this away on average
  double drop_intensity = 0.02;    ///< of such a return
  void read(sim::ParamReader& in);
  bool any() const { return extinction_per_m > 0 || false_returns_per_m > 0; }
};

/// What all laser scanners have in common; read from the device's own map.
struct LaserParams {
  /// Which of several echoes of a beam is reported.
  enum class Returns { strongest, first };

  double range_min_m = 0.05;
  double range_max_m = 30.0;
  double resolution_m = 0;
  double range_std_m = 0;
  double range_std_per_m = 0;
  double dark_range_m = 0;  ///< largest range at which 10 % reflectivity is seen head-on; 0: darkness does not matter
  double beam_divergence_rad = 0;
  int beam_samples = 1;
  double merge_m = 0.3;
  Returns returns = Returns::strongest;
  bool sees_own_vehicle = false;
  std::vector<std::string> see_through;  ///< part categories
  LaserWeather weather;
  sim::NoiseParams noise;  ///< of each range, m
  void read(sim::ParamReader& in);
};

/// What came back along each beam.
struct LaserReturns {
  std::vector<double> ranges_m;
  /// Received power times range squared, as a share of what a white matte surface hit head-on gives in clear air.
  std::vector<double> intensities;
  std::vector<std::uint8_t> returned;  ///< 0: no return

  void assign(std::size_t beams, double range_m);
  std::size_t size() const { return ranges_m.size(); }
};

/// Turns what rays hit into what a laser scanner says.
///
/// The received power is that of the laser range equation for a surface wider than the beam (A. V. Jelalian, Laser
/// Radar Systems, 1992, ch. 1): P ~ rho cos(i) / r^2 exp(-2 alpha r), rho the reflectivity, i the angle of incidence,
/// alpha the extinction of the air.  A share `gloss` of rho is mirrored: it comes back only within some degrees of
/// head-on.
class LaserReceiver {
 public:
  LaserReceiver(const LaserParams& params, const sim::DeviceContext& context);
  void change(const LaserParams& params);

  const sim::RayFilter& filter() const { return filter_; }
  /// Directions that sample a beam along +x of its own frame: evenly over the disc of its divergence, always the same.
  std::span<const sim::Vector3d> beam_pattern() const { return pattern_; }
  /// What surfaces are made of makes no difference: no ray's material has to be looked at.
  bool sees_all() const { return params_.dark_range_m == 0 && !params_.weather.any(); }

  /// What comes back of one beam, from the hits of the rays that sample it.  Leaves beam `i` of `returns` at
  /// range_max_m, with `returned` 0, when all of it is too weak.
  void receive(std::span<const sim::RayHit> hits, std::span<const sim::Ray> rays, LaserReturns& returns, std::size_t i);
  /// The same for one ray.
  void receive(const sim::RayHit& hit, const sim::Vector3d& direction_W, LaserReturns& returns, std::size_t i) const;

  /// Drops, noise and quantisation, in place.
  void disturb(LaserReturns& returns, double dt_s, sim::Random& random);
  void visit_state(sim::StateArchive& archive) { archive(noise_); }

 private:
  struct Echo {
    double range_m, power;
  };
  /// Range-compensated power of a hit, see LaserReturns::intensities.
  double intensity(const sim::RayHit& hit, const sim::Vector3d& direction_W) const;
  /// The least of it that is seen at a range.
  double threshold(double range_m) const;

  const sim::PhysicsWorld& physics_;
  int own_group_;
  LaserParams params_;
  sim::RayFilter filter_;
  sim::NoiseOf<&LaserParams::noise> noise_;
  const sim::NoiseFault& fault_;
  std::vector<sim::Vector3d> pattern_;
  std::vector<Echo> echoes_;  ///< of one beam
};

}  // namespace devices
