// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <iostream>
#include <stdexcept>

#include "autonomy/known_map/planner.hpp"
#include "tools/programs/lidar_options.hpp"
#include "tools/programs/marine_options.hpp"
#include "tools/programs/program.hpp"

namespace {

struct Options {
  std::string name, vehicle;
  std::string pose = "estimate", map = "map", goals = "goals", path = "path";
  std::string unknown_ground = "enter";
  autonomy::Planner::Params planner;
  autonomy::LidarOptions lidar;
  autonomy::Participation participation;
};

int plan(const Options& options) {
  autonomy::Planner planner(options.planner);  // all of the program's state: it is rewound with the world
  shoal::Client client(options.name, options.participation.lcm_url);
  const std::string prefix = options.vehicle + ".";
  client.subscribe<shoal::occupancy_grid_t>(prefix + options.map, [&](const auto& map) { planner.receive(map); });
  client.subscribe<shoal::planar_lidar_t>(
      prefix + "lidar", [&](const auto& scan) { planner.receive(scan); }, shoal::Finite::required);
  client.subscribe<shoal::estimate_t>(prefix + options.pose, [&](const auto& pose) { planner.receive(pose); });
  client.subscribe<shoal::waypoints_command_t>(prefix + options.goals,
                                               [&](const auto& goals) { planner.receive(goals); });
  const int exit_code = autonomy::take_part(client, options.participation, planner, [&](std::int64_t utime) {
    const autonomy::Planner::Decision decision = planner.step(utime);
    if (decision.path) client.publish(prefix + options.path, *decision.path);
    if (!decision.line.empty()) std::cerr << options.name + ": " + decision.line + "\n";
  });
  // A single write, because the programs of a run share a terminal.
  std::cerr << fmt::format("{}: {} goals reached, {} given up, {} paths planned{}\n", options.name, planner.reached(),
                           planner.given_up(), planner.plans(),
                           planner.has_map() ? "" : "; no map arrived on " + prefix + options.map);
  if (planner.has_map() && planner.used_scans() == 0)
    std::cerr << fmt::format(
        "{}: no scan on {}lidar matched the time of an estimate on {}{}: it planned with the map alone\n", options.name,
        prefix, prefix, options.pose);
  return exit_code;
}

void declare(command_line::DeclaredOptions& declared, Options& options) {
  autonomy::Planner::Params& planner = options.planner;
  declared.publishes({"{vehicle}.{path}"});
  declared.subscribes({"{vehicle}.{map}", "{vehicle}.lidar", "{vehicle}.{pose}", "{vehicle}.{goals}"});
  declared.text("name", "NAME", options.name, "its client name in the lockstep").required_in_worlds();
  declared.text("vehicle", "VEHICLE", options.vehicle, "vehicle for which it plans").required_in_worlds();
  declared.text("pose", "CHANNEL", options.pose, "channel of its estimated pose, after VEHICLE.");
  declared.text("map", "CHANNEL", options.map, "channel of the map, after VEHICLE.");
  declared.text("goals", "CHANNEL", options.goals, "channel of goals, after VEHICLE.: the last list replaces others");
  declared.text("path", "CHANNEL", options.path, "channel of its paths, after VEHICLE.");
  declared.tuples(
      "goals_m", {"x", "y"}, 2, sim::any_place(),
      [&](const auto& lists) { planner.goals_W = autonomy::points_of(lists); },
      "goals until others are received, east and north, in this order");
  declared.flag("loop", planner.loop, "continue from the last goal with the first");
  declared.number("keep_m", planner.costs.keep_m, 0.05, 100, "smallest clearance between its center and an obstacle");
  declared.number("prefer_m", planner.costs.prefer_m, 0.05, 100,
                  "clearance from which on a path has no additional cost");
  declared.number("clearance_cost", planner.costs.clearance_cost, 0, 1000,
                  "additional cost of a meter at keep-m; one far from obstacles costs 1");
  declared.choice("unknown_ground", options.unknown_ground, {"enter", "avoid"},
                  "whether a path may enter unknown ground");
  declared.number("unknown_cost", planner.costs.unknown_cost, 0, 1000, "additional cost of a meter there");
  declared.number("cell_m", planner.cell_m, 0.02, 1, "side of its cells, rounded to a multiple of those of the map");
  options.lidar.declare(declared);
  declared.number("memory_s", planner.memory_s, 1, 1e6,
                  "how long it keeps an obstacle that the lidar no longer sees; longer if it was seen for longer");
  declared.number("lost_std_m", planner.lost_std_m, 0.01, 1000,
                  "standard deviation of the estimate above which it does not plan");
  declared.number("reached_m", planner.reached_m, 0.05, 100, "acceptance radius of a goal");
  declared.number("stray_m", planner.stray_m, 0.1, 1000, "distance from the path at which it plans again");
  declared.number("retry_s", planner.retry_s, 0.1, 1e6, "time after which it plans again when there was no path");
  declared.number("give_up_s", planner.give_up_s, 1, 1e6, "time without a path after which it gives up a goal");
  options.participation.declare(declared);
  autonomy::set_help_end(declared, {"shoal-planner --name planner --vehicle rover1 --goals-m '[[10,0],[10,5]]'"},
                         "It reads shoal.occupancy_grid_t on VEHICLE.map, VEHICLE.lidar, shoal.estimate_t on "
                         "VEHICLE.estimate and shoal.waypoints_command_t on VEHICLE.goals, and publishes "
                         "shoal.waypoints_command_t on VEHICLE.path.  docs/guides/mapping.md explains it.");
}

int run(int argc, char** argv) {
  Options options;
  options.participation.period_s = 1;
  CLI::App app{"Plans paths to goals in the map that another program publishes, in lockstep with `shoal run`.",
               "shoal-planner"};
  command_line::DeclaredOptions declared(app);
  declare(declared, options);
  if (const auto exit_code = declared.parse(argc, argv)) return *exit_code;
  if (options.name.empty()) throw std::invalid_argument("--name is required");
  if (options.vehicle.empty()) throw std::invalid_argument("--vehicle is required");
  autonomy::PathCosts& costs = options.planner.costs;
  if (costs.prefer_m < costs.keep_m)
    throw std::invalid_argument(
        fmt::format("--prefer-m must be at least --keep-m, {:g}, got {:g}", costs.keep_m, costs.prefer_m));
  costs.enters_unknown = options.unknown_ground == "enter";
  options.planner.lidar = options.lidar.mounted();
  return plan(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-planner", [&] { return run(argc, argv); });
}
