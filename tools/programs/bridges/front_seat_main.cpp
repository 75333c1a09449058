// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <iostream>
#include <memory>
#include <mutex>

#include "bridges/lcm/lcm_connection.hpp"
#include "bridges/moos/front_seat.hpp"
#include "bridges/moos/line_server.hpp"
#include "shoal/sim_info_t.hpp"
#include "tools/programs/bridges/bridge_options.hpp"
#include "tools/programs/program.hpp"

namespace {

struct Options {
  autonomy::BridgedVehicle vehicle;
  std::string protocol = "goby";
  int port = 54321;
  autonomy::Participation participation;
};

std::unique_ptr<bridges::FrontSeat> made_seat(const Options& options) {
  if (options.protocol == "goby")
    return std::make_unique<bridges::GobyFrontSeat>(options.vehicle.command_channel(options.vehicle.autopilot));
  if (options.vehicle.port_thruster.empty())
    throw std::invalid_argument("--protocol m300 needs --port-thruster and --starboard-thruster");
  return std::make_unique<bridges::HeronFrontSeat>(options.vehicle.thrusters());
}

/// The vehicle's computer: it follows the run, and serves one back seat.  Commands go to the vehicle as they arrive.
class FrontSeatServer {
 public:
  explicit FrontSeatServer(const Options& options)
      : options_(options),
        seat_(made_seat(options)),
        navigation_(options.vehicle.name, options.vehicle.position()),
        client_(options.vehicle.name, options.participation.lcm_url),
        lcm_(options.participation.lcm_url),
        server_(options.port, {[this] { begin(); }, [this](const std::string& bytes) { return take(bytes); }}) {
    client_.subscribe<shoal::sim_info_t>("sim.info", [this](const shoal::sim_info_t& info) {
      const sim::GeodeticPosition origin = autonomy::origin_of_world(info.resolved_config);
      navigation_.set_origin(origin.latitude_deg, origin.longitude_deg);
    });
    options_.vehicle.subscribe(client_, navigation_, [](bridges::VehicleNavigation::Fields) {});
    std::cerr << "shoal-frontseat: " << options.protocol << " for '" << options.vehicle.name
              << "' at 127.0.0.1:" << server_.port() << '\n';
  }

  int run() {
    return autonomy::take_part(client_, options_.participation, memory_, [this](std::int64_t utime) {
      utime_ = utime;
      const std::lock_guard lock(mutex_);
      server_.send(seat_->state(navigation_, utime));
    });
  }

 private:
  void begin() {
    const std::lock_guard lock(mutex_);
    lines_ = {};
    seat_->begin();
  }

  std::string take(const std::string& bytes) {
    const std::lock_guard lock(mutex_);
    std::string answer;
    for (const std::string& line : lines_.add(bytes)) {
      const bridges::FrontSeat::Reply reply = seat_->take(line, utime_);
      answer += reply.lines;
      for (const bridges::ChannelPayload& command : reply.commands)
        lcm_.publish(command.channel.c_str(), command.payload);
    }
    return answer;
  }

  const Options& options_;
  std::mutex mutex_;  // of the seat and its lines
  const std::unique_ptr<bridges::FrontSeat> seat_;
  bridges::LineReader lines_;
  std::atomic<std::int64_t> utime_ = 0;
  bridges::VehicleNavigation navigation_;
  int memory_ = 0;  // what goes back with the world: nothing
  shoal::Client client_;
  bridges::LcmConnection lcm_;
  bridges::LineServer server_;
};

void declare(command_line::DeclaredOptions& options, Options& seat) {
  options.subscribes({"{name}.{gps}", "{name}.{ahrs}", "{name}.{compass}", "{name}.{pressure}", "{name}.{altimeter}",
                      "{name}.{dvl}", "{estimate}"});
  autonomy::add_name(options, seat.vehicle.name, "vehicle with this front seat").required();
  options.choice("protocol", seat.protocol, {"goby", "m300"},
                 "lines of Goby's basic_simulator, or sentences of the Heron M300");
  options.integer("port", seat.port, 0, 65535, "TCP port on this machine; 0: any");
  seat.vehicle.declare(options);
  seat.participation.declare(options);
}

int run(int argc, char** argv) {
  Options seat;
  seat.participation.in_lockstep = false;
  CLI::App app{"Serves a back seat over TCP as the front seat of a vehicle of a run.", "shoal-frontseat"};
  command_line::DeclaredOptions options(app);
  declare(options, seat);
  autonomy::set_help_end(options,
                         {"shoal-frontseat --name alpha --port 54321",
                          "shoal-frontseat --name alpha --protocol m300 --port 29500 --port-thruster port "
                          "--starboard-thruster starboard --full-ahead 103.9"},
                         "docs/guides/attach_moos.md describes the lines.");
  if (const auto exit_code = options.parse(argc, argv)) return *exit_code;
  return FrontSeatServer(seat).run();
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-frontseat", [&] { return run(argc, argv); });
}
