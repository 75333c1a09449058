// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "shoal/compass_t.hpp"
#include "shoal/ctd_t.hpp"
#include "shoal/dvl_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/inclination_t.hpp"
#include "shoal/ins_t.hpp"
#include "shoal/pressure_t.hpp"
#include "shoal/sonar_range_t.hpp"
#include "shoal/water_speed_t.hpp"
#include "shoal/wind_t.hpp"

namespace bridges::nmea {

/// What the devices of a vehicle have last reported, as the sentences of the instruments of a ship.  The devices are
/// taken as mounted along the axes of the vehicle.
class OwnShip {
 public:
  /// A report that is older is no longer sent; a receiver of satellites then has no fix.
  static constexpr std::int64_t stale_us = 5'000'000;

  /// Sets the present time, epoch and simulated time in microseconds.
  void set_time(std::int64_t utime) { now_ = utime; }
  /// From now on there are sentences of a satellite receiver, without a fix until it reports one.
  void has_gps() { has_gps_ = true; }

  void receive(const shoal::gps_data_t& gps) { gps_ = {gps, now_}; }
  void receive(const shoal::ins_t& ins);
  void receive(const shoal::compass_t& compass) { compass_rad_ = {compass.heading_true_rad, now_}; }
  void receive(const shoal::inclination_t& inclination);
  void receive(const shoal::water_speed_t& speed);
  void receive(const shoal::dvl_t& dvl);
  void receive(const shoal::sonar_range_t& echo);
  void receive(const shoal::pressure_t& pressure);
  void receive(const shoal::ctd_t& ctd);
  void receive(const shoal::wind_t& wind) { wind_ = {wind, now_}; }

  /// Returns the sentences of this moment: RMC, GGA, VTG, HDT, ROT, VHW, DBT, DPT, MWV and XDR, each if a device
  /// reports its quantity.
  std::vector<std::string> sentences() const;

 private:
  template <class T>
  struct Latest {
    std::optional<T> value = {};
    std::int64_t utime = 0;

    const T* at(std::int64_t now) const { return value && std::abs(now - utime) <= stale_us ? &*value : nullptr; }
  };
  using Lines = std::vector<std::string>;

  std::optional<double> heading_deg() const;
  void add_position(Lines& lines) const;
  void add_heading(Lines& lines) const;
  void add_water(Lines& lines) const;
  void add_wind(Lines& lines) const;
  void add_transducers(Lines& lines) const;

  std::int64_t now_ = 0;
  bool has_gps_ = false;
  Latest<shoal::gps_data_t> gps_;
  Latest<double> yaw_rad_, compass_rad_;
  Latest<double> turn_radps_;  ///< to starboard
  Latest<double> roll_rad_, pitch_rad_;
  Latest<double> water_speed_mps_;
  Latest<double> below_m_;  ///< depth below the transducer
  Latest<double> depth_m_, temperature_C_;
  Latest<shoal::wind_t> wind_;
};

}  // namespace bridges::nmea
