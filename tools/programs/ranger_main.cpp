// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "autonomy/missions/marine/ranger.hpp"
#include "tools/programs/marine_options.hpp"
#include "tools/programs/program.hpp"

namespace {

using autonomy::Ranger;

const char* word_of(Ranger::Phase phase) {
  switch (phase) {
    case Ranger::Phase::waiting_for_fix:
      return "waiting for a fix";
    case Ranger::Phase::at_surface:
      return "at the surface";
    case Ranger::Phase::dived:
      return "dived";
    case Ranger::Phase::rising:
      return "rising";
    case Ranger::Phase::done:
      return "done";
    case Ranger::Phase::lost:
      return "lost: its IMU is silent";
  }
  return "";
}

void report(const std::string& name, const Ranger& ranger) {
  const Ranger::Counts& counts = ranger.counts();
  std::cerr << name << ": " << word_of(ranger.phase()) << "; " << counts.fixes << " fixes, " << counts.ranges
            << " ranges used, " << counts.refused << " not; " << counts.sent << " frames sent\n";
  if (counts.last_fix_m == counts.last_fix_m)
    std::cerr << name << ": its last fix was " << counts.last_fix_m << " m from its estimate\n";
}

int drive(const Ranger::Params& params, const autonomy::Participation& participation) {
  Ranger ranger(params);
  shoal::Client client(params.name, participation.lcm_url);
  const auto listen = [&]<class Message>(const char* device) {
    client.subscribe<Message>(params.name + device, [&](const Message& message) { ranger.receive(message); });
  };
  listen.operator()<shoal::gps_data_t>(".gps");
  listen.operator()<shoal::imu_t>(".imu");
  listen.operator()<shoal::pressure_t>(".pressure");
  listen.operator()<shoal::sonar_range_t>(".altimeter");
  listen.operator()<shoal::multibeam_t>(".forward_sonar");
  const int exit_code = autonomy::take_part(client, participation, ranger, [&](std::int64_t) {
    const Ranger::Decision decision = ranger.step();
    if (decision.helm) client.publish(params.name + ".autopilot.cmd", *decision.helm);
    if (decision.estimate) client.publish(params.name + ".estimate", *decision.estimate);
    if (decision.before_last_fix) client.publish(params.name + ".before_last_fix", *decision.before_last_fix);
    if (decision.send) client.publish(params.name + ".modem.cmd", *decision.send);
  });
  report(params.name, ranger);
  return exit_code;
}

void declare_route(command_line::DeclaredOptions& options, const char* key, std::vector<autonomy::Vector2d>& route_W,
                   const std::string& meaning) {
  options
      .tuples(
          key, {"x", "y"}, 2, sim::any_place(), [&route_W](const auto& lists) { route_W = autonomy::points_of(lists); },
          meaning)
      .required();
}

void declare(command_line::DeclaredOptions& options, Ranger::Params& ranger) {
  options.publishes({"{name}.autopilot.cmd", "{name}.estimate", "{name}.before_last_fix", "{name}.modem.cmd"});
  options.subscribes({"{name}.gps", "{name}.imu", "{name}.pressure", "{name}.altimeter", "{name}.forward_sonar"});
  autonomy::add_name(options, ranger.name, "vehicle to steer").required();
  autonomy::add_id(options, "id", ranger.id, "number of the vehicle in its frames");
  declare_route(options, "surface_m", ranger.surface_W, "route at the surface, with a turn, east and north");
  declare_route(options, "dive_m", ranger.dive_W, "route under water, to the berth");
  declare_route(options, "rise_m", ranger.rise_W, "route back to the surface");
  options
      .tuples(
          "walls_m", {"x1", "y1", "x2", "y2"}, 4, sim::any_place(),
          [&ranger](const auto& lists) {
            for (const std::vector<double>& line : lists)
              ranger.walls_W.push_back({{line[0], line[1]}, {line[2], line[3]}});
          },
          "known walls, from end to end, east and north")
      .required();
  options.number("depth_m", ranger.depth_m, 0, 1000, "depth of the route under water");
  options.number("speed_mps", ranger.speed_mps, 0.05, 10, "speed through the water");
  options.number("pivot_m", ranger.pivot_m, 0, 100,
                 "pivot point ahead of the origin, about which the vehicle slips outwards in a turn");
  options.number("altitude_min_m", ranger.altitude_min_m, 0, 1000, "smallest altitude over the bottom");
  options.number("sonar_ahead_m", ranger.sonar_ahead_m, -10, 10, "forward sonar ahead of the origin of the vehicle");
  options.number("range_std_m", ranger.range_std_m, 0.001, 100, "error of a range to a wall");
  options.number("range_max_m", ranger.range_max_m, 1, 1000, "longer ranges are not used");
  options.number("current_std_mps", ranger.filter.current_std_mps, 0, 10, "standard deviation of the unknown current");
}

int run(int argc, char** argv) {
  Ranger::Params ranger;
  autonomy::AccessOptions sending;
  autonomy::Participation participation;
  participation.period_s = 0.5;
  CLI::App app{"Steers an AUV that inspects the walls of a dock by GPS, IMU and forward sonar.", "shoal-ranger"};
  command_line::DeclaredOptions options(app);
  declare(options, ranger);
  sending.declare(options, "its state");
  options.at_most_one({"slot", "random_s"});
  participation.declare(options);
  autonomy::set_help_end(
      options,
      {"shoal-ranger --name ranger --surface-m '[[50,0],[50,40]]' --dive-m '[[50,105],[80,128],[145,128]]' "
       "--rise-m '[[150,60]]' --walls-m '[[15,140,175,140],[175,60,175,140]]'"},
      "It reads NAME.gps, .imu, .pressure, .altimeter and .forward_sonar; it publishes NAME.autopilot.cmd, .estimate, "
      ".before_last_fix and, with --slot or --random-s, .modem.cmd.");
  if (const auto exit_code = options.parse(argc, argv)) return *exit_code;
  ranger.period_s = participation.period_s;
  ranger.access = sending.access();
  return drive(ranger, participation);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-ranger", [&] { return run(argc, argv); });
}
