// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/own_ship.hpp"

#include <algorithm>
#include <cmath>

#include "bridges/nmea/sentences.hpp"
#include "sim/base/math.hpp"

namespace bridges::nmea {

namespace {

constexpr double knots_per_mps = 3600.0 / 1852;
constexpr double kmph_per_mps = 3.6;

/// An angle as it is written, with one decimal, from 0 to 359.9.
double compass_deg(double angle_deg) {
  const double tenths = std::round(10 * angle_deg);
  return (tenths - 3600 * std::floor(tenths / 3600)) / 10;
}

double compass_deg_of(double angle_rad) {
  return compass_deg(sim::radians_to_degrees(angle_rad));
}

Number knots(const double* speed_mps) {
  return speed_mps != nullptr ? Number(*speed_mps * knots_per_mps) : std::nullopt;
}

Number kilometers_per_hour(const double* speed_mps) {
  return speed_mps != nullptr ? Number(*speed_mps * kmph_per_mps) : std::nullopt;
}

}  // namespace

void OwnShip::receive(const shoal::ins_t& ins) {
  const sim::Quaterniond q_WB(ins.quat[0], ins.quat[1], ins.quat[2], ins.quat[3]);
  if (!(std::abs(q_WB.norm() - 1) < 0.01)) return;  // also of an IMU, whose orientation is NaN
  const sim::Vector3d rpy_rad = sim::rpy_from_rotation(q_WB.toRotationMatrix());
  roll_rad_ = {rpy_rad.x(), now_};
  pitch_rad_ = {rpy_rad.y(), now_};
  yaw_rad_ = {rpy_rad.z(), now_};
  turn_radps_ = {-ins.gyro[2], now_};
}

void OwnShip::receive(const shoal::inclination_t& inclination) {
  roll_rad_ = {inclination.roll_rad, now_};
  pitch_rad_ = {inclination.pitch_rad, now_};
}

void OwnShip::receive(const shoal::water_speed_t& speed) {
  if (speed.valid != 0) water_speed_mps_ = {speed.speed_mps, now_};
}

void OwnShip::receive(const shoal::dvl_t& dvl) {
  if (dvl.bottom_lock != 0) below_m_ = {dvl.altitude_m, now_};
  if (dvl.water_lock != 0) water_speed_mps_ = {dvl.water_velocity_mps[0], now_};
}

void OwnShip::receive(const shoal::sonar_range_t& echo) {
  if (echo.valid != 0) below_m_ = {echo.range_m, now_};
}

void OwnShip::receive(const shoal::pressure_t& pressure) {
  depth_m_ = {pressure.depth_m, now_};
  temperature_C_ = {pressure.temperature_C, now_};
}

void OwnShip::receive(const shoal::ctd_t& ctd) {
  if (ctd.valid == 0) return;
  depth_m_ = {ctd.depth_m, now_};
  temperature_C_ = {ctd.temperature_C, now_};
}

std::vector<std::string> OwnShip::sentences() const {
  Lines lines;
  if (has_gps_) add_position(lines);
  add_heading(lines);
  add_water(lines);
  add_wind(lines);
  add_transducers(lines);
  return lines;
}

std::optional<double> OwnShip::heading_deg() const {
  // The heading is clockwise from north, the yaw counter-clockwise from east.
  if (const double* yaw_rad = yaw_rad_.at(now_)) return compass_deg(90 - sim::radians_to_degrees(*yaw_rad));
  if (const double* heading_rad = compass_rad_.at(now_)) return compass_deg_of(*heading_rad);
  return {};
}

void OwnShip::add_position(Lines& lines) const {
  const shoal::gps_data_t* gps = gps_.at(now_);
  const bool fix = gps != nullptr && gps->gps_lock > 0 && std::abs(gps->latitude) <= 90 &&
                   std::abs(gps->longitude) <= 180 && std::abs(gps->gps_time) < 1e12;
  const char mode = !fix ? 'N' : gps->gps_lock == 2 ? 'D' : 'A';
  Rmc rmc;
  Gga gga;
  Vtg vtg;
  rmc.time = gga.time = fix ? std::llround(gps->gps_time * 1e6) : now_;
  rmc.mode = vtg.mode = mode;
  if (fix) {
    rmc.status = 'A';
    rmc.latitude_deg = gga.latitude_deg = gps->latitude;
    rmc.longitude_deg = gga.longitude_deg = gps->longitude;
    rmc.speed_kn = vtg.speed_kn = gps->speed * knots_per_mps;
    rmc.course_deg = vtg.course_deg = compass_deg_of(gps->heading);
    vtg.speed_kmph = gps->speed * kmph_per_mps;
    gga.quality = std::clamp<int>(gps->gps_lock, 1, 2);
    gga.satellites = std::clamp(gps->numSatellites, 0, 99);
    gga.altitude_m = gps->elev;
    gga.geoid_m = 0;  // a world has no geoid: its heights are above the ellipsoid
  }
  lines.push_back(format(rmc, "GP"));
  lines.push_back(format(gga, "GP"));
  lines.push_back(format(vtg, "GP"));
}

void OwnShip::add_heading(Lines& lines) const {
  if (const auto heading = heading_deg()) lines.push_back(format(Hdt{heading}, "HE"));
  if (const double* turn_radps = turn_radps_.at(now_))
    lines.push_back(format(Rot{sim::radians_to_degrees(*turn_radps) * 60, 'A'}, "TI"));
}

void OwnShip::add_water(Lines& lines) const {
  if (const double* speed_mps = water_speed_mps_.at(now_))
    lines.push_back(format(Vhw{heading_deg(), {}, knots(speed_mps), kilometers_per_hour(speed_mps)}, "VW"));
  if (const double* below_m = below_m_.at(now_)) {
    lines.push_back(format(Dbt{*below_m / 0.3048, *below_m, *below_m / 1.8288}, "SD"));
    const double* depth_m = depth_m_.at(now_);
    lines.push_back(format(Dpt{*below_m, depth_m != nullptr ? Number(*depth_m) : std::nullopt}, "SD"));
  }
}

void OwnShip::add_wind(Lines& lines) const {
  const shoal::wind_t* wind = wind_.at(now_);
  if (wind == nullptr) return;
  const char status = wind->valid != 0 ? 'A' : 'V';
  const auto add = [&](double angle_rad, double speed_mps, char reference) {
    Mwv mwv{{}, reference, {}, 'N', status};
    if (status == 'A') mwv.angle_deg = compass_deg_of(angle_rad), mwv.speed = speed_mps * knots_per_mps;
    lines.push_back(format(mwv, "WI"));
  };
  add(wind->apparent_angle_rad, wind->apparent_speed_mps, 'R');
  add(wind->true_angle_rad, wind->true_speed_mps, 'T');
}

void OwnShip::add_transducers(Lines& lines) const {
  const auto add = [&](const Latest<double>& quantity, char kind, double factor, char unit, const char* name) {
    if (const double* value = quantity.at(now_)) lines.push_back(format(Xdr{kind, *value * factor, unit, name}, "YX"));
  };
  // Positive are the bow up and the starboard side down: a pitch about y, to the left, has the bow down.
  add(pitch_rad_, 'A', -sim::radians_to_degrees(1), 'D', "PTCH");
  add(roll_rad_, 'A', sim::radians_to_degrees(1), 'D', "ROLL");
  add(depth_m_, 'D', 1, 'M', "DEPTH");
  add(temperature_C_, 'C', 1, 'C', "TEMP");
}

}  // namespace bridges::nmea
