#include <iostream>

#include "tools/autonomy/coop_craft.hpp"
#include "tools/autonomy/marine_options.hpp"
#include "tools/autonomy/program.hpp"

namespace {

int drive(const autonomy::CoopCraft::Params& params, const autonomy::MarineOptions& marine,
          const autonomy::Participation& participation) {
  autonomy::CoopCraft craft(params, marine.make(params.name));
  shoal::Client client(params.name, participation.lcm_url);
  const auto listen = [&]<class Message>(const char* device) {
    client.subscribe<Message>(params.name + device, [&](const Message& message) { craft.receive(message); });
  };
  listen.operator()<shoal::gps_data_t>(".gps");
  listen.operator()<shoal::acoustic_received_t>(".modem");
  const int exit_code = autonomy::take_part(client, participation, craft, [&](std::int64_t) {
    const autonomy::CoopCraft::Decision decision = craft.step();
    if (decision.helm) client.publish(params.name + ".autopilot.cmd", *decision.helm);
    if (decision.estimate) client.publish(params.name + ".estimate", *decision.estimate);
    if (!decision.remark.empty()) std::cerr << params.name << ": " << decision.remark << '\n';
    if (decision.send) client.publish(params.name + ".modem.cmd", *decision.send);
  });
  const autonomy::CoopCraft::Counts& counts = craft.counts();
  std::cerr << params.name << ": " << counts.sent << " frames sent, " << counts.heard << " heard, " << counts.bad_frames
            << " bad\n";
  if (counts.relayed > 0) std::cerr << params.name << ": " << counts.relayed << " states came by relay\n";
  if (const std::string remark = craft.behaviour().remark(); !remark.empty())
    std::cerr << params.name << ": " << remark << '\n';
  return exit_code;
}

int run(int argc, char** argv) {
  autonomy::CoopCraft::Params craft;
  autonomy::MarineOptions marine;
  autonomy::Participation participation;
  participation.period_s = 0.5;
  CLI::App app{"Steers a surface craft that tells by acoustic modem where GPS says it is."};
  app.add_option("--name", craft.name, "vehicle to steer; also the name in the lockstep")->required();
  app.add_option("--id", craft.id, "in its frames")->capture_default_str()->check(CLI::Range(0, 255));
  app.add_option("--transducer-depth", craft.transducer_depth_m, "of its modem, m")
      ->capture_default_str()
      ->check(autonomy::between(0.0, 1000.0));
  marine.add_options(app);
  participation.add_options(app);
  app.footer(
      std::string("It reads NAME.gps and NAME.modem; it publishes NAME.autopilot.cmd, .modem.cmd and .estimate.\n"
                  "Examples:\n"
                  "  shoal-coop-craft --name boat1 --behaviour circle:100,50,40 --slot 0/2\n"
                  "  shoal-coop-craft --name boat2 --behaviour follow:auv,0,-60 --speed 2 --slot 1/3\n") +
      autonomy::exit_code_help);
  if (const auto exit_code = autonomy::parse(app, argc, argv)) return *exit_code;
  craft.period_s = participation.period_s;
  craft.access = marine.access();
  return drive(craft, marine, participation);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-craft", [&] { return run(argc, argv); });
}
