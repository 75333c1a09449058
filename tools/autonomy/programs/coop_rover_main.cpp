// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "tools/autonomy/behaviours/waypoint_text.hpp"
#include "tools/autonomy/missions/coop_rover.hpp"
#include "tools/autonomy/programs/program.hpp"

namespace {

int drive(const autonomy::CoopRover::Params& params, const autonomy::Participation& participation) {
  autonomy::CoopRover rover(params);
  shoal::Client client(params.name, participation.lcm_url);
  for (const std::string_view device : autonomy::CoopRover::devices())
    client.subscribe_bytes(params.name + "." + std::string(device),
                           [&rover, device](std::span<const std::byte> payload) { rover.receive(device, payload); });
  const int exit_code = autonomy::take_part(client, participation, rover, [&](std::int64_t utime) {
    for (const autonomy::CoopRover::Outgoing& out : rover.step(utime)) client.publish_bytes(out.channel, out.payload);
  });
  // One write: the programs of a run share a terminal.
  std::cerr << params.name + ": " + std::to_string(rover.follower().reached()) + " waypoints reached, " +
                   std::to_string(rover.follower().given_up()) + " given up\n";
  return exit_code;
}

int run(int argc, char** argv) {
  autonomy::CoopRover::Params rover;
  autonomy::Participation participation;
  std::string waypoints;
  std::string start = "0,0,0";
  CLI::App app{"Drives one rover of the cooperative experiment, in lockstep with `shoal run`.", "shoal-coop-rover"};
  autonomy::add_name(app, rover.name, "vehicle to drive")->required();
  app.add_option("--waypoints", waypoints, "\"x,y;x,y;...\", east and north in m, driven in a loop")
      ->type_name("ROUTE")
      ->required();
  app.add_option("--start", start, "pose of the rover at the start, m and degrees")
      ->type_name("X,Y,YAW")
      ->capture_default_str();
  autonomy::add_number(app, "--speed", rover.speed_mps, "M/S", 0.05, 5, "of the rover");
  autonomy::add_number(app, "--seen-std", rover.seen_std_m, "M", 0.001, 100, "error of a swarm_position sighting");
  participation.add_options(app);
  autonomy::set_help_end(
      app, {"shoal-coop-rover --name rover1 --start=-20,-20,90 --waypoints \"-20,20;-5,20;-5,-20;-20,-20\""},
      "It reads NAME.odometry, .lidar, .modem and, where they exist, .gps and .swarm_position; it publishes "
      "NAME.drive.cmd, .modem.cmd, .estimate and .odometry_only.  Start it beside `shoal run worlds/coop_land.yaml "
      "--await rover1,rover2,rover3`, or let that start it with --launch.");
  if (const auto exit_code = autonomy::parse(app, argc, argv)) return *exit_code;
  rover.waypoints_W = autonomy::read_option("--waypoints", [&] { return autonomy::parse_waypoints(waypoints); });
  rover.start = autonomy::read_option("--start", [&] { return autonomy::parse_start(start); });
  return drive(rover, participation);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-rover", [&] { return run(argc, argv); });
}
