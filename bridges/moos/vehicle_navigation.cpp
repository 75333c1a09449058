// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/vehicle_navigation.hpp"

#include <algorithm>
#include <cmath>

namespace bridges {

namespace {

constexpr std::array place_fields{NavField::x, NavField::y, NavField::latitude, NavField::longitude, NavField::speed};
constexpr std::array attitude_fields{NavField::heading, NavField::pitch, NavField::roll};
constexpr std::array truth_fields{NavField::x,         NavField::y,     NavField::latitude,
                                  NavField::longitude, NavField::speed, NavField::heading,
                                  NavField::pitch,     NavField::roll,  NavField::depth};
constexpr std::array depth_field{NavField::depth}, altitude_field{NavField::altitude}, heading_field{NavField::heading};
constexpr std::array dvl_fields{NavField::altitude, NavField::speed};

}  // namespace

double heading_deg_of(double yaw_rad) {
  const double degrees = std::fmod(90 - sim::radians_to_degrees(yaw_rad), 360);
  return degrees < 0 ? degrees + 360 : degrees;
}

double yaw_rad_of(double heading_deg) {
  return sim::wrap_angle(sim::degrees_to_radians(90 - heading_deg));
}

void VehicleNavigation::set_origin(double latitude_deg, double longitude_deg) {
  geodesy_ = std::make_shared<sim::Geodesy>(sim::GeodeticPosition{latitude_deg, longitude_deg, 0});
}

VehicleNavigation::Fields VehicleNavigation::take(const shoal::gps_data_t& gps) {
  has_fix_ = gps.gps_lock > 0;
  if (!has_fix_ || position_ != Position::gps) return {};
  at(NavField::x) = gps.xyz_pos[0];
  at(NavField::y) = gps.xyz_pos[1];
  at(NavField::latitude) = gps.latitude;
  at(NavField::longitude) = gps.longitude;
  at(NavField::speed) = gps.speed;
  return place_fields;
}

VehicleNavigation::Fields VehicleNavigation::set_place(double x_m, double y_m, double speed_mps) {
  at(NavField::x) = x_m;
  at(NavField::y) = y_m;
  at(NavField::speed) = speed_mps;
  if (geodesy_) {
    const sim::GeodeticPosition place = geodesy_->to_geodetic({x_m, y_m, 0});
    at(NavField::latitude) = place.latitude_deg;
    at(NavField::longitude) = place.longitude_deg;
  }
  return place_fields;
}

VehicleNavigation::Fields VehicleNavigation::take(const shoal::estimate_t& estimate) {
  if (position_ != Position::estimate) return {};
  return set_place(estimate.position_m[0], estimate.position_m[1],
                   std::hypot(estimate.velocity_mps[0], estimate.velocity_mps[1]));
}

void VehicleNavigation::set_attitude(const double (&orientation)[4]) {
  const sim::Quaterniond q(orientation[0], orientation[1], orientation[2], orientation[3]);
  const sim::Matrix3d rotation = q.normalized().toRotationMatrix();  // body (forward, left, up) to east, north, up
  at(NavField::heading) = heading_deg_of(std::atan2(rotation(1, 0), rotation(0, 0)));
  at(NavField::pitch) = sim::radians_to_degrees(std::asin(std::clamp(rotation(2, 0), -1.0, 1.0)));
  at(NavField::roll) = sim::radians_to_degrees(std::atan2(rotation(2, 1), rotation(2, 2)));
}

VehicleNavigation::Fields VehicleNavigation::take(const shoal::ins_t& ahrs) {
  if (position_ == Position::truth || std::isnan(ahrs.quat[0])) return {};
  set_attitude(ahrs.quat);
  return attitude_fields;
}

VehicleNavigation::Fields VehicleNavigation::take(const shoal::compass_t& compass) {
  if (position_ == Position::truth || std::isnan(compass.heading_true_rad)) return {};
  at(NavField::heading) = sim::radians_to_degrees(compass.heading_true_rad);
  return heading_field;
}

VehicleNavigation::Fields VehicleNavigation::take(const shoal::pressure_t& pressure) {
  if (position_ == Position::truth || std::isnan(pressure.depth_m)) return {};
  at(NavField::depth) = pressure.depth_m;
  return depth_field;
}

VehicleNavigation::Fields VehicleNavigation::take(const shoal::sonar_range_t& altimeter) {
  if (!altimeter.valid) return {};
  at(NavField::altitude) = altimeter.range_m;
  return altitude_field;
}

VehicleNavigation::Fields VehicleNavigation::take(const shoal::dvl_t& dvl) {
  if (!dvl.bottom_lock || std::isnan(dvl.altitude_m)) return {};
  at(NavField::altitude) = dvl.altitude_m;
  if (has_fix_ || position_ != Position::gps) return altitude_field;
  at(NavField::speed) = std::hypot(dvl.velocity_mps[0], dvl.velocity_mps[1]);
  return dvl_fields;
}

VehicleNavigation::Fields VehicleNavigation::take(const shoal::sim_state_t& truth) {
  if (position_ != Position::truth) return {};
  const auto found = std::find(truth.vehicle.begin(), truth.vehicle.end(), vehicle_);
  if (found == truth.vehicle.end()) return {};
  const auto i = static_cast<std::size_t>(found - truth.vehicle.begin());
  const auto& place = truth.position_m[i];
  const auto& velocity = truth.velocity_mps[i];
  const auto& q = truth.orientation[i];
  set_place(place[0], place[1], std::hypot(velocity[0], velocity[1]));
  set_attitude({q[0], q[1], q[2], q[3]});
  at(NavField::depth) = -place[2];
  return truth_fields;
}

}  // namespace bridges
