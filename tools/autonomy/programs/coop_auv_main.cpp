// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "sim/base/math.hpp"
#include "tools/autonomy/missions/coop_auv.hpp"
#include "tools/autonomy/programs/marine_options.hpp"
#include "tools/autonomy/programs/program.hpp"
#include "tools/command_line/checks.hpp"

namespace {

struct Options {
  autonomy::CoopAuv::Params auv;
  autonomy::MarineOptions marine;
  autonomy::Participation participation;
  std::string steer = "cooperative";
  std::string start, modem_at, gps_at;
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
}

int drive(const Options& options) {
  const std::string& name = options.auv.name;
  autonomy::CoopAuv auv(options.auv, options.marine.make(name));
  shoal::Client client(name, options.participation.lcm_url);
  subscribe(client, auv, name);
  const int exit_code = autonomy::take_part(client, options.participation, auv, [&](std::int64_t) {
    const autonomy::CoopAuv::Decision decision = auv.step();
    if (decision.helm) client.publish(name + ".autopilot.cmd", *decision.helm);
    if (decision.estimate) client.publish(name + ".estimate", *decision.estimate);
    if (decision.dead_reckoning) client.publish(name + ".dead_reckoning", *decision.dead_reckoning);
    if (decision.send) client.publish(name + ".modem.cmd", *decision.send);
  });
  const autonomy::CoopAuv::Counts& counts = auv.counts();
  std::cerr << name << ": " << counts.frames << " frames heard, " << counts.bad_frames << " bad; " << counts.ranges
            << " ranges used, " << counts.refused << " refused; " << counts.sent << " frames sent\n";
  if (options.auv.obey)
    std::cerr << name << ": " << counts.orders << " orders obeyed, " << counts.orders_refused << " refused\n";
  if (counts.relayed > 0) std::cerr << name << ": " << counts.relayed << " states came by relay\n";
  if (counts.clock_steps > 0) std::cerr << name << ": its clock was set " << counts.clock_steps << " times\n";
  if (counts.silences > 0) std::cerr << name << ": all its devices fell silent " << counts.silences << " times\n";
  return exit_code;
}

void add_filter_options(CLI::App& app, Options& options) {
  autonomy::CoopAuv::Params& auv = options.auv;
  app.add_flag("--no-cooperation", options.no_cooperation, "use no ranges: the estimate is dead reckoning");
  app.add_option("--steer", options.steer, "by which estimate")
      ->type_name("ESTIMATE")
      ->capture_default_str()
      ->check(command_line::one_of({"cooperative", "dead-reckoning"}));
  app.add_option("--states", auv.filter.states,
                 "2 position; 4 and heading bias, speed scale; 5 and clock; 6 and its drift")
      ->type_name("N")
      ->capture_default_str()
      ->check(command_line::one_of({"2", "4", "5", "6"}));
  using autonomy::add_number;
  add_number(app, "--sound-speed", auv.sound_speed_mps, "M/S", 1000, 2000, "converts travel times to ranges");
  add_number(app, "--range-std", auv.range_std_m, "M", 0.001, 1000, "error of a range");
  add_number(app, "--sound-speed-std", auv.sound_speed_std, "RATIO", 0, 0.5, "error of a range, of the range");
  add_number(app, "--heading-bias-std", options.heading_bias_std_deg, "DEG", 0, 90, "steady error of the heading");
  add_number(app, "--speed-scale-std", auv.filter.speed_scale_std, "RATIO", 0, 0.5, "scale error of the DVL");
  add_number(app, "--heading-noise", auv.filter.heading_noise_radprtHz, "NOISE", 0, 10,
             "rad in 1 s; for a slow error s of time T: s sqrt(2 T)");
  add_number(app, "--clock-std-ms", options.clock_std_ms, "MS", 0, 1e6,
             "error of the clock at the start, with 5 or 6 states");
  add_number(app, "--clock-drift-std-ppm", options.clock_drift_std_ppm, "PPM", 0, 1e4,
             "drift of the clock, with 6 states");
}

Eigen::Vector3d place_on_vehicle(const char* option, const std::string& text) {
  if (text.empty()) return Eigen::Vector3d::Zero();
  return Eigen::Vector3d(
      autonomy::read_option(option, [&] { return autonomy::parse_numbers(text, 3, "x,y,z"); }).data());
}

void add_options(CLI::App& app, Options& options) {
  autonomy::CoopAuv::Params& auv = options.auv;
  using autonomy::add_number;
  autonomy::add_name(app, auv.name, "vehicle to steer")->required();
  autonomy::add_id(app, "--id", auv.id, "of the vehicle in its frames")->capture_default_str();
  add_number(app, "--depth", auv.depth_m, "M", 0, 10'000, "depth to dive to");
  app.add_option("--start", options.start, "known position at the start, m; without it the vehicle waits for GPS")
      ->type_name("X,Y");
  add_number(app, "--start-std", auv.start_std_m, "M", 0.001, 1000, "error of --start");
  app.add_option("--modem-at", options.modem_at, "position of the modem on the vehicle, m; without it 0,0,0")
      ->type_name("X,Y,Z");
  app.add_option("--gps-at", options.gps_at, "position of the GPS antenna, likewise")->type_name("X,Y,Z");
  add_number(app, "--surface-s", auv.surface_s, "S", 0, 3600, "time at the surface after the first fix");
  app.add_flag("--obey", auv.obey, "obey orders for its --id: go to the position and circle there");
  add_number(app, "--order-depth-max", auv.order_depth_max_m, "M", 0, 10'000, "deeper orders are refused");
  add_number(app, "--order-speed-max", auv.order_speed_max_mps, "M/S", 0.01, 10, "faster orders are refused");
  add_number(app, "--hold-radius", auv.hold_radius_m, "M", 1, 10'000, "of the circle at an ordered position");
  options.marine.add_options(app);
  add_filter_options(app, options);
  options.participation.add_options(app);
  autonomy::set_help_end(
      app,
      {"shoal-coop-auv --name auv --route \"400,0;400,40;0,40;0,80\" --depth 15 --states 6",
       "shoal-coop-auv --name auv --start 0,0 --route 2000,0 --no-cooperation"},
      "It reads NAME.dvl, .ahrs or .compass, .pressure, .gps and .modem; it publishes NAME.autopilot.cmd, .estimate, "
      ".dead_reckoning and, with --slot or --random-s, .modem.cmd.");
}

int run(int argc, char** argv) {
  Options options;
  options.participation.period_s = 0.5;
  CLI::App app{"Steers an AUV that localises itself by dead reckoning and by one-way acoustic ranges.",
               "shoal-coop-auv"};
  add_options(app, options);
  if (const auto exit_code = autonomy::parse(app, argc, argv)) return *exit_code;
  autonomy::CoopAuv::Params& auv = options.auv;
  auv.period_s = options.participation.period_s;
  auv.use_ranges = !options.no_cooperation;
  auv.steer_by_dead_reckoning = options.steer == "dead-reckoning";
  auv.filter.heading_bias_std_rad = sim::degrees_to_radians(options.heading_bias_std_deg);
  auv.filter.range_bias_std_m = auv.sound_speed_mps * 1e-3 * options.clock_std_ms;
  auv.filter.range_drift_std_mps = auv.sound_speed_mps * 1e-6 * options.clock_drift_std_ppm;
  if (!options.start.empty()) {
    const auto start =
        autonomy::read_option("--start", [&] { return autonomy::parse_numbers(options.start, 2, "x,y"); });
    auv.start_W = autonomy::Vector2d(start[0], start[1]);
  }
  auv.modem_B = place_on_vehicle("--modem-at", options.modem_at);
  auv.gps_B = place_on_vehicle("--gps-at", options.gps_at);
  auv.access = options.marine.access();
  return drive(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-auv", [&] { return run(argc, argv); });
}
