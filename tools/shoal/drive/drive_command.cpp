// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>

#include "bridges/lcm/lcm_listener.hpp"
#include "experiment/drive/drive_profile.hpp"
#include "experiment/drive/driver.hpp"
#include "experiment/drive/gamepad_device.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/terminal/key_events.hpp"
#include "experiment/terminal/terminal_keys.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_state_t.hpp"
#include "shoal/sim_vehicle_t.hpp"
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/control/control_session.hpp"

namespace tools {

namespace {

using namespace std::chrono_literals;
using Clock = experiment::Driver::Clock;

struct DriveArguments {
  std::string vehicle;
  std::string kind;
  std::string profile;
  std::string gamepad;
  std::string events;
  bool print_profile = false;
  std::string lcm_url;
  std::string run;
  double timeout_s = 5;
};

/// Source of the positions of the controls.
class Controls {
 public:
  virtual ~Controls() = default;
  /// Reads what has arrived; returns false at the end of the source.
  virtual bool read(Clock::time_point now) = 0;
  /// Returns whether the driver gives a sign of life now.
  virtual bool holds() = 0;
  virtual experiment::DriveValues values() const = 0;
  /// Returns, once, whether the next joint is to be selected.
  virtual bool take_next_joint() = 0;
};

/// Keys of the terminal.  A terminal reports no release of a key, only its repetitions: each byte is a sign of life.
class KeyControls final : public Controls {
 public:
  explicit KeyControls(const experiment::DriveProfile& profile) : keys_(profile.keys) {}
  bool read(Clock::time_point) override {
    while (const auto byte = terminal_.next()) {
      if (*byte == 4) return false;  // Ctrl-D
      const auto event = events_.next(*byte);
      if (!event || (event->ctrl && event->key.size() == 1)) continue;  // Ctrl and a letter
      const experiment::DriveKeys::Effect effect = keys_.press(event->key);
      holds_ = holds_ || effect == experiment::DriveKeys::Effect::sign_of_life;
      next_joint_ = next_joint_ || effect == experiment::DriveKeys::Effect::next_joint;
    }
    return isatty(STDIN_FILENO) != 0;
  }
  bool holds() override { return std::exchange(holds_, false); }
  experiment::DriveValues values() const override { return keys_.values(); }
  bool take_next_joint() override {
    if (next_joint_) keys_.centre();
    return std::exchange(next_joint_, false);
  }

 private:
  experiment::TerminalKeys terminal_;
  experiment::KeyEvents events_;
  experiment::DriveKeys keys_;
  bool holds_ = false, next_joint_ = false;
};

/// Gamepad, or a file of its events.
class PadControls final : public Controls {
 public:
  PadControls(const DriveArguments& arguments, const experiment::DriveProfile& profile) : gamepad_(profile.gamepad) {
    if (arguments.events.empty())
      device_.emplace(arguments.gamepad, profile.gamepad, gamepad_);
    else
      events_ = experiment::read_input_events(arguments.events);
  }
  bool read(Clock::time_point now) override {
    if (device_) {
      if (device_->read()) return true;
      throw experiment::DriveError("the gamepad was disconnected");
    }
    // Events of a file, at their recorded times.
    if (!start_) start_ = now;
    const auto played_us = std::chrono::duration_cast<std::chrono::microseconds>(now - *start_).count();
    for (; next_ < events_.size() && events_[next_].time_us - events_.front().time_us <= played_us; ++next_)
      gamepad_.take(events_[next_]);
    return next_ < events_.size();
  }
  bool holds() override { return gamepad_.holds(); }
  experiment::DriveValues values() const override { return gamepad_.values(); }
  bool take_next_joint() override { return gamepad_.take_next_joint(); }

 private:
  experiment::Gamepad gamepad_;
  std::optional<experiment::GamepadDevice> device_;
  std::vector<experiment::InputEvent> events_;
  std::size_t next_ = 0;
  std::optional<Clock::time_point> start_;
};

/// A vehicle of a run elsewhere: its devices, its pose, and its commands.  Commands go to the bus of the vehicle, all
/// else is on that of the world.
class RemoteVehicle {
 public:
  explicit RemoteVehicle(const DriveArguments& arguments) : name_(arguments.vehicle), lcm_(arguments.lcm_url) {
    lcm_.listen("sim.vehicle");
    lcm_.listen("sim.state");
  }
  /// Takes the messages that have arrived.
  void take() {
    while (const auto message = lcm_.next(0ms)) {
      try {
        if (message->channel == "sim.vehicle")
          take_vehicle(shoal::decode<shoal::sim_vehicle_t>(message->payload, shoal::Finite::any));
        else
          take_state(shoal::decode<shoal::sim_state_t>(message->payload, shoal::Finite::required));
      } catch (const shoal::MessageError& error) {
        sim::log_debug("{}: {}", message->channel, error.what());
      }
    }
  }
  /// Sets the LCM URL of the vehicle's bus; empty: the world's.  Throws BusError.
  void set_bus(const std::string& url) {
    own_bus_.reset();
    if (!url.empty() && url != lcm_.url()) own_bus_.emplace(url);
  }
  const std::optional<experiment::DrivenVehicle>& description() const { return description_; }
  bool removed() const { return removed_; }
  const std::optional<experiment::DrivePose>& pose() const { return pose_; }
  std::int64_t utime() const { return utime_; }
  void publish(const std::vector<experiment::DriveCommand>& commands) {
    bridges::LcmListener& bus = own_bus_ ? *own_bus_ : lcm_;
    for (const experiment::DriveCommand& command : commands) bus.publish(command.channel, command.payload);
  }

 private:
  void take_vehicle(const shoal::sim_vehicle_t& message) {
    if (message.vehicle != name_) return;
    removed_ = !message.present;
    if (message.present) description_ = experiment::driven_vehicle(message);
  }
  void take_state(const shoal::sim_state_t& message) {
    utime_ = message.utime;
    for (std::size_t i = 0; i < message.vehicle.size(); ++i) {
      if (message.vehicle[i] != name_) continue;
      const auto& q = message.orientation[i];
      const double yaw_rad = std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
      pose_ =
          experiment::DrivePose{yaw_rad, -message.position_m[i][2]};  // the message does not have the level of the tide
    }
  }

  const std::string name_;
  bridges::LcmListener lcm_;
  std::optional<bridges::LcmListener> own_bus_;
  std::optional<experiment::DrivenVehicle> description_;
  bool removed_ = false;
  std::optional<experiment::DrivePose> pose_;
  std::int64_t utime_ = 0;
};

/// Asks the run for the bus and the devices of the vehicle.  Returns the exit code of a failure.
std::optional<int> find_vehicle(const DriveArguments& arguments, RemoteVehicle& vehicle) {
  ControlSession session(
      {"shoal-drive-" + std::to_string(getpid()), arguments.lcm_url, arguments.run, arguments.timeout_s});
  for (const char* request : {"bus", "describe"}) {
    const auto reply = session.send_request(request, arguments.vehicle, 0);
    if (!reply) {
      std::cerr << "shoal drive: " << session.no_answer() << '\n';
      return exit_timeout;
    }
    if (!reply->ok) {
      std::cerr << "shoal drive: " << reply->text << '\n';
      return exit_failed;
    }
    if (std::string_view(request) == "bus") vehicle.set_bus(reply->text);
  }
  // The description of the vehicle comes on another channel.
  for (const auto deadline = Clock::now() + 5s;
       !vehicle.description() && Clock::now() < deadline && experiment::caught_signal() == 0;) {
    vehicle.take();
    std::this_thread::sleep_for(5ms);
  }
  if (vehicle.description()) return std::nullopt;
  std::cerr << "shoal drive: no description of '" << arguments.vehicle << "' arrived on 'sim.vehicle'\n";
  return exit_timeout;
}

/// Returns the positions of the axes that the vehicle has; of kind joints the axis forward moves the selected joint.
experiment::DriveValues values_for(const experiment::DriveMapping& mapping, const experiment::DriveValues& controls,
                                   std::size_t joint) {
  experiment::DriveValues values;
  for (const std::string& axis : mapping.axes()) {
    const auto found = controls.find(axis);
    values[axis] = found == controls.end() ? 0 : found->second;
  }
  if (mapping.kind() != experiment::DriveKind::joints) return values;
  const auto forward = controls.find("forward");
  if (forward != controls.end()) values[mapping.axes()[joint]] = forward->second;
  return values;
}

/// Line that shows what the vehicle is commanded, on a terminal.
class StatusLine {
 public:
  void show(const std::string& vehicle, const experiment::DriveValues& values, const std::string& joint, bool moves) {
    if (isatty(STDERR_FILENO) == 0) return;
    std::string line = vehicle + ":";
    for (const auto& [axis, value] : values)
      if (joint.empty() || axis == joint) line += fmt::format("  {} {:+.2f}", axis, value);
    line += moves ? "  moves" : "  stopped";
    if (line == shown_) return;
    shown_ = line;
    std::cerr << "\r\x1b[K" << line << std::flush;
  }
  ~StatusLine() {
    if (!shown_.empty()) std::cerr << '\n';
  }

 private:
  std::string shown_;
};

/// Drives until the source ends, the vehicle is removed or a signal comes; then sends the safe command.
int drive_on(const DriveArguments& arguments, RemoteVehicle& vehicle, experiment::Driver& driver, Controls& controls) {
  constexpr auto tick = 5ms;
  int exit_code = exit_ok;
  std::size_t joint = 0;
  StatusLine status;
  const bool has_joints = driver.mapping().kind() == experiment::DriveKind::joints;
  try {
    while (experiment::caught_signal() == 0 && !vehicle.removed()) {
      const Clock::time_point now = Clock::now();
      const bool goes_on = controls.read(now);
      vehicle.take();
      if (controls.take_next_joint() && has_joints) joint = (joint + 1) % driver.mapping().axes().size();
      const experiment::DriveValues values = values_for(driver.mapping(), controls.values(), joint);
      if (controls.holds())
        driver.hold(values, now);
      else if (!arguments.gamepad.empty() || !arguments.events.empty())
        driver.release();
      vehicle.publish(driver.due(now, vehicle.utime(), vehicle.pose()));
      status.show(arguments.vehicle, values, has_joints ? driver.mapping().axes()[joint] : "", driver.held());
      if (!goes_on) break;
      std::this_thread::sleep_for(tick);
    }
    if (vehicle.removed()) sim::log_info("vehicle '{}' was removed", arguments.vehicle);
  } catch (const experiment::DriveError& error) {
    std::cerr << "shoal drive: " << error.what() << '\n';
    exit_code = exit_bus;
  }
  // The last command is a safe one.
  for (int i = 0; i < experiment::Driver::safe_commands; ++i) {
    vehicle.publish(driver.safe(vehicle.utime(), vehicle.pose()));
    std::this_thread::sleep_for(20ms);
  }
  return exit_code;
}

int drive(const DriveArguments& arguments) {
  if (arguments.print_profile) {
    std::cout << experiment::default_drive_profile();
    return exit_ok;
  }
  if (arguments.vehicle.empty())
    throw command_line::UsageError("needs the NAME of a vehicle; see `shoal drive --help`");
  const experiment::DriveProfile profile = experiment::read_drive_profile(arguments.profile);
  const bool by_keys = arguments.gamepad.empty() && arguments.events.empty();
  if (by_keys && !experiment::TerminalKeys::possible())
    throw command_line::UsageError("needs a terminal, or --gamepad or --events");
  experiment::catch_signals(false);
  try {
    // Open the gamepad first: it fails at once.
    std::unique_ptr<Controls> controls;
    if (!by_keys) controls = std::make_unique<PadControls>(arguments, profile);
    RemoteVehicle vehicle(arguments);
    if (const auto failed = find_vehicle(arguments, vehicle)) return *failed;
    std::optional<experiment::DriveKind> kind;
    if (!arguments.kind.empty()) kind = sim::value_of(experiment::drive_kind_words, arguments.kind);
    experiment::Driver driver(profile, *vehicle.description(), kind);
    if (by_keys) {
      std::cerr << fmt::format("hold '{}' to move, '{}' centers, Ctrl-C ends\n", profile.keys.hold,
                               profile.keys.centre);
      controls = std::make_unique<KeyControls>(profile);
    }
    return drive_on(arguments, vehicle, driver, *controls);
  } catch (const experiment::DriveError& error) {
    std::cerr << "shoal drive: " << error.what() << '\n';
    return exit_usage;
  }
}

}  // namespace

static void add_drive_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("drive");
  const auto arguments = std::make_shared<DriveArguments>();
  add_log_level_option(*command);
  command->add_option("NAME", arguments->vehicle, "vehicle to drive");
  command->add_option("--kind", arguments->kind, "what to command; default: what the devices of the vehicle support")
      ->type_name("KIND")
      ->check(one_of({"twist", "tilt", "helm", "thrust", "camera", "joints"}));
  // Controls.
  command->add_option("--profile", arguments->profile, "file with keys, axes, limits and rates")->type_name("FILE");
  command->add_flag("--print-profile", arguments->print_profile, "print the built-in profile, as a start for your own");
  CLI::Option* gamepad =
      command->add_option("--gamepad", arguments->gamepad, "gamepad instead of keys: /dev/input/eventX")
          ->type_name("DEVICE");
  command->add_option("--events", arguments->events, "play a file of gamepad events at their recorded times")
      ->type_name("FILE")
      ->excludes(gamepad);
  // Connection.
  command
      ->add_option("--run", arguments->run,
                   "folder of the run, with its key in run.key; default: the key in SHOAL_RUN_KEY, if set")
      ->type_name("DIR");
  command->add_option("--timeout", arguments->timeout_s, "wall seconds to wait for the simulator")
      ->type_name("S")
      ->check(number_from(0.01, 1e6))
      ->capture_default_str();
  add_lcm_url_option(*command, arguments->lcm_url);
  // End of the help and action.
  command_line::set_help_end(
      *command,
      {{"shoal drive rover1  # arrow keys or WASD, while the space bar is held", "shoal drive segway1 --kind tilt",
        "shoal drive auv1 --kind thrust --gamepad /dev/input/event5", "shoal drive --print-profile > my_pad.yaml",
        "shoal drive rover1 --profile my_pad.yaml --run results/dive1", "shoal drive rover1 --events lap.events"},
       {{0, "ended by Ctrl-C or the end of the events; the vehicle got its safe command"},
        {1, "the simulator refused; the reason is on stderr"},
        {2, "wrong usage, an error of the profile, or a vehicle that cannot be driven that way"},
        {4, "bus error, or the gamepad was disconnected; the vehicle got its safe command"},
        {5, "no simulator answered in time"}},
       {}});
  command->callback([arguments, &exit_code] { exit_code = drive(*arguments); });
}

SHOAL_COMMAND(connect, "drive", "Drive a vehicle of a running simulator by hand", add_drive_command);

}  // namespace tools
