// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "devices/common/reading_digest.hpp"
#include "devices/ranging/laser_return.hpp"

namespace devices {

/// Planar laser scanner.  The beams fan out in the xy-plane of the sensor frame S, from -fov/2 to +fov/2 about +x,
/// counter-clockwise seen from +z, all at one instant.  A beam that begins inside a solid ends where it leaves it.
class Lidar final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Planar laser scanner: ranges over a fan of beams.";
  static constexpr double default_rate_hz = 10;
  static constexpr bool casts_rays = true;
  static constexpr bool reuses_message = true;
  struct Params {
    std::string preset = "none";
    int beams = 180;
    double fov_rad = std::numbers::pi;
    bool intensities = false;
    LaserParams laser;
    void read(sim::ParamReader& in);
  };

  Lidar(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  std::int64_t rays() const override { return static_cast<std::int64_t>(hits_.size()); }
  void visit_state(sim::StateArchive& archive) override;

  /// From right to left; range_max_m where there is no return, and range_min_m where something is closer.
  const std::vector<double>& ranges_m() const { return returns_.ranges_m; }
  /// See LaserReturns; empty unless asked for.
  std::span<const double> intensities() const;
  double first_angle_rad() const { return fan_.first_angle_rad; }
  double step_rad() const { return fan_.step_rad; }

 private:
  void measure_axes(const sim::SenseContext& context);
  void measure_beams(const sim::SenseContext& context);

  Params params_;
  sim::Fan fan_;
  LaserReceiver receiver_;
  LaserReturns returns_;
  ReadingDigest digest_;
  std::vector<sim::Vector3d> directions_S_;  ///< of the beams; of all their rays when several sample one
  std::vector<sim::Ray> rays_;
  std::vector<sim::RayHit> hits_;
};

}  // namespace devices
