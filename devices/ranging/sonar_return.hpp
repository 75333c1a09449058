// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/scene/scene.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Parameters common to all sonars; read from the map of the device.  Levels are in dB re 1 uPa.
struct SonarParams {
  /// Medium in which the sonar receives echoes.
  enum class WorksIn { water, air, any };
  /// Time-varied gain: 20 or 40 log10 r plus two-way absorption.
  enum class Gain { none, log20, log40 };

  double range_min_m = 0.1;
  double range_max_m = 50;
  WorksIn works_in = WorksIn::water;
  std::optional<double> sound_speed_mps;          ///< unset: from the medium; 1500 in a world without water
  std::optional<double> assumed_sound_speed_mps;  ///< for conversion of time to range; unset: true speed
  std::optional<double> absorption_dBpkm;         ///< unset: from the frequency, or 0 without frequency
  std::optional<double> frequency_kHz;
  bool surface_echo = false;
  double surface_backscatter_dB = -30;
  double source_level_dB = 200;  ///< re 1 uPa at 1 m
  double pulse_s = 1e-4;
  Gain tvg = Gain::none;
  bool speckle = true;
  bool sees_own_vehicle = false;
  std::vector<std::string> see_through;  ///< part categories
  void read(sim::ParamReader& in);
};

/// Detection of echoes by a threshold.
struct SonarDetectionParams {
  double threshold_dB = 80;
  void read(sim::ParamReader& in);
};

/// Ray that samples a sonar beam.
struct SonarRay {
  sim::Vector3d direction_S;
  double solid_angle_sr = 0;  ///< solid angle that the ray represents
  double weight = 1;          ///< two-way beam pattern, relative power
};

/// Returns the one-way power response of a Gaussian beam at an angle off its axis; `width_rad` is the full -3 dB width.
double beam_response(double off_axis_rad, double width_rad);

/// Echo along one ray.
struct SonarEcho {
  double range_m = 0;
  double power_uPa2 = 0;  ///< at the receiver
};

/// Echo levels by the active sonar equation with Lambert scattering.  A ray with solid angle w covers the area
/// A = w r^2 / cos(i), with i the angle of incidence.  The scattering strength is S = 10 log mu + 10 log cos^2(i), and
///   EL = SL - 40 log r - 2 a r + S + 10 log A + 10 log b^2,
/// so that the power of one ray is SL b^2 mu cos(i) w r^-2 10^(-a r / 5) (Urick, Principles of Underwater Sound, 3rd
/// ed., ch. 2 and 8; Lambert's rule: Mackenzie 1961).  Echoes of targets that fill the beam thus decrease with 20 log
/// r, those of smaller targets with 40 log r.  Echoes are added incoherently (in power), as for rough surfaces.
///
/// In a world with water a sonar outside its medium receives no echoes, and its rays end at the water surface, which is
/// assumed to be horizontal at the end of each ray.  Speed of sound and absorption are those at the sensor.
class SonarReceiver {
 public:
  SonarReceiver(const SonarParams& params, const sim::DeviceContext& context);
  void change(const SonarParams& params);

  const sim::RayFilter& filter() const { return filter_; }
  /// Updates the medium and casts the rays from the pose of the sensor; hits() and rays_W() return the results.
  void cast(const sim::Scene& scene, const sim::Pose& X_WS, std::span<const SonarRay> rays_S);
  std::span<const sim::RayHit> hits() const { return hits_; }
  std::span<const sim::Ray> rays_W() const { return rays_W_; }
  /// Returns the echo along one ray of the last cast, at its true range.  Power is 0 without a hit and for echoes below
  /// the minimum range.
  SonarEcho echo(std::size_t ray, const SonarRay& ray_S) const;
  /// Returns the absolute derivative of the range with respect to a rotation of the ray towards `tangent_W`, m/rad.
  double range_slope(std::size_t ray, const sim::Vector3d& tangent_W) const;
  /// Returns the time-varied gain of the receiver at a range, dB.
  double gain_dB(double range_m) const;
  /// Returns the range resolution, half the length of a pulse, m.
  double pulse_m() const { return sound_speed_mps_ * params_.pulse_s / 2; }
  /// Returns the ratio of measured to true ranges: assumed over true speed of sound.
  double range_scale() const { return range_scale_; }
  /// Archives the last properties of the medium, which apply while the sonar is outside its medium.
  void visit_state(sim::StateArchive& archive) { archive(sound_speed_mps_, absorption_dBpm_, range_scale_); }

 private:
  /// Updates the properties of the medium at the sensor.  Returns false when the sonar is outside its medium.
  bool update_medium(const sim::Vector3d& p_WS);
  /// Returns the distance to the water surface along a ray, at most its range_max_m.  `surface_m`: height of the
  /// surface in W at the position of the sensor.
  double range_to_surface_m(const sim::Ray& ray_W, double surface_m) const;

  const sim::PhysicsWorld& physics_;
  const sim::Medium& medium_;
  int own_group_;
  SonarParams params_;
  double source_uPa2_ = 0;
  double sound_speed_mps_ = 0, absorption_dBpm_ = 0, range_scale_ = 1;
  sim::RayFilter filter_;
  std::vector<sim::Ray> rays_W_;
  std::vector<sim::RayHit> hits_;
};

/// Returns a random power with mean 1 for the coherent sum of many echoes with random phases: exponential distribution,
/// whose amplitude is Rayleigh distributed with mean / standard deviation = sqrt(pi / (4 - pi)) = 1.91.
double speckle_power(sim::Random& random);

}  // namespace devices
