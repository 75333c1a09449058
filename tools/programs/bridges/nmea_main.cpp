// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "bridges/nmea/ais_payload.hpp"
#include "bridges/nmea/nmea_server.hpp"
#include "bridges/nmea/own_ship.hpp"
#include "bridges/nmea/steering.hpp"
#include "bridges/nmea/true_state.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "shoal/sim_vehicle_t.hpp"
#include "sim/config/message_text.hpp"
#include "tools/programs/program.hpp"

namespace {

using bridges::nmea::NmeaServer;

struct Options {
  std::string name = "nmea", vehicle;
  std::string listen = "127.0.0.1:10110", udp;
  bool steer = false, truth = false;
  double variation_deg = 0;
  autonomy::Participation participation;
};

/// Lines on standard error, of which a peer can cause a thousand at most.  Used by two threads.
class Notes {
 public:
  explicit Notes(std::string name) : name_(std::move(name)) {}
  void operator()(const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (count_ > most) return;
    std::cerr << name_ + ": " + (count_++ < most ? text : "further notes are left out") + "\n";
  }
  /// The same, once for each text.
  void once(const std::string& text) {
    if (said_.insert(text).second) (*this)(text);
  }

 private:
  static constexpr int most = 1000;

  std::mutex mutex_;
  std::string name_;
  int count_ = 0;
  std::set<std::string> said_;  // bounded, as are the texts: see Steering::take()
};

/// The door of one vehicle: its reports as sentences, sentences of an autopilot as commands.
class Door {
 public:
  Door(shoal::Client& client, NmeaServer& server, Notes& notes, const Options& options)
      : client_(client), server_(server), notes_(notes), options_(options), steering_(options.variation_deg) {
    if (options.truth) {
      subscribe_to_truth();
      return;
    }
    client_.subscribe<shoal::sim_vehicle_t>("sim.vehicle", [this](const auto& vehicle) { subscribe(vehicle); });
    client_.subscribe<shoal::sim_control_reply_t>("sim.control.reply", [this](const auto& reply) {
      if (reply.client == options_.name && reply.id == request_id && reply.ok == 0)
        throw std::invalid_argument("--vehicle: " + reply.text);
    });
  }

  void tick(std::int64_t utime) {
    own_.set_time(utime);
    if (!known_ && !options_.truth) ask_for_vehicle(utime);
    for (const NmeaServer::Line& line : server_.take_lines()) take(line, utime);
    if (const auto command = steering_.take_command(); command && !helm_channel_.empty())
      client_.publish(helm_channel_, *command);
    server_.send(own_.sentences());
    if (!truth_) return;
    for (const shoal::ais_t& message : truth_->ais(utime)) send(message);
  }

 private:
  static constexpr std::int32_t request_id = 1;

  void ask_for_vehicle(std::int64_t utime) {
    shoal::sim_control_request_t request{};
    request.utime = utime;
    request.id = request_id;
    request.client = options_.name;
    request.command = "describe";
    request.text = options_.vehicle;
    client_.publish("sim.control", request);
  }

  template <class Message>
  void listen(const std::string& channel) {
    client_.subscribe<Message>(channel, [this](const Message& message) { own_.receive(message); });
  }

  void subscribe(const shoal::sim_vehicle_t& vehicle) {
    if (known_ || vehicle.vehicle != options_.vehicle || vehicle.present == 0) return;
    known_ = true;
    std::string used;
    for (std::size_t i = 0; i < vehicle.device.size(); ++i) {
      const std::string& reports = vehicle.report_channel[i];
      if (const auto use = devices().find(vehicle.device_type[i]); use != devices().end() && !reports.empty()) {
        (this->*use->second)(reports);
        used += (used.empty() ? "" : ", ") + reports;
      }
      if (vehicle.device_type[i] == "autopilot") helm_channel_ = vehicle.command_channel[i];
    }
    notes_(used.empty() ? "'" + vehicle.vehicle + "' has no device for a sentence" : "sentences of " + used);
    if (options_.steer && helm_channel_.empty())
      notes_("--steer has no effect: '" + vehicle.vehicle + "' has no device of type autopilot");
  }

  /// The devices that are used, by their types.
  using Use = void (Door::*)(const std::string& channel);
  static const std::map<std::string, Use, std::less<>>& devices() {
    static const std::map<std::string, Use, std::less<>> all{
        {"gps", &Door::listen_to_gps},
        {"ahrs", &Door::listen<shoal::ins_t>},
        {"compass", &Door::listen<shoal::compass_t>},
        {"inclinometer", &Door::listen<shoal::inclination_t>},
        {"water_speed", &Door::listen<shoal::water_speed_t>},
        {"dvl", &Door::listen<shoal::dvl_t>},
        {"altimeter", &Door::listen<shoal::sonar_range_t>},
        {"pressure", &Door::listen<shoal::pressure_t>},
        {"ctd", &Door::listen<shoal::ctd_t>},
        {"wind_sensor", &Door::listen<shoal::wind_t>},
        {"ais", &Door::listen_to_ais},
    };
    return all;
  }
  void listen_to_gps(const std::string& channel) {
    own_.has_gps();
    listen<shoal::gps_data_t>(channel);
  }
  void listen_to_ais(const std::string& channel) {
    client_.subscribe<shoal::ais_t>(channel, [this](const shoal::ais_t& message) { send(message); });
  }
  void send(const shoal::ais_t& message) {
    ais_group_ = (ais_group_ + 1) % 10;
    const auto second = static_cast<int>(message.utime / 1'000'000 % 60);
    server_.send(bridges::nmea::ais_sentences(message, second, ais_group_));
  }

  void subscribe_to_truth() {
    own_.has_gps();
    truth_.emplace(options_.vehicle);
    client_.subscribe<shoal::sim_info_t>("sim.info", [this](const auto& info) { truth_->receive(info); });
    client_.subscribe<shoal::sim_state_t>("sim.state", [this](const auto& state) {
      if (!truth_->receive(state)) return;
      own_.receive(truth_->gps());
      own_.receive(truth_->ins());
    });
    helm_channel_ = options_.vehicle + ".autopilot.cmd";
  }

  void take(const NmeaServer::Line& line, std::int64_t utime) {
    if (!options_.steer) return notes_.once("sentences from clients are ignored without --steer");
    if (const std::string fault = steering_.take(line.text, utime); !fault.empty())
      notes_.once("a line of a client is ignored: " + fault);
  }

  shoal::Client& client_;
  NmeaServer& server_;
  Notes& notes_;
  const Options& options_;
  bridges::nmea::OwnShip own_;
  bridges::nmea::Steering steering_;
  std::optional<bridges::nmea::TrueState> truth_;
  std::string helm_channel_;
  bool known_ = false;
  int ais_group_ = 0;
};

int serve(const Options& options) {
  Notes notes(options.name);
  shoal::Client client(options.name, options.participation.lcm_url);
  NmeaServer::Options sockets;
  if (options.listen != "none") sockets.listen = bridges::nmea::read_endpoint(options.listen);
  if (!options.udp.empty()) sockets.udp = bridges::nmea::read_endpoint(options.udp);
  sockets.log = [&notes](const std::string& text) { notes(text); };
  NmeaServer server(sockets);
  if (server.port() != 0) notes("listens at port " + std::to_string(server.port()));
  Door door(client, server, notes, options);
  const auto tick = [&](std::int64_t utime) { door.tick(utime); };
  struct Nothing {};  // after a rewind all that it knows is reported again
  Nothing state;
  return autonomy::take_part(client, options.participation, state, tick);
}

void declare(command_line::DeclaredOptions& declared, Options& options) {
  declared.publishes({"{vehicle}.autopilot.cmd"});
  declared.subscribes({});
  declared.text("vehicle", "VEHICLE", options.vehicle, "vehicle whose instruments these are").required();
  declared.text("name", "NAME", options.name, "its client name in the run");
  declared.text("listen", "ADDRESS", options.listen,
                "HOST:PORT of the TCP server; port 0: any free one; none: no server");
  declared.text("udp", "ADDRESS", options.udp, "HOST:PORT to which each sentence is also sent in a datagram");
  declared.flag("steer", options.steer, "sentences of clients steer: APB and RMB command the autopilot of the vehicle");
  declared.number("variation_deg", options.variation_deg, -180, 180,
                  "magnetic variation of headings to steer, positive to the east");
  declared.flag("truth", options.truth,
                "true position and heading in place of devices, and all other vehicles as AIS targets");
  declared.flag("lockstep", options.participation.in_lockstep,
                "joins the lockstep, so that the world waits at each period");
  options.participation.declare(declared);
  autonomy::set_help_end(
      declared, {"shoal-nmea --vehicle boat", "shoal-nmea --vehicle boat --steer --listen 0.0.0.0:10110"},
      "Each period it sends RMC, GGA, VTG, HDT, ROT, VHW, DBT, DPT, MWV and XDR, as far as the vehicle has devices for "
      "them: gps, ahrs, compass, inclinometer, water_speed, dvl, altimeter, pressure, ctd, wind_sensor; and, as AIVDO "
      "and AIVDM, what an ais device sends and receives.  Clients that do not take what they are sent are cut.  "
      "docs/guides/attach_nmea.md explains it.");
}

int run(int argc, char** argv) {
  Options options;
  options.participation.period_s = 1;
  options.participation.in_lockstep = false;
  CLI::App app{"Instruments of a vehicle for chart plotters: sentences of NMEA 0183 and AIS over TCP and UDP.",
               "shoal-nmea"};
  command_line::DeclaredOptions declared(app);
  declare(declared, options);
  if (const auto exit_code = declared.parse(argc, argv)) return *exit_code;
  if (options.listen == "none" && options.udp.empty()) throw std::invalid_argument("--listen none needs --udp");
  return serve(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-nmea", [&] { return run(argc, argv); });
}
