// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "shoal/ais_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/ins_t.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "sim/base/geodesy.hpp"

namespace bridges::nmea {

/// True motions of all vehicles, from `sim.state`, as the reports of perfect devices: for images of a run, and worlds
/// whose vehicles have no devices.
class TrueState {
 public:
  /// `vehicle`: the own ship.
  explicit TrueState(std::string vehicle) : vehicle_(std::move(vehicle)) {}

  /// Takes the geographic origin of the world.
  void receive(const shoal::sim_info_t& info);
  /// Returns whether the own ship is there, and the origin is known.
  bool receive(const shoal::sim_state_t& state);
  /// After a receive() that returned true.
  shoal::gps_data_t gps() const;
  shoal::ins_t ins() const;
  /// Returns the messages of the other vehicles as those of class A: positions, and every 60 s a message with the name.
  /// Their MMSI are 200000001 and the next ones, which no country has, in the order in which they are seen first.
  std::vector<shoal::ais_t> ais(std::int64_t utime);

 private:
  struct Ship {
    std::int32_t mmsi = 0;
    std::optional<std::int64_t> named_utime = {};  ///< of the last message with its name
  };
  shoal::gps_data_t gps_of(std::size_t i) const;
  sim::Quaterniond q_WV(std::size_t i) const;

  std::string vehicle_;
  std::optional<sim::Geodesy> geodesy_;
  shoal::sim_state_t state_{};
  std::size_t own_ = 0;
  std::map<std::string, Ship> ships_;
};

}  // namespace bridges::nmea
