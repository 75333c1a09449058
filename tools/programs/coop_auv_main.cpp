// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "autonomy/missions/marine/coop_auv.hpp"
#include "sim/base/math.hpp"
#include "tools/programs/avoid_options.hpp"
#include "tools/programs/marine_options.hpp"
#include "tools/programs/program.hpp"

namespace {

struct Options {
  autonomy::CoopAuv::Params auv;
  autonomy::MarineOptions marine;
  autonomy::AvoidOptions avoid;
  autonomy::Participation participation;
  std::string steer = "cooperative";
  bool no_cooperation = false;
  double heading_bias_std_deg = 3;
  double clock_std_ms = 20;
  double clock_drift_std_ppm = 3;
};

void subscribe(shoal::Client& client, autonomy::CoopAuv& auv, const std::string& name) {
  const auto listen = [&]<class Message>(const char* device) {
    client.subscribe<Message>(name + device, [&](const Message& message) { auv.receive(message); });
  };
  listen.operator()<shoal::dvl_t>(".dvl");
  listen.operator()<shoal::ins_t>(".ahrs");
  listen.operator()<shoal::compass_t>(".compass");
  listen.operator()<shoal::pressure_t>(".pressure");
  listen.operator()<shoal::gps_data_t>(".gps");
  listen.operator()<shoal::acoustic_received_t>(".modem");
  listen.operator()<shoal::multibeam_t>(".forward_sonar");
}

int drive(const Options& options) {
  const std::string& name = options.auv.name;
  autonomy::CoopAuv auv(options.auv, options.avoid.around(options.marine.make(name)));
  shoal::Client client(name, options.participation.lcm_url);
  subscribe(client, auv, name);
  const int exit_code = autonomy::take_part(client, options.participation, auv, [&](std::int64_t) {
    const autonomy::CoopAuv::Decision decision = auv.step();
    if (decision.helm) client.publish(name + ".autopilot.cmd", *decision.helm);
    if (decision.estimate) client.publish(name + ".estimate", *decision.estimate);
    if (decision.dead_reckoning) client.publish(name + ".dead_reckoning", *decision.dead_reckoning);
    if (decision.send) client.publish(name + ".modem.cmd", *decision.send);
  });
  // Counts on stderr tell a silent modem from a filter that refuses its ranges.
  const autonomy::CoopAuv::Counts& counts = auv.counts();
  std::cerr << name << ": " << counts.frames << " frames received, " << counts.bad_frames << " bad; " << counts.ranges
            << " ranges used, " << counts.refused << " refused; " << counts.sent << " frames sent\n";
  if (options.auv.execute)
    std::cerr << name << ": " << counts.orders << " orders executed, " << counts.orders_refused << " refused\n";
  if (counts.relayed > 0) std::cerr << name << ": " << counts.relayed << " states came by relay\n";
  if (counts.clock_steps > 0) std::cerr << name << ": its clock was set " << counts.clock_steps << " times\n";
  if (counts.silences > 0) std::cerr << name << ": all its devices stopped reporting " << counts.silences << " times\n";
  return exit_code;
}

void declare_filter(command_line::DeclaredOptions& declared, Options& options) {
  autonomy::CoopAuv::Params& auv = options.auv;
  declared.flag("no_cooperation", options.no_cooperation, "use no ranges: the estimate is dead reckoning");
  declared.choice("steer", options.steer, {"cooperative", "dead_reckoning"}, "estimate by which it steers");
  declared.choice("states", auv.filter.states, {"2", "4", "5", "6"},
                  "states of the filter: 2 position; 4 and heading bias, speed scale; 5 and clock; 6 and its drift");
  declared.number("sound_speed_mps", auv.sound_speed_mps, 1000, 2000, "converts travel times to ranges");
  declared.number("range_std_m", auv.range_std_m, 0.001, 1000, "error of a range");
  declared.number("sound_speed_std", auv.sound_speed_std, 0, 0.5, "error of a range, as a ratio of the range");
  declared.number("heading_bias_std_deg", options.heading_bias_std_deg, 0, 90, "steady error of the heading");
  declared.number("speed_scale_std", auv.filter.speed_scale_std, 0, 0.5, "scale error of the DVL, as a ratio");
  declared.number(
      "heading_noise_radprtHz", auv.filter.heading_noise_radprtHz, 0, 10,
      "random walk of the heading, rad in 1 s; for a slow error with std s and correlation time T: s sqrt(2 T)");
  declared.number("clock_std_ms", options.clock_std_ms, 0, 1e6, "error of the clock at the start, with 5 or 6 states");
  declared.number("clock_drift_std_ppm", options.clock_drift_std_ppm, 0, 1e4, "drift of the clock, with 6 states");
}

/// Declares a position on the vehicle; the default is its origin.
void declare_position(command_line::DeclaredOptions& declared, const char* key, Eigen::Vector3d& position_B,
                      const std::string& meaning) {
  declared
      .tuple(
          key, {"x", "y", "z"}, sim::any_place(),
          [&position_B](const auto& numbers) { position_B = Eigen::Vector3d(numbers.data()); }, meaning)
      .by_default({0, 0, 0});
}

void declare(command_line::DeclaredOptions& declared, Options& options) {
  autonomy::CoopAuv::Params& auv = options.auv;
  // Channels.
  declared.publishes({"{name}.autopilot.cmd", "{name}.estimate", "{name}.dead_reckoning", "{name}.modem.cmd"});
  declared.subscribes({"{name}.dvl", "{name}.ahrs", "{name}.compass", "{name}.pressure", "{name}.gps", "{name}.modem",
                       "{name}.forward_sonar"});
  // Options of the mission.
  autonomy::add_name(declared, auv.name, "vehicle to steer").required();
  autonomy::add_id(declared, "id", auv.id, "number of the vehicle in its frames");
  declared.number("depth_m", auv.depth_m, 0, 10'000, "depth to dive to");
  declared.tuple(
      "start_m", {"x", "y"}, sim::any_place(),
      [&auv](const auto& numbers) { auv.start_W = autonomy::Vector2d(numbers[0], numbers[1]); },
      "known position at the start, east and north; without it the vehicle waits for GPS");
  declared.number("start_std_m", auv.start_std_m, 0.001, 1000, "error of that position");
  declare_position(declared, "modem_position_m", auv.modem_B, "position of the modem on the vehicle");
  declare_position(declared, "gps_position_m", auv.gps_B, "position of the GPS antenna on the vehicle");
  declared.number("surface_s", auv.surface_s, 0, 3600, "time at the surface after the first fix");
  // Options of orders.
  declared.flag("accept_orders", auv.execute, "follow orders for its id: go to the position and circle there");
  declared.number("order_depth_max_m", auv.order_depth_max_m, 0, 10'000, "maximum depth of an order");
  declared.number("order_speed_max_mps", auv.order_speed_max_mps, 0.01, 10, "maximum speed of an order");
  declared.number("hold_radius_m", auv.hold_radius_m, 1, 10'000, "radius of the circle at an ordered position");
  options.marine.declare(declared);
  options.avoid.declare(declared);
  declared.at_most_one({"slot", "random_s"});
  declare_filter(declared, options);
  options.participation.declare(declared);
  // End of the help.
  autonomy::set_help_end(
      declared,
      {"shoal-coop-auv --name auv --waypoints-m '[[400,0],[400,40],[0,40],[0,80]]' --depth-m 15 --states 6",
       "shoal-coop-auv --name auv --start-m '[0,0]' --waypoints-m '[[2000,0]]' --no-cooperation"},
      "It reads NAME.dvl, .ahrs or .compass, .pressure, .gps, .modem and, for --avoid, .forward_sonar; it publishes "
      "NAME.autopilot.cmd, .estimate, "
      ".dead_reckoning and, with --slot or --random-s, .modem.cmd.");
}

int run(int argc, char** argv) {
  Options options;
  options.participation.period_s = 0.5;
  CLI::App app{"Steers an AUV that localizes itself by dead reckoning and by one-way acoustic ranges.",
               "shoal-coop-auv"};
  command_line::DeclaredOptions declared(app);
  declare(declared, options);
  if (const auto exit_code = declared.parse(argc, argv)) return *exit_code;
  autonomy::CoopAuv::Params& auv = options.auv;
  auv.period_s = options.participation.period_s;
  auv.use_ranges = !options.no_cooperation;
  auv.steer_by_dead_reckoning = options.steer == "dead_reckoning";
  auv.filter.heading_bias_std_rad = sim::degrees_to_radians(options.heading_bias_std_deg);
  // Clock errors become errors of all ranges: 1 ms is 1.5 m.
  auv.filter.range_bias_std_m = auv.sound_speed_mps * 1e-3 * options.clock_std_ms;
  auv.filter.range_drift_std_mps = auv.sound_speed_mps * 1e-6 * options.clock_drift_std_ppm;
  auv.access = options.marine.access();
  return drive(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-auv", [&] { return run(argc, argv); });
}
