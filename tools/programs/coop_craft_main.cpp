// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "autonomy/missions/marine/coop_craft.hpp"
#include "tools/programs/avoid_options.hpp"
#include "tools/programs/marine_options.hpp"
#include "tools/programs/program.hpp"

namespace {

int drive(const autonomy::CoopCraft::Params& params, const autonomy::MarineOptions& marine,
          const autonomy::AvoidOptions& avoid, const autonomy::Participation& participation) {
  autonomy::CoopCraft craft(params, avoid.around(marine.make(params.name)));
  shoal::Client client(params.name, participation.lcm_url);
  const auto listen = [&]<class Message>(const char* device) {
    client.subscribe<Message>(params.name + device, [&](const Message& message) { craft.receive(message); });
  };
  listen.operator()<shoal::gps_data_t>(".gps");
  listen.operator()<shoal::acoustic_received_t>(".modem");
  listen.operator()<shoal::ins_t>(".ahrs");
  listen.operator()<shoal::planar_lidar_t>(".lidar");
  const int exit_code = autonomy::take_part(client, participation, craft, [&](std::int64_t) {
    const autonomy::CoopCraft::Decision decision = craft.step();
    if (decision.helm) client.publish(params.name + ".autopilot.cmd", *decision.helm);
    if (decision.estimate) client.publish(params.name + ".estimate", *decision.estimate);
    if (!decision.remark.empty()) std::cerr << params.name << ": " << decision.remark << '\n';
    if (decision.send) client.publish(params.name + ".modem.cmd", *decision.send);
  });
  const autonomy::CoopCraft::Counts& counts = craft.counts();
  std::cerr << params.name << ": " << counts.sent << " frames sent, " << counts.received << " received, "
            << counts.bad_frames << " bad\n";
  if (counts.relayed > 0) std::cerr << params.name << ": " << counts.relayed << " states came by relay\n";
  if (const std::string remark = craft.behavior().remark(); !remark.empty())
    std::cerr << params.name << ": " << remark << '\n';
  return exit_code;
}

int run(int argc, char** argv) {
  autonomy::CoopCraft::Params craft;
  autonomy::MarineOptions marine;
  autonomy::AvoidOptions avoid;
  autonomy::Participation participation;
  participation.period_s = 0.5;
  CLI::App app{"Steers a surface craft that sends its GPS position by acoustic modem.", "shoal-coop-craft"};
  command_line::DeclaredOptions options(app);
  // Channels and options.
  options.publishes({"{name}.autopilot.cmd", "{name}.modem.cmd", "{name}.estimate"});
  options.subscribes({"{name}.gps", "{name}.modem", "{name}.ahrs", "{name}.lidar"});
  autonomy::add_name(options, craft.name, "vehicle to steer").required();
  autonomy::add_id(options, "id", craft.id, "number of the vehicle in its frames");
  options.number("transducer_depth_m", craft.transducer_depth_m, 0, 1000, "depth of its modem below the surface");
  marine.declare(options);
  avoid.declare(options);
  options.at_most_one({"slot", "random_s"});
  participation.declare(options);
  autonomy::set_help_end(
      options,
      {"shoal-coop-craft --name boat1 --circle-m '[100,50,40]' --slot 0 --slots 2",
       "shoal-coop-craft --name boat2 --follow auv --follow-offset-m '[0,-60]' --speed-mps 2 --slot 1 --slots 3"},
      "It reads NAME.gps, .modem and, for --avoid and --leader, .ahrs and .lidar; it publishes NAME.autopilot.cmd, "
      ".modem.cmd and .estimate.");
  // Parse the command line and run.
  if (const auto exit_code = options.parse(argc, argv)) return *exit_code;
  craft.period_s = participation.period_s;
  craft.access = marine.access();
  return drive(craft, marine, avoid, participation);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-craft", [&] { return run(argc, argv); });
}
