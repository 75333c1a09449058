// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/random/noise.hpp"
#include "sim/scene/scene.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

constexpr std::size_t dvl_beams = 4;

/// Doppler velocity log: four beams about -z of the sensor frame S, 90 deg apart in azimuth (Janus).  Each
/// beam, a unit vector b, measures b . v; the velocity v is the least-squares solution for the beams that detect the
/// bottom, at least three.  The bottom is assumed to be stationary.
class Dvl final : public sim::Sensor {
 public:
  static constexpr const char* meaning =
      "Doppler velocity log: velocity over the bottom and through the water, altitude.";
  static constexpr double default_rate_hz = 5;
  static constexpr bool casts_rays = true;
  struct Params {
    std::string preset;
    double beam_angle_rad = sim::degrees_to_radians(30);     ///< angle between beams and -z
    double first_azimuth_rad = sim::degrees_to_radians(45);  ///< azimuth of the first beam, from x towards y
    double altitude_min_m = 0.5, altitude_max_m = 100;       ///< distance along -z
    double incidence_max_rad = sim::degrees_to_radians(60);
    double beam_dropout = 0;
    bool water_track = true;
    double layer_from_m = 2, layer_to_m = 8;  ///< water layer, distance along -z
    double beam_std_mps = 0, beam_std_per_mps = 0, scale_std = 0;
    std::optional<double> assumed_sound_speed_mps;
    std::vector<std::string> see_through;
    sim::NoiseParams beam_noise, velocity_noise;  ///< m/s
    sim::NoiseParams range_noise;                 ///< m
    void read(sim::ParamReader& in);
  };
  /// Measurement of one beam.
  struct Beam {
    double range_m = 0;
    double velocity_mps = 0;  ///< relative to the bottom, positive towards it
    double water_mps = 0;     ///< relative to the water layer
    bool sees_bottom = false, detects_water = false;
    void visit_state(sim::StateArchive& archive) {
      archive(range_m, velocity_mps, water_mps, sees_bottom, detects_water);
    }
  };
  struct Reading {
    std::array<Beam, dvl_beams> beams;
    std::optional<sim::Vector3d> velocity_S, water_velocity_S;
    double altitude_m = 0, fom_mps = 0;  ///< valid with velocity_S
    void visit_state(sim::StateArchive& archive) { archive(beams, velocity_S, water_velocity_S, altitude_m, fom_mps); }
  };

  Dvl(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  auto noises() {
    return std::tie(beam_noise_, water_beam_noise_, velocity_noise_, water_velocity_noise_, range_noise_);
  }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  std::optional<sim::FieldOfView> field_of_view() const override {
    sim::FieldOfView view{sim::FieldOfView::Kind::beams, params_.altitude_max_m / std::cos(params_.beam_angle_rad)};
    view.directions_S.assign(beams_S_.begin(), beams_S_.end());
    return view;
  }
  std::int64_t rays() const override { return dvl_beams; }
  std::string_view lacks() const override { return reading_.velocity_S ? "" : "bottom lock"; }
  void visit_state(sim::StateArchive& archive) override;
  const Reading& reading() const { return reading_; }

 private:
  /// Sets the velocity of a beam relative to the water layer.
  void listen_to_water(const sim::Ray& ray_W, const sim::Vector3d& v_WS_W, Beam& beam) const;
  /// Computes velocities and altitude from the beams.
  void solve();
  double expected_beam_std_mps() const;

  Params params_;
  const sim::PhysicsWorld& physics_;
  const sim::Medium& medium_;
  int own_group_;
  const sim::NoiseFault& beam_fault_;
  sim::RayFilter filter_;
  sim::NoiseOf<&Params::beam_noise> beam_noise_;
  sim::NoiseOf<&Params::beam_noise> water_beam_noise_;
  sim::NoiseOf<&Params::velocity_noise> velocity_noise_;
  sim::NoiseOf<&Params::velocity_noise> water_velocity_noise_;
  sim::NoiseOf<&Params::range_noise> range_noise_;
  double scale_draw_;       ///< standard normal, drawn once per run
  double sound_scale_ = 1;  ///< assumed over true speed of sound
  double speed_mps_ = 0;    ///< true speed, for the noise
  std::array<sim::Vector3d, dvl_beams> beams_S_;
  Reading reading_;
};

}  // namespace devices
