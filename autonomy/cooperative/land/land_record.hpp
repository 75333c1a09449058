// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "autonomy/cooperative/driver/nav_record.hpp"
#include "autonomy/cooperative/land/land_team.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/swarm_position_t.hpp"

namespace navigation {

/// What a record of a run on land has for navigation, in the order in which it was published.
struct LandRecord {
  using Message = std::variant<shoal::odometry_t, shoal::swarm_position_t, shoal::gps_data_t, shoal::modem_received_t,
                               shoal::modem_send_t>;
  struct Item {
    std::int64_t time_us = 0;  ///< simulated
    int vehicle = 0;           ///< index in the team
    Message message;
  };

  LandTeam land;
  std::vector<Item> items;
  /// World, times, truth, and names of the team; it has no items.
  NavRecord run;
  bool has_radio = false;  ///< modems of the team sent something
};

/// Reads a record when its world is on land; nothing otherwise.  Throws bridges::BusError when it cannot be
/// read, std::invalid_argument when it has no sim.info, or no vehicle with odometry.
std::optional<LandRecord> read_land_record(const std::string& path);

}  // namespace navigation
