#include <iostream>

#include "tools/autonomy/coop_rover.hpp"
#include "tools/autonomy/program.hpp"
#include "tools/autonomy/waypoint_text.hpp"

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
  std::cerr << params.name << ": " << rover.follower().reached() << " waypoints reached, "
            << rover.follower().given_up() << " given up\n";
  return exit_code;
}

int run(int argc, char** argv) {
  autonomy::CoopRover::Params rover;
  autonomy::Participation participation;
  std::string waypoints;
  std::string start = "0,0,0";
  CLI::App app{"Drives one rover of the cooperative experiment, in lockstep with `shoal run`."};
  app.add_option("--name", rover.name, "vehicle to drive; also the name in the lockstep")->required();
  app.add_option("--waypoints", waypoints, "\"x,y;x,y;...\", east and north in m, driven in a loop")->required();
  app.add_option("--start", start, "\"x,y,yaw_deg\": where the rover stands at first")->capture_default_str();
  app.add_option("--speed", rover.speed_mps, "m/s")->capture_default_str()->check(autonomy::between(0.05, 5.0));
  app.add_option("--seen-std", rover.seen_std_m, "error of a swarm_position sighting, m")
      ->capture_default_str()
      ->check(autonomy::between(0.001, 100.0));
  participation.add_options(app);
  app.footer(std::string("It reads NAME.odometry, .lidar, .modem and, where there are such, .gps and .swarm_position; "
                         "it publishes\nNAME.drive.cmd, .modem.cmd, .estimate and .odometry_only.\n"
                         "Example, beside `shoal run worlds/coop_land.yaml`, or started by it with --launch:\n"
                         "  shoal-coop-rover --name rover1 --start=-20,-20,90 "
                         "--waypoints=\"-20,20;-5,20;-5,-20;-20,-20\"\n") +
             autonomy::exit_code_help);
  if (const auto exit_code = autonomy::parse(app, argc, argv)) return *exit_code;
  rover.waypoints_W = autonomy::parse_waypoints(waypoints);
  rover.start = autonomy::parse_start(start);
  return drive(rover, participation);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-rover", [&] { return run(argc, argv); });
}
