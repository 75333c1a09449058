// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/common/reading_digest.hpp"
#include "devices/ranging/radar_echo.hpp"
#include "devices/ranging/radar_targets.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Navigation radar.  Its antenna turns about -z of the sensor frame S, clockwise seen from above: spoke k of n has the
/// azimuth -2 pi k / n from +x, in the turns that begin at time 0.  Each step casts the spokes due in it, from the pose
/// of the sensor at their times.  A sample reports the spokes since the last one.
///
/// Two kinds of ray sample the beam.  Those of the fan are spread over twice its widths, densest at the horizon; they
/// find land, walls and other large things, and what hides the sea.  Vehicles and objects no wider than the fan are
/// sampled by a grid of rays over their outline, so that small distant ones are not missed between the rays of the fan.
/// A ray that represents the solid angle w and hits something at r sees a projected area w r^2, whose radar cross
/// section is this area times a factor.
class MarineRadar final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Navigation radar: spokes of echo levels over range from a rotating antenna.";
  static constexpr double default_rate_hz = 10;
  static constexpr bool casts_rays = true;
  static constexpr bool sweeps = true;
  static constexpr bool reuses_message = true;
  struct Params {
    double rotation_rpm = 24;
    int spokes = 720;
    int range_cells = 512;
    double range_min_m = 25;
    double range_max_m = 1852;
    RadarParams radar;
    int beam_rays = 6, elevation_rays = 32, target_rays = 8;
    double target_dB = 0, land_dB = -10;
    std::vector<RadarCrossSection> rcs;
    std::optional<double> sea_state, clutter_shape;
    double floor_dBm = -110, dynamic_range_dB = 127.5;
    sim::NoiseParams level_noise;  ///< dB
    bool sees_own_vehicle = false;
    std::vector<std::string> see_through;  ///< part categories
    void read(sim::ParamReader& in);
    double cell_m() const { return range_max_m / range_cells; }
    double dB_per_count() const { return dynamic_range_dB / 255; }
  };
  struct Spoke {
    sim::Time at{0};
    double azimuth_rad = 0;  ///< of the axis of the beam in S, counter-clockwise from +x
    void visit_state(sim::StateArchive& archive) { archive(at, azimuth_rad); }
  };

  MarineRadar(const Params& params, const sim::DeviceContext& context);
  auto noises() { return std::tie(level_noise_); }
  void change(const Params& params);
  void sweep(const sim::SweepContext& context) override;
  void measure(const sim::SenseContext& context) override;
  /// Discards the spokes that were measured elsewhere.
  void displaced() override { clear(); }
  void disturb(double dt_s, sim::Random& random) override;
  std::optional<sim::FieldOfView> field_of_view() const override;
  std::int64_t rays() const override;
  void visit_state(sim::StateArchive& archive) override;

  const Params& params() const { return params_; }
  /// Returns the spokes of the last sample in the order of their times, and their values spoke by spoke.
  const std::vector<Spoke>& spokes() const { return spokes_; }
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }
  sim::Time sampled_at() const { return sampled_at_; }

 private:
  /// What a ray stands for.
  struct Sample {
    double offset_rad;  ///< azimuth from the axis of the beam
    double solid_angle_sr;
    double width_rad, height_rad;  ///< of this solid angle
    double gain;                   ///< of the antenna, two-way, relative to its axis
    int target;                    ///< it is aimed at; -1: one of the fan
  };
  void clear();
  void add_spoke(const sim::SweepContext& context, sim::Time at, int number);
  void cast_fan(const RadarLook& look, int number);
  void aim_at_targets(const RadarLook& look);
  void add_ray(const RadarLook& look, Sample sample, double elevation_rad);
  /// Returns the two-way gain relative to the axis, for an azimuth from it and a direction.
  double gain(const RadarLook& look, double offset_rad, const sim::Vector3d& direction_W) const;
  double fan_elevation_rad(double place) const;
  /// Returns the radar cross section of a ray that hits something; 0: it adds nothing.
  double cross_section_m2(const RadarLook& look, std::size_t ray) const;
  int target_at(std::size_t ray) const;
  void share_cross_sections();
  void add_echoes(const RadarLook& look);
  void add_echo(double range_m, double power_mW, double extent_m);
  void add_clutter(const RadarLook& look);
  /// Returns the width of the azimuths of the beam in which nothing hides the sea, with the two-way gain.
  double open_width_rad(double range_m, double down_rad) const;
  double fan_offset_rad(int column) const;
  double cell_range_m(std::size_t cell) const { return (static_cast<double>(cell) + 0.5) * params_.cell_m(); }
  bool blind(std::size_t value) const {
    return cell_range_m(value % static_cast<std::size_t>(params_.range_cells)) < params_.range_min_m;
  }
  void quantize();

  const sim::World& world_;
  int own_group_;
  Params params_;
  sim::NoiseOf<&Params::level_noise> level_noise_;
  double echo_mWm2_ = 0, sea_state_ = 0, resolution_m_ = 0, target_factor_ = 1, land_factor_ = 1;
  std::vector<double> column_widths_rad_;  ///< of the fan, with the two-way gain
  sim::RayFilter filter_;
  RadarTargets targets_;
  // Spokes since the last sample.
  std::vector<Spoke> spokes_;
  std::vector<float> echo_mW_, clutter_mW_;  ///< means, spoke by spoke
  bool reported_ = false;                    ///< they are those of the last sample
  sim::Time swept_to_{0};
  // Of the last sample.
  sim::Time sampled_at_{0};
  std::vector<double> levels_dBm_;
  std::vector<std::uint8_t> pixels_;
  ReadingDigest digest_;
  // Of one spoke.
  std::vector<Sample> samples_;
  std::vector<sim::Ray> rays_;
  std::vector<sim::RayHit> hits_;
  std::vector<double> shifts_;                 ///< by column of the fan
  std::vector<char> aimed_;                    ///< by target: it is sampled by its own rays
  std::vector<double> nearest_m_, shares_m2_;  ///< by target: what is nearer hides it; of a given cross section, by ray
};

}  // namespace devices
