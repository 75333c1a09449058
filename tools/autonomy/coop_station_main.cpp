#include <iostream>

#include "tools/autonomy/coop_station.hpp"
#include "tools/autonomy/marine_options.hpp"
#include "tools/autonomy/program.hpp"

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
  CLI::App app{"Sends a submerged vehicle to places, by radio and by whoever passes its messages on."};
  app.add_option("--name", station.name, "vehicle that is the station; also the name in the lockstep")->required();
  app.add_option("--id", station.id, "in its frames")->capture_default_str()->check(CLI::Range(0, 255));
  app.add_option("--to", station.to_id, "id of the vehicle that gets the orders")
      ->required()
      ->check(CLI::Range(0, 255));
  app.add_option("--orders", orders,
                 "\"TIME:X,Y,DEPTH;TIME:X,Y,DEPTH,SPEED;...\": s after the start, east, north and depth in m, m/s")
      ->required();
  app.add_option("--speed", speed_mps, "of orders without one, m/s through the water")
      ->capture_default_str()
      ->check(autonomy::between(0.05, 10.0));
  sending.add_options(app, "its order");
  participation.add_options(app);
  app.footer(std::string("It reads NAME.gps and NAME.radio; it publishes NAME.radio.cmd and NAME.knowledge, where the "
                         "vehicle was by\nits newest state.\n"
                         "Example:\n"
                         "  shoal-coop-station --name station --to 0 --slot 1/3 --orders "
                         "\"120:500,200,15;600:900,-100,20,1.2\"\n") +
             autonomy::exit_code_help);
  if (const auto exit_code = autonomy::parse(app, argc, argv)) return *exit_code;
  station.access = sending.access();
  if (!station.access.slot && station.access.random_mean_s <= 0)
    throw std::invalid_argument("a station that never sends is of no use; give --slot or --random-s");
  station.orders = autonomy::parse_orders(orders, speed_mps);
  return drive(station, participation);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-coop-station", [&] { return run(argc, argv); });
}
