#include <iostream>

#include "sim/math.hpp"
#include "tools/autonomy/coop_auv.hpp"
#include "tools/autonomy/marine_options.hpp"
#include "tools/autonomy/program.hpp"

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
  app.add_flag("--no-cooperation", options.no_cooperation, "ranges are not used: the estimate is dead reckoning");
  app.add_option("--steer", options.steer, "by which estimate")
      ->capture_default_str()
      ->check(CLI::IsMember({"cooperative", "dead-reckoning"}));
  app.add_option("--states", auv.filter.states,
                 "2 position; 4 and heading bias, speed scale; 5 and clock; 6 and its drift")
      ->capture_default_str()
      ->check(CLI::IsMember({2, 4, 5, 6}));
  app.add_option("--sound-speed", auv.sound_speed_mps, "that makes a range of a travel time, m/s")
      ->capture_default_str()
      ->check(autonomy::between(1000.0, 2000.0));
  app.add_option("--range-std", auv.range_std_m, "error of a range, m")
      ->capture_default_str()
      ->check(autonomy::between(0.001, 1000.0));
  app.add_option("--sound-speed-std", auv.sound_speed_std, "error of a range, of the range")
      ->capture_default_str()
      ->check(autonomy::between(0.0, 0.5));
  app.add_option("--heading-bias-std", options.heading_bias_std_deg, "steady error of the heading, deg")
      ->capture_default_str()
      ->check(autonomy::between(0.0, 90.0));
  app.add_option("--speed-scale-std", auv.filter.speed_scale_std, "scale error of the DVL")
      ->capture_default_str()
      ->check(autonomy::between(0.0, 0.5));
  app.add_option("--heading-noise", auv.filter.heading_noise_radprtHz,
                 "rad in 1 s; for a slow error s of time T: s sqrt(2 T)")
      ->capture_default_str()
      ->check(autonomy::between(0.0, 10.0));
  app.add_option("--clock-std-ms", options.clock_std_ms, "error of the clock at the start, with 5 or 6 states")
      ->capture_default_str()
      ->check(autonomy::between(0.0, 1e6));
  app.add_option("--clock-drift-std-ppm", options.clock_drift_std_ppm, "drift of the clock, with 6 states")
      ->capture_default_str()
      ->check(autonomy::between(0.0, 1e4));
}

Eigen::Vector3d place_on_vehicle(const std::string& text) {
  if (text.empty()) return Eigen::Vector3d::Zero();
  return Eigen::Vector3d(autonomy::parse_numbers(text, 3, "x,y,z").data());
}

void add_options(CLI::App& app, Options& options) {
  autonomy::CoopAuv::Params& auv = options.auv;
  app.add_option("--name", auv.name, "vehicle to steer; also the name in the lockstep")->required();
  app.add_option("--id", auv.id, "in its frames")->capture_default_str()->check(CLI::Range(0, 255));
  app.add_option("--depth", auv.depth_m, "m")->capture_default_str()->check(autonomy::between(0.0, 10'000.0));
  app.add_option("--start", options.start, "\"x,y\": known place at the start; else it waits for GPS");
  app.add_option("--start-std", auv.start_std_m, "error of --start, m")
      ->capture_default_str()
      ->check(autonomy::between(0.001, 1000.0));
  app.add_option("--modem-at", options.modem_at, "\"x,y,z\": where the modem is on the vehicle, m; 0,0,0 unless set");
  app.add_option("--gps-at", options.gps_at, "the same of the GPS antenna");
  app.add_option("--surface-s", auv.surface_s, "s at the surface after the first fix")
      ->capture_default_str()
      ->check(autonomy::between(0.0, 3600.0));
  app.add_flag("--obey", auv.obey, "orders for its --id: it goes to the place and circles there");
  app.add_option("--order-depth-max", auv.order_depth_max_m, "deeper orders are refused, m")
      ->capture_default_str()
      ->check(autonomy::between(0.0, 10'000.0));
  app.add_option("--order-speed-max", auv.order_speed_max_mps, "faster orders are refused, m/s")
      ->capture_default_str()
      ->check(autonomy::between(0.01, 10.0));
  app.add_option("--hold-radius", auv.hold_radius_m, "of the circle at an ordered place, m")
      ->capture_default_str()
      ->check(autonomy::between(1.0, 10'000.0));
  options.marine.add_options(app);
  add_filter_options(app, options);
  options.participation.add_options(app);
  app.footer(std::string("It reads NAME.dvl, .ahrs or .compass, .pressure, .gps and .modem; it publishes "
                         "NAME.autopilot.cmd, .estimate,\n.dead_reckoning and, with --slot or --random-s, .modem.cmd.\n"
                         "Examples:\n"
                         "  shoal-coop-auv --name auv --route \"400,0;400,40;0,40;0,80\" --depth 15 --states 6\n"
                         "  shoal-coop-auv --name auv --start 0,0 --route 2000,0 --no-cooperation\n") +
             autonomy::exit_code_help);
}

int run(int argc, char** argv) {
  Options options;
  options.participation.period_s = 0.5;
  CLI::App app{"Steers an AUV that finds its place by dead reckoning and by one-way acoustic ranges."};
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
    const auto start = autonomy::parse_numbers(options.start, 2, "x,y");
    auv.start_W = autonomy::Vector2d(start[0], start[1]);
  }
  auv.modem_B = place_on_vehicle(options.modem_at);
  auv.gps_B = place_on_vehicle(options.gps_at);
  auv.access = options.marine.access();
  return drive(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-auv", [&] { return run(argc, argv); });
}
