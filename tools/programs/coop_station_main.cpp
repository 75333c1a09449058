// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "autonomy/missions/marine/coop_station.hpp"
#include "tools/programs/marine_options.hpp"
#include "tools/programs/program.hpp"

namespace {

int drive(const autonomy::CoopStation::Params& params, const autonomy::Participation& participation) {
  autonomy::CoopStation station(params);
  shoal::Client client(params.name, participation.lcm_url);
  client.subscribe<shoal::gps_data_t>(params.name + ".gps",
                                      [&](const shoal::gps_data_t& fix) { station.receive(fix); });
  client.subscribe<shoal::modem_received_t>(params.name + ".radio",
                                            [&](const shoal::modem_received_t& packet) { station.receive(packet); });
  const int exit_code = autonomy::take_part(client, participation, station, [&](std::int64_t) {
    const autonomy::CoopStation::Decision decision = station.step();
    if (!decision.status.empty()) std::cerr << params.name << ": " << decision.status << std::endl;
    if (decision.knowledge) client.publish(params.name + ".knowledge", *decision.knowledge);
    if (decision.send) client.publish(params.name + ".radio.cmd", *decision.send);
  });
  const autonomy::CoopStation::Counts& counts = station.counts();
  std::cerr << params.name << ": " << counts.executed << " of " << counts.orders << " orders executed, "
            << counts.refused << " refused, sent " << counts.sent << " times; " << counts.states << " states received, "
            << counts.bad_frames << " bad frames\n";
  return exit_code;
}

int run(int argc, char** argv) {
  autonomy::CoopStation::Params station;
  autonomy::AccessOptions sending;
  autonomy::Participation participation;
  participation.period_s = 0.5;
  std::vector<std::vector<double>> orders;
  double speed_mps = 1.5;
  CLI::App app{"Sends orders to a submerged vehicle by radio, relayed by other vehicles.", "shoal-coop-station"};
  command_line::DeclaredOptions options(app);
  // Channels and options.
  options.publishes({"{name}.radio.cmd", "{name}.knowledge"});
  options.subscribes({"{name}.gps", "{name}.radio"});
  autonomy::add_name(options, station.name, "vehicle that is the station").required();
  autonomy::add_id(options, "id", station.id, "number of the station in its frames");
  autonomy::add_id(options, "to", station.to_id, "number of the vehicle that gets the orders").required();
  options
      .tuples(
          "orders", {"time_s", "x_m", "y_m", "depth_m", "speed_mps"}, 4, sim::any_place(),
          [&](const auto& lists) { orders = lists; },
          "orders, each the time after the start, the position east and north, the depth, and the speed unless it is "
          "that of speed_mps")
      .required();
  options.number("speed_mps", speed_mps, 0.05, 10, "speed of orders without one, through the water");
  sending.declare(options, "its order");
  options.exactly_one({"slot", "random_s"});
  participation.declare(options);
  autonomy::set_help_end(options,
                         {"shoal-coop-station --name station --to 0 --slot 1 --slots 3 --orders "
                          "'[[120,500,200,15],[600,900,-100,20,1.2]]'"},
                         "It reads NAME.gps and NAME.radio; it publishes NAME.radio.cmd and NAME.knowledge, the "
                         "position of the vehicle by its "
                         "newest state.");
  if (const auto exit_code = options.parse(argc, argv)) return *exit_code;
  station.access = sending.access();
  if (!station.access.slot && station.access.random_mean_s <= 0)
    throw std::invalid_argument("--random-s must be above 0 for a station");
  for (const std::vector<double>& order : orders)
    station.orders.push_back({order[0], {order[1], order[2]}, order[3], order.size() > 4 ? order[4] : speed_mps});
  return drive(station, participation);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-station", [&] { return run(argc, argv); });
}
