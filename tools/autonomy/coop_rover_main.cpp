#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <iostream>

#include "bridges/lcm/bus_error.hpp"
#include "bridges/lcm/lockstep_client.hpp"
#include "shoal/message_codec.hpp"
#include "tools/autonomy/coop_rover.hpp"
#include "tools/autonomy/waypoint_text.hpp"

namespace {

enum ExitCode { exit_ok = 0, exit_usage = 2, exit_bus = 4, exit_timeout = 5 };

struct Options {
  autonomy::CoopRover::Params rover;
  std::string lcm_url;
  double period_s = 0.1;
  double join_timeout_s = 30;
};

bridges::LockstepClient* client_to_stop = nullptr;
volatile std::sig_atomic_t signal_caught = 0;

void on_signal(int signal) {
  signal_caught = signal;
  if (client_to_stop != nullptr) client_to_stop->stop();
}

void subscribe(bridges::LockstepClient& client, autonomy::CoopRover& rover, const std::string& name) {
  for (const std::string_view device : autonomy::CoopRover::devices()) {
    const std::string channel = name + "." + std::string(device);
    client.subscribe(channel, [&rover, device, channel](std::span<const std::byte> payload) {
      try {
        rover.receive(device, payload);
      } catch (const shoal::MessageError& error) {
        std::cerr << "shoal-coop-rover: " << channel << ": " << error.what() << " (ignored)\n";
      }
    });
  }
}

int drive(const Options& options) {
  autonomy::CoopRover rover(options.rover);
  bridges::LockstepClient client(options.lcm_url, options.rover.name);
  client_to_stop = &client;
  std::signal(SIGTERM, on_signal);
  std::signal(SIGINT, on_signal);
  subscribe(client, rover, options.rover.name);
  client.join(options.period_s, std::chrono::milliseconds(std::llround(1000 * options.join_timeout_s)));
  // The world may stand still for long while somebody looks at it; a signal ends the waiting.
  client.set_silence_limit(std::chrono::minutes(10));
  shoal::sim_tick_t tick;
  while (client.next_tick(tick)) {
    for (const autonomy::CoopRover::Outgoing& out : rover.step(tick.utime)) client.publish(out.channel, out.payload);
    client.acknowledge(tick);
  }
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGINT, SIG_DFL);
  client_to_stop = nullptr;
  std::cerr << options.rover.name << ": " << rover.follower().reached() << " waypoints reached, "
            << rover.follower().given_up() << " given up\n";
  if (signal_caught != 0) return 128 + signal_caught;
  return client.end() == bridges::LockstepClient::End::silence ? exit_timeout : exit_ok;
}

int run(int argc, char** argv) {
  Options options;
  std::string waypoints;
  std::string start = "0,0,0";
  CLI::App app{"Drives one rover of the cooperative experiment, in lockstep with `shoal run`."};
  app.add_option("--name", options.rover.name, "vehicle to drive; also the name in the lockstep")->required();
  app.add_option("--waypoints", waypoints, "\"x,y;x,y;...\", east and north in m, driven in a loop")->required();
  app.add_option("--start", start, "\"x,y,yaw_deg\": where the rover stands at first")->capture_default_str();
  app.add_option("--speed", options.rover.speed_mps, "m/s")->capture_default_str()->check(CLI::Range(0.05, 5.0));
  app.add_option("--period", options.period_s, "s of simulated time between decisions")
      ->capture_default_str()
      ->check(CLI::Range(0.001, 10.0));
  app.add_option("--seen-std", options.rover.seen_std_m, "error of a swarm_position sighting, m")
      ->capture_default_str()
      ->check(CLI::Range(0.001, 100.0));
  app.add_option("--join-timeout", options.join_timeout_s, "s to wait for the simulator")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 3600.0));
  app.add_option("--lcm-url", options.lcm_url, "unset: LCM_DEFAULT_URL, then LCM's default");
  app.footer(
      "It reads NAME.odometry, .lidar, .modem and, where there are such, .gps and .swarm_position; it "
      "publishes\n"
      "NAME.drive.cmd, .modem.cmd, .estimate and .odometry_only.\n"
      "Example, beside `shoal run worlds/coop_land.yaml`, or started by it with --launch:\n"
      "  shoal-coop-rover --name rover1 --start=-20,-20,90 --waypoints=\"-20,20;-5,20;-5,-20;-20,-20\"\n"
      "Exit codes: 0 the run ended, 2 usage, 4 bus trouble, 5 the simulator fell silent, 130 SIGINT, 143 "
      "SIGTERM.");
  try {
    app.parse(argc, argv);
    options.rover.waypoints_W = autonomy::parse_waypoints(waypoints);
    options.rover.start = autonomy::parse_start(start);
  } catch (const CLI::ParseError& error) {
    // CLI11 has exit codes of its own; all that is not help is wrong usage.
    return app.exit(error) == 0 ? exit_ok : exit_usage;
  } catch (const std::invalid_argument& error) {
    std::cerr << "shoal-coop-rover: " << error.what() << '\n';
    return exit_usage;
  }
  return drive(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "shoal-coop-rover: " << error.what() << '\n';
    return exit_bus;
  }
}
