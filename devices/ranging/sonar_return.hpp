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

/// What all sonars have in common; read from the device's own map.  Levels are in dB re 1 uPa.
struct SonarParams {
  enum class WorksIn { water, air, any };
  /// Gain over range: 20 or 40 log10 r, and twice the absorption.
  enum class Gain { none, log20, log40 };

  double range_min_m = 0.1;
  double range_max_m = 50;
  WorksIn works_in = WorksIn::water;
  std::optional<double> sound_speed_mps;          ///< unset: the medium's; 1500 in a world without water
  std::optional<double> assumed_sound_speed_mps;  ///< that turns times into ranges; unset: the true one
  std::optional<double> absorption_dBpkm;         ///< unset: by the frequency; without that 0
  std::optional<double> frequency_kHz;
  bool surface_echo = false;
  double surface_backscatter_dB = -30;
  double source_level_dB = 200;  ///< at 1 m
  double pulse_s = 1e-4;
  Gain tvg = Gain::none;
  bool speckle = true;
  bool sees_own_vehicle = false;
  std::vector<std::string> see_through;  ///< part categories
  void read(sim::ParamReader& in);
};

/// A sonar that decides what is an echo.
struct SonarDetectionParams {
  double threshold_dB = 80;
  void read(sim::ParamReader& in);
};

/// A direction of a sonar's beam.
struct SonarRay {
  sim::Vector3d direction_S;
  double solid_angle_sr = 0;  ///< that the ray stands for
  double weight = 1;          ///< two-way beam pattern, as a share of the power
};

/// One-way response at an angle off the axis of a beam `width_rad` wide between its -3 dB points: a Gaussian lobe.
double beam_response(double off_axis_rad, double width_rad);

/// An echo along one ray.
struct SonarEcho {
  double range_m = 0;
  double power_uPa2 = 0;  ///< at the receiver
};

/// Echo levels by the active sonar equation with a Lambert surface.  A ray that stands for the solid angle w meets the
/// area A = w r^2 / cos(i), i the angle of incidence; its scattering strength is S = 10 log mu + 10 log cos^2(i), and
///   EL = SL - 40 log r - 2 a r + S + 10 log A + 10 log b^2,
/// so that the power of one ray is SL b^2 mu cos(i) w r^-2 10^(-a r / 5) (Urick, Principles of Underwater Sound, 3rd
/// ed., ch. 2 and 8; Lambert's rule: Mackenzie 1961).  What fills the beam falls with 20 log r, what is smaller than
/// the beam with 40 log r, by itself.  Echoes add up in power, as those of rough surfaces do.
///
/// In a world with water a sonar receives nothing while it is on the wrong side of the surface, and its rays end at
/// the surface, which is assumed level at each ray's end.  Speed of sound and absorption are those at the sensor.
class SonarReceiver {
 public:
  SonarReceiver(const SonarParams& params, const sim::DeviceContext& context);
  void change(const SonarParams& params);

  const sim::RayFilter& filter() const { return filter_; }
  /// Updates the medium and casts the rays from the sensor's pose; hits() and rays_W() give the results.
  void cast(const sim::Scene& scene, const sim::Pose& X_WS, std::span<const SonarRay> rays_S);
  std::span<const sim::RayHit> hits() const { return hits_; }
  std::span<const sim::Ray> rays_W() const { return rays_W_; }
  /// The echo along one ray of the last cast, at its true range; power 0 where nothing was hit, or where the echo
  /// arrives during the ping.
  SonarEcho echo(std::size_t ray, const SonarRay& ray_S) const;
  /// How much farther the surface gets per radian that the ray turns towards `tangent_W`, m/rad; never negative.
  double range_slope(std::size_t ray, const sim::Vector3d& tangent_W) const;
  /// Gain of the receiver over range, dB.
  double gain_dB(double range_m) const;
  /// Half the length of a pulse: what is nearer together in range is not told apart.
  double pulse_m() const { return sound_speed_mps_ * params_.pulse_s / 2; }
  /// What a true range is multiplied by when times become ranges: assumed over true speed of sound.
  double range_scale() const { return range_scale_; }
  /// What the medium was like where it last worked: that counts while it is on the wrong side of the surface.
  void visit_state(sim::StateArchive& archive) { archive(sound_speed_mps_, absorption_dBpm_, range_scale_); }

 private:
  /// Whether it works in the medium where it is; takes over what the medium is like there.
  bool update_medium(const sim::Vector3d& p_WS);
  /// How far along a ray the surface of the water is, at most `range_max_m`.  `surface_m`: its height over the sensor.
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

/// A random power with the mean 1: that of many echoes which add up with random phases (its root has the Rayleigh
/// distribution, mean / standard deviation = sqrt(pi / (4 - pi)) = 1.91).
double speckle_power(sim::Random& random);

}  // namespace devices
