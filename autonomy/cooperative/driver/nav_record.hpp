// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "autonomy/cooperative/driver/nav_arguments.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "shoal/swarm_position_t.hpp"

namespace navigation {

/// What a record of a run has for navigation, in the order in which it was published.
struct NavRecord {
  using Message = std::variant<shoal::dvl_t, shoal::ins_t, shoal::compass_t, shoal::pressure_t, shoal::gps_data_t,
                               shoal::usbl_t, shoal::acoustic_received_t, shoal::modem_send_t, shoal::odometry_t,
                               shoal::swarm_position_t, shoal::modem_received_t>;
  struct Item {
    std::int64_t time_us = 0;  ///< simulated
    int vehicle = 0;           ///< index in the team
    Message message;
  };
  /// True pose of a vehicle.
  struct Truth {
    std::int64_t time_us = 0;
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  };

  std::string world;
  std::int64_t epoch_utime = 0;
  std::shared_ptr<const NavTeam> team;
  std::vector<NavArguments> arguments;  ///< by vehicle, of the programs that the world starts
  std::vector<Item> items;
  std::vector<std::vector<Truth>> truth;     ///< by vehicle
  std::vector<std::int64_t> truth_until_us;  ///< by vehicle: there is none later
  std::int64_t end_us = 0;
  std::size_t frame_bytes = 0;        ///< the longest that was transmitted; on land the longest that is possible
  std::vector<std::string> problems;  ///< of the file, such as an end that is cut off
};

/// Reads an LCM event log or an MCAP file.  Items begin at the first sim.info, from which on programs know the world.
/// Throws bridges::BusError when it cannot be read, std::invalid_argument when it has no sim.info or no vehicle with an
/// acoustic modem or odometry.
NavRecord read_record(const std::string& path);

/// Begins the truth of each vehicle of the team.  It ends where the scoring of its estimates ends in the world: at the
/// latest `until_s` of its metrics `position_error` and `consistency`.
void begin_truth(NavRecord& record, const std::string& resolved_world);
/// Adds true positions of the team.
void add_truth(NavRecord& record, const shoal::sim_state_t& state);

/// Returns the true position at a time, between two reports; nothing outside of them.
std::optional<Eigen::Vector3d> true_position(const std::vector<NavRecord::Truth>& truth, std::int64_t time_us);

}  // namespace navigation
