// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "shoal/compass_t.hpp"
#include "shoal/dvl_t.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/ins_t.hpp"
#include "shoal/pressure_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "shoal/sonar_range_t.hpp"
#include "sim/base/geodesy.hpp"

namespace bridges {

/// Quantity of a vehicle's navigation, in the units of marine autonomy: meters, meters per second and degrees.
enum class NavField { x, y, latitude, longitude, speed, heading, depth, altitude, pitch, roll };

/// Where a vehicle is by its own devices, in the conventions of marine autonomy: x east and y north of the world's
/// origin, heading clockwise from north in [0, 360), pitch positive with the nose up, roll positive to starboard, depth
/// below the still surface.  Each `take` returns the fields that the report has set.  Lever arms of antennas are
/// neglected.
class VehicleNavigation {
 public:
  using Fields = std::span<const NavField>;

  /// Source of x, y, latitude, longitude and speed.
  enum class Position { gps, estimate, truth };

  explicit VehicleNavigation(std::string vehicle, Position position = Position::gps)
      : vehicle_(std::move(vehicle)), position_(position) {
    values_.fill(std::numeric_limits<double>::quiet_NaN());
  }

  /// WGS84 origin of the world, for positions of an estimate and of the truth; without it they have no latitude.
  void set_origin(double latitude_deg, double longitude_deg);

  Fields take(const shoal::gps_data_t& gps);
  Fields take(const shoal::estimate_t& estimate);
  /// Takes an attitude; the axes of the sensor are those of the vehicle.
  Fields take(const shoal::ins_t& ahrs);
  Fields take(const shoal::compass_t& compass);
  Fields take(const shoal::pressure_t& pressure);
  Fields take(const shoal::sonar_range_t& altimeter);
  /// Takes the altitude, and without GPS the speed.
  Fields take(const shoal::dvl_t& dvl);
  /// Takes all that the simulator knows of the vehicle.
  Fields take(const shoal::sim_state_t& truth);

  /// Returns a value, NaN before the first report.
  double operator[](NavField field) const { return values_[static_cast<std::size_t>(field)]; }
  bool has(NavField field) const { return (*this)[field] == (*this)[field]; }

 private:
  double& at(NavField field) { return values_[static_cast<std::size_t>(field)]; }
  void set_attitude(const double (&orientation)[4]);
  Fields set_place(double x_m, double y_m, double speed_mps);

  std::string vehicle_;
  Position position_;
  std::array<double, static_cast<std::size_t>(NavField::roll) + 1> values_;
  std::shared_ptr<const sim::Geodesy> geodesy_;
  bool has_fix_ = false;
};

/// Returns the heading clockwise from north, in degrees in [0, 360), of a yaw counter-clockwise from east.
double heading_deg_of(double yaw_rad);
/// Returns the yaw counter-clockwise from east, in (-pi, pi], of a heading clockwise from north.
double yaw_rad_of(double heading_deg);

}  // namespace bridges
