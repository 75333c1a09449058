#pragma once

#include <vector>

#include "sim/device/device_registry.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/random/noise.hpp"
#include "sim/scene/scene.hpp"

namespace devices {

/// Planar laser scanner.  The beams fan out in the xy-plane of the sensor frame S, from -fov/2 to +fov/2 about +x,
/// counter-clockwise seen from +z.
class Lidar final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Planar laser scanner: ranges over a fan of beams.";
  static constexpr double default_rate_hz = 10;
  static constexpr bool casts_rays = true;
  struct Params {
    int beams = 180;
    double fov_rad = std::numbers::pi;
    double range_min_m = 0.05;
    double range_max_m = 30.0;
    double resolution_m = 0;
    bool sees_own_vehicle = false;
    std::vector<std::string> see_through;  ///< part categories
    sim::NoiseParams noise;                ///< of each range, m
    void read(sim::ParamReader& in);
  };

  Lidar(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void hash_state(sim::StateHash& hash) const override;

  /// From right to left; range_max_m where nothing was hit, and range_min_m where something is nearer.
  const std::vector<double>& ranges_m() const { return ranges_m_; }
  double first_angle_rad() const { return fan_.first_angle_rad; }
  double step_rad() const { return fan_.step_rad; }

 private:
  const sim::PhysicsWorld& physics_;
  int own_group_;
  Params params_;
  sim::Fan fan_;
  sim::RayFilter filter_;
  sim::Noise noise_;
  std::vector<double> ranges_m_;
  std::vector<sim::RayHit> hits_;
};

/// Publishes shoal.planar_lidar_t, equal on the wire to bot_core's.
class LidarReporter final : public sim::Reporter {
 public:
  static constexpr const char* report_message = "shoal.planar_lidar_t";
  explicit LidarReporter(const Lidar& lidar) : lidar_(lidar) {}
  void report(sim::Time sampled_at, sim::Publisher& out) const override;

 private:
  const Lidar& lidar_;
};

}  // namespace devices
