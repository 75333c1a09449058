// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <stdexcept>

#include "autonomy/mapping/patrol.hpp"
#include "shoal/twist_command_t.hpp"
#include "tools/programs/marine_options.hpp"
#include "tools/programs/program.hpp"

namespace {

struct Options {
  std::string name, vehicle, pose = "estimate", path;
  autonomy::Patrol::Params patrol;
  autonomy::Participation participation;
};

int drive(const Options& options) {
  autonomy::Patrol patrol(options.patrol);  // all of the program's state: it is rewound with the world
  shoal::Client client(options.name, options.participation.lcm_url);
  const std::string prefix = options.vehicle + ".";
  using shoal::Finite;
  client.subscribe<shoal::odometry_t>(
      prefix + "odometry", [&](const shoal::odometry_t& odometry) { patrol.receive(odometry); }, Finite::required);
  client.subscribe<shoal::planar_lidar_t>(
      prefix + "lidar", [&](const shoal::planar_lidar_t& scan) { patrol.receive(scan); }, Finite::required);
  client.subscribe<shoal::estimate_t>(prefix + options.pose,
                                      [&](const shoal::estimate_t& estimate) { patrol.receive(estimate); });
  if (!options.path.empty())
    client.subscribe<shoal::waypoints_command_t>(prefix + options.path,
                                                 [&](const auto& path) { patrol.receive(path); });
  const int exit_code = autonomy::take_part(client, options.participation, patrol, [&](std::int64_t utime) {
    const autonomy::Twist twist = patrol.step(utime);
    shoal::twist_command_t command{};
    command.utime = utime;
    command.forward_mps = twist.forward_mps;
    command.turn_radps = twist.turn_radps;
    client.publish(prefix + "drive.cmd", command);
  });
  // A single write, because the programs of a run share a terminal.
  if (patrol.follower())
    std::cerr << options.name + ": " + std::to_string(patrol.rounds()) + " rounds, " +
                     std::to_string(patrol.follower()->given_up()) + " waypoints given up\n";
  return exit_code;
}

void declare(command_line::DeclaredOptions& declared, Options& options) {
  autonomy::Patrol::Params& patrol = options.patrol;
  declared.publishes({"{vehicle}.drive.cmd"});
  declared.subscribes({"{vehicle}.odometry", "{vehicle}.lidar", "{vehicle}.{pose}", "{vehicle}.{path}"});
  declared.text("name", "NAME", options.name, "its client name in the lockstep").required_in_worlds();
  declared.text("vehicle", "VEHICLE", options.vehicle, "vehicle that patrols").required_in_worlds();
  declared.text("pose", "CHANNEL", options.pose, "channel of its estimated pose, after VEHICLE.");
  declared.tuples(
      "waypoints_m", {"x", "y"}, 2, sim::any_place(),
      [&](const auto& lists) { patrol.waypoints_W = autonomy::points_of(lists); },
      "waypoints of a round, east and north; it charges at the first");
  declared.text("path", "CHANNEL", options.path, "instead of waypoints: channel of paths to follow, after VEHICLE.");
  declared.exactly_one({"waypoints_m", "path"});
  declared.number("speed_mps", patrol.speed_mps, 0.05, 5, "speed of the vehicle");
  declared.number("pause_s", patrol.pause_s, 0, 1e6, "pause at each waypoint");
  declared.number("charge_s", patrol.charge_s, 0, 1e6, "pause at the first waypoint, where it charges");
  declared.number("reached_m", patrol.reached_m, 0.05, 100, "acceptance radius of a waypoint");
  declared.number("give_up_s", patrol.give_up_s, 1, 1e6, "a waypoint is skipped after this time without progress");
  declared.number("lost_std_m", patrol.lost_std_m, 0.01, 1000,
                  "standard deviation of the estimate above which it turns on the spot");
  declared.number("search_radps", patrol.search_radps, 0.01, 10, "turn rate on the spot");
  declared.number("search_drive_s", patrol.search_drive_s, 0, 1e6, "time for which it drives after each full turn");
  options.participation.declare(declared);
  autonomy::set_help_end(declared,
                         {"shoal-patrol --name patrol --vehicle rover1 --waypoints-m '[[-18,0],[18,4],[18,-4]]'"},
                         "It reads VEHICLE.odometry, VEHICLE.lidar and shoal.estimate_t on VEHICLE.estimate, and "
                         "publishes VEHICLE.drive.cmd.  docs/guides/mapping.md explains it.");
}

int run(int argc, char** argv) {
  Options options;
  options.participation.period_s = 1;
  CLI::App app{"Patrols waypoints by the pose that another program estimates, in lockstep with `shoal run`.",
               "shoal-patrol"};
  command_line::DeclaredOptions declared(app);
  declare(declared, options);
  if (const auto exit_code = declared.parse(argc, argv)) return *exit_code;
  if (options.name.empty()) throw std::invalid_argument("--name is required");
  if (options.vehicle.empty()) throw std::invalid_argument("--vehicle is required");
  options.patrol.period_s = options.participation.period_s;
  return drive(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-patrol", [&] { return run(argc, argv); });
}
