// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <iostream>
#include <iterator>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "bridges/lcm/lcm_connection.hpp"
#include "bridges/moos/moos_connection.hpp"
#include "bridges/moos/moos_file.hpp"
#include "bridges/moos/moos_variables.hpp"
#include "shoal/sim_info_t.hpp"
#include "sim/base/number.hpp"
#include "tools/programs/bridges/bridge_options.hpp"
#include "tools/programs/program.hpp"

namespace {

using bridges::MoosCommands;
using bridges::MoosConnection;
using bridges::MoosMessage;
using bridges::MoosValue;
using bridges::VehicleNavigation;

struct Options {
  autonomy::BridgedVehicle vehicle;
  std::string moos, peer, client = "shoal-moos", control = "helm", answer;
  std::optional<int> port;
  double answer_timeout_s = 30;
  bool no_node_report = false;
  bridges::MoosNode node;
  std::string drive = "drive", lidar = "lidar", odometry = "odometry", modem = "modem";
  autonomy::Participation participation;
};

/// Wall time as clocks of a community show it.
double moos_time_s(double time_warp) {
  return time_warp * std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Messages of the community, on their way to the vehicle.  In lockstep they wait for the ticks of the run, otherwise
/// the thread of the connection publishes the commands at once.
class Inbox {
 public:
  Inbox(const Options& options, MoosCommands::Options commands)
      : commands_(std::move(commands)), answer_(options.answer) {
    if (!options.participation.in_lockstep) lcm_.emplace(options.participation.lcm_url);
  }

  std::vector<std::string> variables() const {
    std::vector<std::string> names = commands_.variables();
    if (!answer_.empty()) names.push_back(answer_);
    return names;
  }
  void set_time(std::int64_t utime) { utime_ = utime; }

  void take(const std::vector<MoosMessage>& messages) {
    const std::lock_guard lock(mutex_);
    for (const MoosMessage& message : messages) {
      commands_.take(message);
      if (message.key == answer_) answered_s_ = message.number;
    }
    arrived_.notify_all();
    if (!lcm_) return;
    for (const bridges::ChannelPayload& command : commands_.take_commands(utime_))
      lcm_->publish(command.channel.c_str(), command.payload);
  }

  /// Waits in lockstep until the community has answered the time of a tick.  Throws std::runtime_error.
  void await_answer(double time_s, double timeout_s) {
    if (answer_.empty()) return;
    std::unique_lock lock(mutex_);
    if (!arrived_.wait_for(lock, std::chrono::duration<double>(timeout_s),
                           [&] { return std::abs(answered_s_ - time_s) < 1e-5; }))
      throw std::runtime_error("the community did not post '" + answer_ + "' within " + std::to_string(timeout_s) +
                               " s");
  }
  std::vector<bridges::ChannelPayload> take_commands() {
    const std::lock_guard lock(mutex_);
    return commands_.take_commands(utime_);
  }
  std::uint64_t refused() {
    const std::lock_guard lock(mutex_);
    return commands_.refused();
  }

 private:
  std::optional<bridges::LcmConnection> lcm_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  MoosCommands commands_;
  const std::string answer_;
  double answered_s_ = 0;
  std::atomic<std::int64_t> utime_ = 0;
};

MoosCommands::Options commands_of(const Options& options) {
  MoosCommands::Options commands;
  commands.control = options.control == "helm"        ? MoosCommands::Control::helm
                     : options.control == "actuators" ? MoosCommands::Control::actuators
                                                      : MoosCommands::Control::none;
  commands.autopilot = options.vehicle.command_channel(options.vehicle.autopilot);
  commands.drive = options.vehicle.command_channel(options.drive);
  commands.modem = options.vehicle.command_channel(options.modem);
  commands.thrusters = options.vehicle.thrusters();
  return commands;
}

/// The run on one side, the community on the other.
class Bridge {
 public:
  Bridge(const Options& options, const bridges::MoosFile& file, const std::string& host)
      : options_(options),
        file_(file),
        navigation_(options.vehicle.name, options.vehicle.position()),
        inbox_(options, commands_of(options)),
        client_(options.vehicle.name, options.participation.lcm_url),
        moos_({host,
               options.port.value_or(file.port),
               {options.client, inbox_.variables(), file.time_warp},
               [this](const std::vector<MoosMessage>& messages) { inbox_.take(messages); },
               [](const std::string& sentence) { std::cerr << "shoal-moos: " << sentence << '\n'; }}) {
    subscribe();
    if (!options.participation.in_lockstep) client_.handle_in_batches([this] { flush(); });
  }

  int run() {
    // So that the community gets all from the first tick on, and equal runs are equal.
    if (!options_.answer.empty())
      moos_.await_open(std::chrono::milliseconds(std::llround(1000 * options_.answer_timeout_s)));
    const auto decide = [this](std::int64_t utime) { exchange(utime); };
    const int exit_code = autonomy::take_part(client_, options_.participation, report_due_, decide);
    flush();
    if (inbox_.refused() > 0)
      std::cerr << "shoal-moos: " << inbox_.refused() << " values were refused: no number, or no modem message\n";
    return exit_code;
  }

 private:
  void subscribe() {
    client_.subscribe<shoal::sim_info_t>("sim.info", [this](const shoal::sim_info_t& info) { take(info); });
    options_.vehicle.subscribe(client_, navigation_, [this](VehicleNavigation::Fields fields) {
      post(bridges::nav_values(navigation_, fields));
    });
    listen<shoal::planar_lidar_t>(options_.lidar, bridges::laser_value);
    listen<shoal::odometry_t>(options_.odometry, bridges::odometry_value);
    listen<shoal::modem_received_t>(options_.modem, bridges::modem_value);
  }
  template <class Message, class Value>
  void listen(const std::string& device, Value value) {
    if (device.empty()) return;
    client_.subscribe<Message>(options_.vehicle.name + "." + device,
                               [this, value](const Message& message) { post({value(message)}); });
  }

  /// Values that come together become one packet, as sending costs more than they do: in lockstep those of a tick.
  void post(std::vector<MoosValue> values) { std::move(values.begin(), values.end(), std::back_inserter(posted_)); }
  void flush() { moos_.notify(std::exchange(posted_, {})); }

  void take(const shoal::sim_info_t& info) {
    if (std::exchange(knows_world_, true)) return;
    const sim::GeodeticPosition origin = autonomy::origin_of_world(info.resolved_config);
    bridges::check_moos_origin(file_, info.world, origin.latitude_deg, origin.longitude_deg);
    navigation_.set_origin(origin.latitude_deg, origin.longitude_deg);
  }

  /// Gives the community the time and a node report, and the vehicle its commands.
  void exchange(std::int64_t utime) {
    inbox_.set_time(utime);
    const double time_s = 1e-6 * static_cast<double>(utime);
    // Also when a new run has begun, with an earlier time.
    if (!options_.no_node_report && (utime >= report_due_ || utime < report_due_ - report_period_us)) {
      post(bridges::node_report(options_.node, navigation_, moos_time_s(file_.time_warp)));
      report_due_ = utime + report_period_us;
    }
    post({{"SHOAL_TIME", time_s}});
    check_pace(time_s);
    if (!options_.participation.in_lockstep) return;
    flush();
    inbox_.await_answer(time_s, options_.answer_timeout_s);
    for (const bridges::ChannelPayload& command : inbox_.take_commands())
      client_.publish_bytes(command.channel, command.payload);
  }

  /// Warns once when simulated time is not as fast as the clocks of the community.
  void check_pace(double time_s) {
    const double wall_s = moos_time_s(1);
    if (!pace_start_) pace_start_ = {time_s, wall_s};
    const double elapsed_s = wall_s - pace_start_->second;
    if (pace_warned_ || elapsed_s < 10) return;
    const double pace = (time_s - pace_start_->first) / elapsed_s;
    pace_start_ = {time_s, wall_s};
    if (pace <= 0 || std::abs(pace / file_.time_warp - 1) < 0.2) return;  // the world may have been rewound
    pace_warned_ = true;
    std::cerr << "shoal-moos: simulated time runs " << sim::rounded_to(pace, 2)
              << " times as fast as wall time, MOOSTimeWarp is " << file_.time_warp << ": run with --speed "
              << file_.time_warp << '\n';
  }

  static constexpr std::int64_t report_period_us = 250'000;
  const Options& options_;
  const bridges::MoosFile& file_;
  VehicleNavigation navigation_;
  bool knows_world_ = false;
  std::int64_t report_due_ = 0;                          // utime; it goes back with the world
  std::optional<std::pair<double, double>> pace_start_;  // simulated and wall time
  bool pace_warned_ = false;
  std::vector<MoosValue> posted_;
  Inbox inbox_;
  shoal::Client client_;
  MoosConnection moos_;
};

void declare(command_line::DeclaredOptions& options, Options& moos) {
  options.publishes({"{name}.{autopilot}.cmd", "{name}.{drive}.cmd", "{name}.{modem}.cmd"});
  options.subscribes({"{name}.{gps}", "{name}.{ahrs}", "{name}.{compass}", "{name}.{pressure}", "{name}.{altimeter}",
                      "{name}.{dvl}", "{name}.{lidar}", "{name}.{odometry}", "{name}.{modem}", "{estimate}"});
  autonomy::add_name(options, moos.vehicle.name, "vehicle of the community").required();
  options.text("moos", "FILE", moos.moos,
               "mission file with ServerHost, ServerPort, LatOrigin, LongOrigin and MOOSTimeWarp: below the working "
               "folder, else below the shipped worlds");
  options.integer("port", moos.port, 1, 65535, "port of the MOOSDB, instead of that of the file");
  options.text("client", "NAME", moos.client, "name of the client in the community");
  options.choice("control", moos.control, {"helm", "actuators", "none"},
                 "what the community sets: DESIRED_HEADING, SPEED, DEPTH; DESIRED_RUDDER, THRUST, ELEVATOR; nothing");
  moos.vehicle.declare(options);
  options.text("drive", "DEVICE", moos.drive, "device that takes thrust, rudder and elevator");
  options.text("lidar", "DEVICE", moos.lidar, "device of LASERRANGE");
  options.text("odometry", "DEVICE", moos.odometry, "device of ODOMETRY");
  options.text("modem", "DEVICE", moos.modem, "modem of the messages");
  options.flag("no_node_report", moos.no_node_report, "posts no NODE_REPORT_LOCAL, which pNodeReporter makes as well");
  options.text("type", "TYPE", moos.node.type, "type of the vehicle in node reports");
  options.number("length_m", moos.node.length_m, 0.1, 1000, "length of the vehicle in node reports");
  options.flag("lockstep", moos.participation.in_lockstep, "joins the lockstep: the run waits at each tick");
  options.text("answer", "VARIABLE", moos.answer,
               "in lockstep, each tick waits until the community has posted SHOAL_TIME in this variable");
  options.number("answer_timeout_s", moos.answer_timeout_s, 0.1, 3600, "wall seconds to wait for the answer");
  moos.participation.declare(options);
}

int run(int argc, char** argv) {
  Options moos;
  moos.participation.in_lockstep = false;
  CLI::App app{"Connects a vehicle of a run with a MOOS community, as a client of its MOOSDB.", "shoal-moos"};
  command_line::DeclaredOptions options(app);
  declare(options, moos);
  // Not for worlds: only the command line may name another machine.
  app.add_option("--peer", moos.peer, "host of a MOOSDB on another machine")->type_name("HOST");
  autonomy::set_help_end(options, {"shoal-moos --name alpha --moos moos_alpha.moos"},
                         "docs/guides/attach_moos.md lists the variables with their channels and units.");
  if (const auto exit_code = options.parse(argc, argv)) return *exit_code;
  moos.node.name = moos.vehicle.name;
  const bridges::MoosFile file = moos.moos.empty() ? bridges::MoosFile{} : bridges::read_moos_file(moos.moos);
  return Bridge(moos, file, bridges::moos_host(file, moos.peer)).run();
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-moos", [&] { return run(argc, argv); });
}
