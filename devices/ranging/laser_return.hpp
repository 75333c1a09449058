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

/// Effect of rain, fog or dust on a laser beam.
struct LaserWeather {
  double extinction_per_m = 0;     ///< extinction coefficient of the power, one way
  double false_returns_per_m = 0;  ///< rate of returns from drops; mean range is its inverse
  double drop_intensity = 0.02;    ///< intensity of a return from a drop
  void read(sim::ParamReader& in);
  bool any() const { return extinction_per_m > 0 || false_returns_per_m > 0; }
};

/// Parameters common to all laser scanners; read from the map of the device.
struct LaserParams {
  /// Selection of the echo of a beam that is reported.
  enum class Returns { strongest, first };

  double range_min_m = 0.05;
  double range_max_m = 30.0;
  double resolution_m = 0;
  double range_std_m = 0;
  double range_std_per_m = 0;
  double dark_range_m = 0;  ///< range limit for 10 % reflectivity at normal incidence; 0: no limit
  double beam_divergence_rad = 0;
  int beam_samples = 1;
  double merge_m = 0.3;
  Returns returns = Returns::strongest;
  bool sees_own_vehicle = false;
  std::vector<std::string> see_through;  ///< part categories
  LaserWeather weather;
  sim::NoiseParams noise;  ///< error of each range, m
  void read(sim::ParamReader& in);
};

/// Returns of a scan, one per beam.
struct LaserReturns {
  /// Kinds of `returned`.  Without an echo the range is a limit: the largest, or the smallest if something is nearer.
  static constexpr std::uint8_t none = 0, echo = 1, too_near = 2;

  std::vector<double> ranges_m;
  /// Received power times range squared, relative to a white Lambert surface at normal incidence in clear air.
  std::vector<double> intensities;
  std::vector<std::uint8_t> returned;

  /// Sets the number of beams, all without return at `range_m`.
  void assign(std::size_t beams, double range_m);
  /// Sets a beam that has no echo.
  void set_limit(std::size_t beam, std::uint8_t kind, double range_m);
  std::size_t size() const { return ranges_m.size(); }
};

/// Converts hits of rays to returns of a laser scanner.
///
/// The received power is that of the laser range equation for a surface wider than the beam (A. V. Jelalian, Laser
/// Radar Systems, 1992, ch. 1): P ~ rho cos(i) / r^2 exp(-2 alpha r), rho the reflectivity, i the angle of incidence,
/// alpha the extinction coefficient.  A share `gloss` of rho is specular reflection and returns only within a
/// few degrees of normal incidence.
class LaserReceiver {
 public:
  LaserReceiver(const LaserParams& params, const sim::DeviceContext& context);
  void change(const LaserParams& params);

  const sim::RayFilter& filter() const { return filter_; }
  /// Returns the fixed directions that sample a beam along +x of its frame, evenly over its divergence.
  std::span<const sim::Vector3d> beam_pattern() const { return pattern_; }
  /// Returns true when the materials of surfaces have no effect on the ranges.
  bool sees_all() const { return params_.dark_range_m == 0 && !params_.weather.any(); }

  /// Computes the return of beam `i` from the hits of the rays that sample it.  Without a detectable echo the range is
  /// range_max_m, or range_min_m when something is nearer than that.
  void receive(std::span<const sim::RayHit> hits, std::span<const sim::Ray> rays, LaserReturns& returns, std::size_t i);
  /// Computes the return of a beam with one ray.
  void receive(const sim::RayHit& hit, const sim::Vector3d& direction_W, LaserReturns& returns, std::size_t i) const;

  /// Applies returns from drops, noise and quantization in place.  A range that leaves the limits is not an echo any
  /// more.
  void disturb(LaserReturns& returns, double dt_s, sim::Random& random);
  void visit_state(sim::StateArchive& archive) { archive(noise_); }

 private:
  /// Echo along one ray of a beam.
  struct Echo {
    double range_m, power;
  };
  /// Returns the range-compensated power of a hit, see LaserReturns::intensities.
  double intensity(const sim::RayHit& hit, const sim::Vector3d& direction_W) const;
  /// Sets beam `i` to an echo, which is too near below range_min_m.
  void set_return(LaserReturns& returns, std::size_t i, double range_m, double power) const;
  /// Returns the minimum detectable intensity at a range.
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
