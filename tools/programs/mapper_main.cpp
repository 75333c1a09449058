// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <ctime>
#include <iostream>
#include <stdexcept>

#include "autonomy/mapping/mapper.hpp"
#include "sim/base/math.hpp"
#include "tools/programs/lidar_options.hpp"
#include "tools/programs/program.hpp"

namespace {

struct Options {
  std::string name, vehicle, memory = "forgetting";
  std::string pose = "estimate", map = "map";
  autonomy::Mapper::Params mapper;
  autonomy::LidarOptions lidar;
  double start_yaw_deg = 0;
  double map_every_s = 600;
  bool timing = false;
  autonomy::Participation participation;
};

/// All state of the program: it is rewound with the world.
struct State {
  autonomy::Mapper mapper;
  bool was_lost = false;
  std::int64_t next_map_utime = 0;
};

/// Longest and total CPU time of a scan, for --timing: not part of the state, because nothing depends on it.
struct Timing {
  double total_s = 0, max_s = 0;
  std::int64_t scans = 0;
};

int map(const Options& options) {
  State state{autonomy::Mapper(options.mapper)};
  Timing timing;
  shoal::Client client(options.name, options.participation.lcm_url);
  const std::string prefix = options.vehicle + ".";
  using shoal::Finite;
  client.subscribe<shoal::odometry_t>(
      prefix + "odometry", [&](const shoal::odometry_t& odometry) { state.mapper.receive(odometry); },
      Finite::required);
  client.subscribe<shoal::planar_lidar_t>(
      prefix + "lidar", [&](const shoal::planar_lidar_t& scan) { state.mapper.receive(scan); }, Finite::required);
  const int exit_code = autonomy::take_part(client, options.participation, state, [&](std::int64_t utime) {
    // CPU time, not wall time: the program shares the machine with the simulator.
    const std::clock_t started = std::clock();
    const auto estimate = state.mapper.step();
    if (!estimate) return;
    const double took_s = static_cast<double>(std::clock() - started) / CLOCKS_PER_SEC;
    timing.total_s += took_s;
    timing.max_s = std::max(timing.max_s, took_s);
    ++timing.scans;
    if (state.mapper.is_lost() != state.was_lost) {
      state.was_lost = state.mapper.is_lost();
      const autonomy::Pose2& pose = state.mapper.pose();
      std::cerr << fmt::format("{}: {} at ({:.2f}, {:.2f}), {:.0f} deg, utime {}\n", options.name,
                               state.was_lost ? "lost" : "found", pose.p_W.x(), pose.p_W.y(),
                               sim::radians_to_degrees(pose.yaw_rad), utime);
    }
    client.publish(prefix + options.pose, *estimate);
    if (utime < state.next_map_utime) return;
    state.next_map_utime = utime + static_cast<std::int64_t>(1e6 * options.map_every_s);
    client.publish(prefix + options.map, state.mapper.map_message());
  });
  // A single write, because the programs of a run share a terminal.
  std::string text = options.name + ": lost " + std::to_string(state.mapper.times_lost()) + " times\n";
  if (options.timing && timing.scans > 0)
    text += fmt::format("{}: {} scans, each {:.6f} ms, at most {:.6f} ms\n", options.name, timing.scans,
                        1e3 * timing.total_s / static_cast<double>(timing.scans), 1e3 * timing.max_s);
  std::cerr << text;
  return exit_code;
}

void declare_map(command_line::DeclaredOptions& declared, autonomy::OccupancyMap::Params& map, std::string& memory) {
  declared
      .tuple(
          "area_m", {"x_min", "y_min", "x_max", "y_max"}, sim::any_place(),
          [&](const auto& numbers) {
            map.low_W = {numbers[0], numbers[1]};
            map.high_W = {numbers[2], numbers[3]};
          },
          "area of the map")
      .by_default({map.low_W.x(), map.low_W.y(), map.high_W.x(), map.high_W.y()});
  declared.number("cell_m", map.cell_m, 0.03, 0.1, "side of a cell");
  declared.choice("memory", memory, {"forgetting", "static"},
                  "forgetting: evidence fades when it is older than cells usually last; static: all evidence stays");
  declared.number("dwell_s", map.dwell_s, 1, 1e9, "expected time between changes of a cell in which none was seen");
  declared.number("min_dwell_s", map.min_dwell_s, 1, 1e9, "shortest such time, however often a cell changes");
}

void declare(command_line::DeclaredOptions& declared, Options& options) {
  autonomy::Mapper::Params& mapper = options.mapper;
  declared.publishes({"{vehicle}.{pose}", "{vehicle}.{map}"});
  declared.subscribes({"{vehicle}.odometry", "{vehicle}.lidar"});
  declared.text("name", "NAME", options.name, "its client name in the lockstep").required_in_worlds();
  declared.text("vehicle", "VEHICLE", options.vehicle, "vehicle that maps").required_in_worlds();
  declared.text("pose", "CHANNEL", options.pose, "channel of its estimated pose, after VEHICLE.");
  declared.text("map", "CHANNEL", options.map, "channel of its map, after VEHICLE.");
  declared
      .tuple(
          "start_m", {"x", "y"}, sim::any_place(),
          [&](const auto& numbers) {
            mapper.start.p_W = {numbers[0], numbers[1]};
          },
          "position of the vehicle at the start, east and north")
      .by_default({0, 0});
  declared.number("start_yaw_deg", options.start_yaw_deg, -360, 360,
                  "its heading at the start, counter-clockwise from east");
  options.lidar.declare(declared);
  declared.number("rest_mps", mapper.rest_mps, 0, 1,
                  "below it and below rest-radps the vehicle counts as being at rest");
  declared.number("rest_radps", mapper.rest_radps, 0, 1, "its turn rate");
  declare_map(declared, mapper.map, options.memory);
  declared.number("map_every_s", options.map_every_s, 0.1, 1e9, "simulated seconds between published maps");
  declared.flag("timing", options.timing, "print the CPU time of the scans at the end");
  options.participation.declare(declared);
  autonomy::set_help_end(declared, {"shoal-mapper --name mapper --vehicle rover1 --area-m '[-22,-16,22,16]'"},
                         "It reads VEHICLE.odometry and VEHICLE.lidar, and publishes shoal.estimate_t on "
                         "VEHICLE.estimate and shoal.occupancy_grid_t on VEHICLE.map.  docs/guides/mapping.md explains "
                         "it.");
}

int run(int argc, char** argv) {
  Options options;
  options.participation.period_s = 1;
  CLI::App app{"Maps a changing world with a lidar and localizes its vehicle, in lockstep with `shoal run`.",
               "shoal-mapper"};
  command_line::DeclaredOptions declared(app);
  declare(declared, options);
  if (const auto exit_code = declared.parse(argc, argv)) return *exit_code;
  if (options.name.empty()) throw std::invalid_argument("--name is required");
  if (options.vehicle.empty()) throw std::invalid_argument("--vehicle is required");
  options.mapper.start.yaw_rad = sim::degrees_to_radians(options.start_yaw_deg);
  options.mapper.lidar = options.lidar.mounted();
  options.mapper.map.forgets = options.memory == "forgetting";
  return map(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-mapper", [&] { return run(argc, argv); });
}
