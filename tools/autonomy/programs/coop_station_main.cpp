// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "tools/autonomy/missions/coop_station.hpp"
#include "tools/autonomy/programs/marine_options.hpp"
#include "tools/autonomy/programs/program.hpp"

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
    if (!decision.news.empty()) std::cerr << params.name << ": " << decision.news << std::endl;
    if (decision.knowledge) client.publish(params.name + ".knowledge", *decision.knowledge);
    if (decision.send) client.publish(params.name + ".radio.cmd", *decision.send);
  });
  const autonomy::CoopStation::Counts& counts = station.counts();
  std::cerr << params.name << ": " << counts.obeyed << " of " << counts.orders << " orders obeyed, " << counts.refused
            << " refused, sent " << counts.sent << " times; " << counts.states << " states heard, " << counts.bad_frames
            << " bad frames\n";
  return exit_code;
}

int run(int argc, char** argv) {
  autonomy::CoopStation::Params station;
  autonomy::AccessOptions sending;
  autonomy::Participation participation;
  participation.period_s = 0.5;
  std::string orders;
  double speed_mps = 1.5;
  CLI::App app{"Sends orders to a submerged vehicle, by radio and by whoever relays its messages.",
               "shoal-coop-station"};
  autonomy::add_name(app, station.name, "vehicle that is the station")->required();
  autonomy::add_id(app, "--id", station.id, "of the station in its frames")->capture_default_str();
  autonomy::add_id(app, "--to", station.to_id, "id of the vehicle that gets the orders")->required();
  app.add_option("--orders", orders,
                 "\"TIME:X,Y,DEPTH;TIME:X,Y,DEPTH,SPEED;...\": s after the start, east, north and depth in m, m/s")
      ->type_name("ORDERS")
      ->required();
  autonomy::add_number(app, "--speed", speed_mps, "M/S", 0.05, 10, "of orders without one, through the water");
  sending.add_options(app, "its order");
  participation.add_options(app);
  autonomy::set_help_end(
      app, {"shoal-coop-station --name station --to 0 --slot 1/3 --orders \"120:500,200,15;600:900,-100,20,1.2\""},
      "It reads NAME.gps and NAME.radio; it publishes NAME.radio.cmd and NAME.knowledge, where the vehicle was by its "
      "newest state.");
  if (const auto exit_code = autonomy::parse(app, argc, argv)) return *exit_code;
  station.access = sending.access();
  if (!station.access.slot && station.access.random_mean_s <= 0)
    throw std::invalid_argument("a station that never sends is of no use; give --slot or --random-s");
  station.orders = autonomy::read_option("--orders", [&] { return autonomy::parse_orders(orders, speed_mps); });
  return drive(station, participation);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-station", [&] { return run(argc, argv); });
}
