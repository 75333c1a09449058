// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "devices/common/reading_digest.hpp"
#include "devices/ranging/laser_return.hpp"

namespace devices {

/// Multi-ring laser scanner.  Its head rotates about +z of the sensor frame S, counter-clockwise seen from above, once
/// per report period.  Column k of n has the azimuth -pi + 2 pi k / n, and the last column is measured at the end of
/// the rotation.  Each step casts the columns due in it, from the pose of the sensor at their times.  A rotation that
/// begins before the run or without power lacks the columns of that time, and one in which the vehicle is put elsewhere
/// those before.
class Lidar3d final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Multi-ring laser scanner: a point cloud for each revolution.";
  static constexpr double default_rate_hz = 10;
  static constexpr bool casts_rays = true;
  static constexpr bool sweeps = true;
  static constexpr bool reuses_message = true;
  struct Params {
    std::string preset = "none";
    int rings = 16;
    double lowest_rad = sim::degrees_to_radians(-15);
    double highest_rad = sim::degrees_to_radians(15);
    std::vector<double> ring_angles_deg;  ///< replaces the three members above when not empty
    int columns = 900;
    LaserParams laser;
    void read(sim::ParamReader& in);
  };

  Lidar3d(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  void sweep(const sim::SweepContext& context) override;
  void measure(const sim::SenseContext& context) override;
  /// Clears the columns of a rotation that has begun: they were measured elsewhere.
  void displaced() override {
    if (next_column_ < params_.columns) returns_.assign(returns_.size(), params_.laser.range_max_m);
  }
  void disturb(double dt_s, sim::Random& random) override;
  std::optional<sim::FieldOfView> field_of_view() const override;
  std::int64_t rays() const override;
  void visit_state(sim::StateArchive& archive) override;

  /// Returns the last rotation, column by column, ring by ring.
  const LaserReturns& returns() const { return returns_; }
  int rings() const { return static_cast<int>(elevations_rad_.size()); }
  int columns() const { return params_.columns; }
  /// Returns the unit vector of a beam in S.
  sim::Vector3d direction_S(int column, int ring) const;
  /// Returns the time of a column relative to the end of the rotation; 0 or negative.
  sim::Time offset(int column) const;

 private:
  /// Archives the columns measured so far in the current rotation; the others are empty.
  void visit_begun_turn(sim::StateArchive& archive);
  void start_turn(const sim::SweepContext& context);
  /// Casts the columns [first, last).
  void cast_columns(const sim::SweepContext& context, int first, int last);

  const sim::DeviceConfig& config_;
  Params params_;
  LaserReceiver receiver_;
  std::vector<double> elevations_rad_;
  std::vector<sim::Vector3d> ring_rays_;  ///< at azimuth 0: beam of each ring, or all rays that sample it
  LaserReturns returns_;
  ReadingDigest digest_;  ///< of a complete rotation
  sim::Time turn_end_{-1};
  sim::Time turn_length_{0};
  sim::Time step_{0};  ///< length of the last sweep, for rays()
  int next_column_ = 0;
  std::vector<sim::Ray> rays_;
  std::vector<sim::RayHit> hits_;
};

}  // namespace devices
