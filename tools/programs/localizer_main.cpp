// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iostream>
#include <stdexcept>

#include "autonomy/known_map/localizer.hpp"
#include "autonomy/known_map/map_file.hpp"
#include "sim/base/math.hpp"
#include "tools/programs/lidar_options.hpp"
#include "tools/programs/program.hpp"

namespace {

struct Options {
  std::string name, vehicle, map_file;
  std::string pose = "estimate", map = "map";
  autonomy::Localizer::Params localizer;
  autonomy::LidarOptions lidar;
  double start_yaw_deg = 0, start_std_deg = 6;
  double map_every_s = 60;
  autonomy::Participation participation;
};

/// All state of the program: it is rewound with the world.
struct State {
  autonomy::Localizer localizer;
  bool was_lost = false;
  int times_lost = 0;
  std::int64_t next_map_utime = 0;
};

int localize(const Options& options) {
  shoal::occupancy_grid_t map = autonomy::read_map_file(options.map_file);
  State state{autonomy::Localizer(std::make_shared<autonomy::LikelihoodField>(map), options.localizer)};
  shoal::Client client(options.name, options.participation.lcm_url);
  const std::string prefix = options.vehicle + ".";
  using shoal::Finite;
  client.subscribe<shoal::odometry_t>(
      prefix + "odometry", [&](const shoal::odometry_t& odometry) { state.localizer.receive(odometry); },
      Finite::required);
  client.subscribe<shoal::planar_lidar_t>(
      prefix + "lidar", [&](const shoal::planar_lidar_t& scan) { state.localizer.receive(scan); }, Finite::required);
  const int exit_code = autonomy::take_part(client, options.participation, state, [&](std::int64_t utime) {
    if (utime >= state.next_map_utime) {
      state.next_map_utime = utime + static_cast<std::int64_t>(1e6 * options.map_every_s);
      client.publish(prefix + options.map, map);
    }
    const auto estimate = state.localizer.step();
    if (!estimate) return;
    client.publish(prefix + options.pose, *estimate);
    if (state.localizer.is_lost() == state.was_lost) return;
    state.was_lost = state.localizer.is_lost();
    state.times_lost += state.was_lost ? 1 : 0;
    const autonomy::Pose2& pose = state.localizer.pose();
    std::cerr << fmt::format("{}: {} at ({:.2f}, {:.2f}), {:.0f} deg, utime {}\n", options.name,
                             state.was_lost ? "lost" : "found", pose.p_W.x(), pose.p_W.y(),
                             sim::radians_to_degrees(pose.yaw_rad), utime);
  });
  // A single write, because the programs of a run share a terminal.
  std::cerr << options.name + ": lost " + std::to_string(state.times_lost) + " times\n";
  return exit_code;
}

void declare(command_line::DeclaredOptions& declared, Options& options) {
  autonomy::Localizer::Params& localizer = options.localizer;
  declared.publishes({"{vehicle}.{pose}", "{vehicle}.{map}"});
  declared.subscribes({"{vehicle}.odometry", "{vehicle}.lidar"});
  declared.text("name", "NAME", options.name, "its client name in the lockstep").required_in_worlds();
  declared.text("vehicle", "VEHICLE", options.vehicle, "vehicle that it localizes").required_in_worlds();
  declared
      .text("map_file", "FILE", options.map_file,
            "map, a .yaml of `shoal map`: below the working folder, else below the shipped worlds")
      .required();
  declared.text("pose", "CHANNEL", options.pose, "channel of its estimated pose, after VEHICLE.");
  declared.text("map", "CHANNEL", options.map, "channel on which it publishes the map, after VEHICLE.");
  declared.number("map_every_s", options.map_every_s, 0.1, 1e9, "simulated seconds between published maps");
  declared.tuple(
      "start_m", {"x", "y"}, sim::any_place(),
      [&](const auto& numbers) {
        localizer.start = autonomy::Pose2{{numbers[0], numbers[1]}, 0};
      },
      "position of the vehicle at the start, east and north; without it, it can be anywhere in the map");
  declared.number("start_yaw_deg", options.start_yaw_deg, -360, 360,
                  "its heading at the start, counter-clockwise from east");
  declared.number("start_std_m", localizer.start_std_m, 0, 100, "error of that position");
  declared.number("start_std_deg", options.start_std_deg, 0, 180, "error of that heading");
  options.lidar.declare(declared);
  declared.number("rest_mps", localizer.rest_mps, 0, 1,
                  "below it and below rest-radps the vehicle counts as being at rest");
  declared.number("rest_radps", localizer.rest_radps, 0, 1, "its turn rate");
  declared.integer("min_particles", localizer.min_particles, 10, 1'000'000, "smallest number of particles");
  declared.integer("max_particles", localizer.max_particles, 10, 1'000'000, "largest number of particles");
  declared.seed("seed", localizer.seed, "seed of its random numbers");
  options.participation.declare(declared);
  autonomy::set_help_end(declared, {"shoal-localizer --name localizer --vehicle rover1 --map-file map.yaml"},
                         "It reads VEHICLE.odometry and VEHICLE.lidar, and publishes shoal.estimate_t on "
                         "VEHICLE.estimate and shoal.occupancy_grid_t on VEHICLE.map.  docs/guides/mapping.md explains "
                         "it.");
}

int run(int argc, char** argv) {
  Options options;
  options.participation.period_s = 1;
  CLI::App app{"Localizes a vehicle in a given map with a lidar, in lockstep with `shoal run`.", "shoal-localizer"};
  command_line::DeclaredOptions declared(app);
  declare(declared, options);
  if (const auto exit_code = declared.parse(argc, argv)) return *exit_code;
  if (options.name.empty()) throw std::invalid_argument("--name is required");
  if (options.vehicle.empty()) throw std::invalid_argument("--vehicle is required");
  autonomy::Localizer::Params& localizer = options.localizer;
  if (localizer.max_particles < localizer.min_particles)
    throw std::invalid_argument(fmt::format("--max-particles must be at least --min-particles, {}, got {}",
                                            localizer.min_particles, localizer.max_particles));
  if (localizer.start) localizer.start->yaw_rad = sim::degrees_to_radians(options.start_yaw_deg);
  localizer.start_std_rad = sim::degrees_to_radians(options.start_std_deg);
  localizer.lidar = options.lidar.mounted();
  return localize(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-localizer", [&] { return run(argc, argv); });
}
