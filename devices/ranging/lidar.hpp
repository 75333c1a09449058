// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "devices/common/reading_digest.hpp"
#include "devices/ranging/laser_return.hpp"

namespace devices {

/// Planar laser scanner.  The beams lie in the xy-plane of the sensor frame S, from -fov/2 to +fov/2 about +x,
/// counter-clockwise seen from +z, and are measured at one instant.  A beam that begins inside a solid hits its surface
/// from inside.
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
  std::optional<sim::FieldOfView> field_of_view() const override {
    sim::FieldOfView view{sim::FieldOfView::Kind::fan, params_.laser.range_max_m, params_.laser.range_min_m};
    view.from_rad = fan_.first_angle_rad;
    view.to_rad = fan_.first_angle_rad + (fan_.count - 1) * fan_.step_rad;
    return view;
  }
  std::int64_t rays() const override { return static_cast<std::int64_t>(returns_.size() * rays_per_beam_); }
  void visit_state(sim::StateArchive& archive) override;

  /// Returns ranges from right to left; range_max_m without a return, range_min_m for closer hits.
  const std::vector<double>& ranges_m() const { return returns_.ranges_m; }
  /// Returns the intensities, see LaserReturns; empty unless configured.
  std::span<const double> intensities() const;
  double first_angle_rad() const { return fan_.first_angle_rad; }
  double step_rad() const { return fan_.step_rad; }

 private:
  bool ranges_suffice() const;
  std::span<sim::RayHit> hits() const;
  void measure_axes(const sim::SenseContext& context);
  void measure_beams(const sim::SenseContext& context);

  Params params_;
  sim::Fan fan_;
  LaserReceiver receiver_;
  LaserReturns returns_;
  ReadingDigest digest_;
  std::size_t rays_per_beam_ = 1;
  std::vector<sim::Vector3d> directions_S_;  ///< of all rays; empty when they are those of the fan
};

}  // namespace devices
