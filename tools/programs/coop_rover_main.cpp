// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "autonomy/missions/coop_rover.hpp"
#include "sim/base/math.hpp"
#include "tools/programs/avoid_options.hpp"
#include "tools/programs/marine_options.hpp"
#include "tools/programs/program.hpp"

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
  // A single write, because the programs of a run share a terminal.
  std::cerr << params.name + ": " + std::to_string(rover.follower().reached()) + " waypoints reached, " +
                   std::to_string(rover.follower().given_up()) + " given up\n";
  return exit_code;
}

int run(int argc, char** argv) {
  autonomy::CoopRover::Params rover;
  autonomy::AvoidOptions avoid;
  avoid.params = {.keep_m = 0.7, .horizon_s = 6, .turn_radps = 1, .speed_time_s = 0.3, .speed_min_mps = 0};
  avoid.tracks = {.range_m = 8,
                  .range_min_m = 0.1,
                  .gap_m = 0.4,
                  .extent_m = 0.8,
                  .gate_m = 0.6,
                  .alpha = 0.5,
                  .beta = 0.1,
                  .still_mps = 0.15,
                  .hits = 5,
                  .memory_s = 1};
  autonomy::Participation participation;
  double start_yaw_deg = 0;
  CLI::App app{"Drives one rover of the cooperative experiment, in lockstep with `shoal run`.", "shoal-coop-rover"};
  command_line::DeclaredOptions options(app);
  // Channels and options.
  options.publishes({"{name}.drive.cmd", "{name}.modem.cmd", "{name}.estimate", "{name}.odometry_only"});
  options.subscribes({"{name}.odometry", "{name}.lidar", "{name}.modem", "{name}.gps", "{name}.swarm_position"});
  autonomy::add_name(options, rover.name, "vehicle to drive").required();
  options
      .tuples(
          "waypoints_m", {"x", "y"}, 2, sim::any_place(),
          [&](const auto& lists) { rover.waypoints_W = autonomy::points_of(lists); },
          "waypoints, east and north, driven in a loop")
      .required();
  options
      .tuple(
          "start_m", {"x", "y"}, sim::any_place(),
          [&](const auto& numbers) {
            rover.start.p_W = {numbers[0], numbers[1]};
          },
          "position of the rover at the start, east and north")
      .by_default({0, 0});
  options.number("start_yaw_deg", start_yaw_deg, -360, 360, "its heading at the start, counter-clockwise from east");
  options.number("speed_mps", rover.speed_mps, 0.05, 5, "speed of the rover");
  options.number("seen_std_m", rover.seen_std_m, 0.001, 100, "error of a position from swarm_position");
  avoid.declare(options);
  participation.declare(options);
  autonomy::set_help_end(
      options,
      {"shoal-coop-rover --name rover1 --start-m '[-20,-20]' --start-yaw-deg 90 --waypoints-m "
       "'[[-20,20],[-5,20],[-5,-20],[-20,-20]]'"},
      "It reads NAME.odometry, .lidar, .modem and, where they exist, .gps and .swarm_position; it publishes "
      "NAME.drive.cmd, .modem.cmd, .estimate and .odometry_only.  Start it beside `shoal run worlds/coop_land.yaml "
      "--await rover1,rover2,rover3`, or let that start it with --launch.");
  // Parse the command line and run.
  if (const auto exit_code = options.parse(argc, argv)) return *exit_code;
  rover.start.yaw_rad = sim::wrap_angle(sim::degrees_to_radians(start_yaw_deg));
  rover.avoidance = avoid.make();
  return drive(rover, participation);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-rover", [&] { return run(argc, argv); });
}
