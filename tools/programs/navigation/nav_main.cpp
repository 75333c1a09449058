// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <optional>
#include <stdexcept>

#include "autonomy/cooperative/driver/nav_arguments.hpp"
#include "autonomy/cooperative/driver/nav_pilot.hpp"
#include "shoal/sim_info_t.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/programs/marine_options.hpp"
#include "tools/programs/navigation/nav_commands.hpp"
#include "tools/programs/program.hpp"

namespace {

struct Options {
  navigation::NavPilot::Params pilot;
  autonomy::MarineOptions marine;
  autonomy::Participation participation;
  std::string algorithm = "naive";
  std::string plugin;
  int frame_bytes = 32;
  std::string sound = "straight";
};

/// The pilot, once the world is known: the state of the program.
using State = std::optional<navigation::NavPilot>;

template <class Message>
void listen(shoal::Client& client, State& pilot, const std::optional<navigation::NavDevice>& device) {
  if (!device) return;
  client.subscribe<Message>(device->channel, [&](const Message& message) {
    if (pilot) pilot->receive(message);
  });
}

void subscribe(shoal::Client& client, State& pilot, const navigation::NavVehicle& vehicle) {
  listen<shoal::dvl_t>(client, pilot, vehicle.dvl);
  listen<shoal::ins_t>(client, pilot, vehicle.ahrs);
  listen<shoal::compass_t>(client, pilot, vehicle.compass);
  listen<shoal::pressure_t>(client, pilot, vehicle.pressure);
  listen<shoal::gps_data_t>(client, pilot, vehicle.gps);
  listen<shoal::usbl_t>(client, pilot, vehicle.usbl);
  listen<shoal::acoustic_received_t>(client, pilot, vehicle.modem);
}

int drive(const Options& options) {
  const std::string& name = options.pilot.name;
  shoal::Client client(name, options.participation.lcm_url);
  State pilot;
  navigation::NavVehicle vehicle;
  // The team is that of the resolved world, which the run publishes; until it comes, the program only takes part in
  // the lockstep.
  client.subscribe<shoal::sim_info_t>("sim.info", [&](const shoal::sim_info_t& info) {
    if (!vehicle.name.empty()) return;
    const auto team = std::make_shared<const navigation::NavTeam>(navigation::team_of_text(info.resolved_config));
    pilot.emplace(team, options.pilot, options.marine.make(name));
    vehicle = team->vehicles[static_cast<std::size_t>(*team->index_of(name))];
    subscribe(client, pilot, vehicle);
  });
  const int exit_code = autonomy::take_part(client, options.participation, pilot, [&](std::int64_t) {
    if (!pilot) return;
    const navigation::NavPilot::Decision decision = pilot->step();
    if (decision.helm && !vehicle.helm_command.empty()) client.publish(vehicle.helm_command, *decision.helm);
    if (decision.estimate) client.publish(name + ".estimate", *decision.estimate);
    if (decision.send) client.publish(vehicle.modem_command, *decision.send);
  });
  if (pilot)
    std::cerr << name << ": " << options.algorithm << ", " << pilot->counts().frames << " frames received, "
              << pilot->navigation().ranges() << " ranges used, " << pilot->counts().sent << " frames sent\n";
  return exit_code;
}

int run(int argc, char** argv) {
  if (navigation::is_list(argc, argv) && navigation::is_offline(argc, argv))
    throw std::invalid_argument("--list prints the algorithms, and reads no --log: give one of them");
  if (navigation::is_list(argc, argv)) return navigation::run_list_command(argc, argv);
  if (navigation::is_offline(argc, argv)) return navigation::run_offline_command(argc, argv);
  Options options;
  options.participation.period_s = 0.5;
  CLI::App app{"Steers a marine vehicle that navigates cooperatively, by an algorithm of a list.", "shoal-nav"};
  command_line::DeclaredOptions declared(app);
  declared.publishes({"{name}.autopilot.cmd", "{name}.estimate", "{name}.modem.cmd"});
  declared.subscribes(
      {"{name}.dvl", "{name}.ahrs", "{name}.compass", "{name}.pressure", "{name}.gps", "{name}.usbl", "{name}.modem"});
  autonomy::add_name(declared, options.pilot.name, "vehicle to steer").required();
  declared.text("algorithm", "NAME", options.algorithm,
                "algorithm, see docs/guides/compare_estimators.md, or python:FILE.Class");
  declared.text("plugin", "FILE", options.plugin, "library with further algorithms");
  declared.integer("frame_bytes", options.frame_bytes, 11, 255,
                   "length of each frame, equal for all vehicles: 10 and its payload");
  declared.number("depth_m", options.pilot.depth_m, 0, 10'000, "depth to dive to; 0: a surface craft");
  declared.choice("sound", options.sound, {"straight", "rays"},
                  "how sound is assumed to travel: along straight lines, with the harmonic mean of the sound speed "
                  "between both depths, or along rays refracted by the sound speed profile");
  auto& start = options.pilot.navigation.start;
  declared.tuple(
      "start_m", {"x", "y"}, sim::any_place(),
      [&start](const auto& numbers) { start.p_W = navigation::Vector2(numbers[0], numbers[1]); },
      "known position at the start, east and north; without it the vehicle waits for GPS");
  declared.number("start_std_m", start.std_m, 0.001, 10'000, "error of that position");
  declared.number("surface_s", options.pilot.surface_s, 0, 3600, "time at the surface after the first fix");
  options.marine.declare(declared);
  declared.at_most_one({"slot", "random_s"});
  options.participation.declare(declared);
  // For the help only: with --log the command line is that of run_offline_command().
  std::string log, out, from_s;
  bool list = false;
  app.add_option("--log", log, "navigate all vehicles of this record instead; see `shoal-nav --log FILE --help`")
      ->type_name("FILE");
  app.add_option("--out", out, "with --log: folder for the estimates")->type_name("DIR");
  app.add_option("--from-s", from_s, "with --log: scores begin at this simulated time")->type_name("S");
  app.add_flag("--list", list, "print the algorithms instead");
  autonomy::set_help_end(
      declared,
      {"shoal-nav --name auv1 --algorithm iu --waypoints-m '[[400,0],[400,60]]' --depth-m 15 --slot 0 --slots 4",
       "shoal-nav --log run.lcm --algorithm dr,naive,ci,iu,cekf", "shoal-nav --list"},
      "Errors of devices, clocks and the speed of sound are those in the vehicle files of the world.  It reads "
      "NAME.dvl, "
      ".ahrs or .compass, .pressure, .gps, .usbl and .modem; it publishes NAME.autopilot.cmd, .estimate and, with "
      "--slot or "
      "--random-s, .modem.cmd.  With --log it navigates all vehicles of a record instead: "
      "see `shoal-nav --log FILE --help`.");
  if (const auto exit_code = declared.parse(argc, argv)) return *exit_code;
  const bool follows = !options.marine.follow.empty();
  if (follows || !options.marine.leader.empty())
    throw std::invalid_argument(std::string(follows ? "--follow" : "--leader") +
                                " needs frames with the state of a vehicle, which only shoal-coop-auv sends");
  if (!options.plugin.empty()) command_line::load_plugin(options.plugin);
  options.pilot.algorithm = &navigation::algorithm_named(options.algorithm);
  if (!options.pilot.algorithm->make)
    throw std::invalid_argument(options.algorithm + " has the measurements of all vehicles: it runs with --log only");
  if (!options.pilot.algorithm->at_sea)
    throw std::invalid_argument(options.algorithm + " does not use acoustic ranges: it works on land only");
  options.pilot.navigation.frame_bytes = static_cast<std::size_t>(options.frame_bytes);
  options.pilot.navigation.sound = navigation::sound_models().at(options.sound);
  options.pilot.navigation.period_us = std::llround(1e6 * options.participation.period_s);
  options.pilot.access = options.marine.access();
  return drive(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-nav", [&] { return run(argc, argv); });
}
