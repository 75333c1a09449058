// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <numbers>
#include <thread>

#include "devices/motion/joint_group.hpp"
#include "devices/motion/servo_bank.hpp"
#include "sim/config/message_text.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tools/command_line/name_list.hpp"
#include "tools/command_line/text_layout.hpp"
#include "tools/experiment/drive/drive_error.hpp"
#include "tools/experiment/motion/motion_file.hpp"
#include "tools/experiment/motion/motion_tracking.hpp"
#include "tools/experiment/motion_record/embedded_world.hpp"
#include "tools/experiment/motion_record/motion_recorder.hpp"
#include "tools/experiment/motion_record/record_input.hpp"
#include "tools/experiment/motion_record/record_view.hpp"
#include "tools/experiment/motion_record/recorded_motion.hpp"
#include "tools/experiment/process/signals.hpp"
#include "tools/experiment/world_files/world_by_name.hpp"
#include "tools/shoal/motion/motion_commands.hpp"
#include "tools/shoal/motion/motion_output.hpp"
#include "tools/shoal/motion/vehicle_joints.hpp"
#include "tools/shoal/options/view_options.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double back_s = 1;                              // of one press of the key
constexpr std::chrono::milliseconds time_to_answer{500};  // of a terminal that has the Kitty keyboard protocol

struct RecordArguments {
  std::string file, events;
  std::string operation;  ///< in the words of the command line
  std::vector<std::string> devices, overdub, actions;
  std::optional<double> rate, from_s, to_s, duration_s;
  bool overwrite = false, recover = false, with_page = false, embed = false;
  ViewOptions view;
  StageOptions stage;
};

/// Keys of actions of the world.
struct BoundAction {
  std::string key;
  sim::ConfigNode action;
};

/// Parses `KEY=ACTION`; what the action names is looked up when it is executed.
BoundAction action_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw command_line::UsageError("--on must be KEY=ACTION, got '" + sim::shortened(sim::printable(text)) + "'");
  const std::string key = text.substr(0, equals);
  if (!is_key_name(key))
    throw command_line::UsageError("--on: '" + sim::shortened(sim::printable(key)) +
                                   "' is not a key; known: a character, " + key_words);
  sim::Diagnostics diagnostics;
  sim::ConfigNode action = sim::parse_config_text(text.substr(equals + 1), "--on " + key, diagnostics);
  diagnostics.throw_if_any();
  const sim::ActionRegistry& known = sim::ActionRegistry::instance();
  if (action.kind != sim::ConfigNode::Kind::map || action.entries.size() != 1)
    throw command_line::UsageError("--on: the action of key '" + key + "' must be a map of one action, such as " +
                                   "{remove: NAME}, got '" + sim::shortened(sim::printable(text.substr(equals + 1))) +
                                   "'");
  const std::string& word = action.entries.front().key;
  if (known.find(word) == nullptr)
    throw command_line::UsageError("--on: key '" + key + "': unknown action '" + sim::shortened(sim::printable(word)) +
                                   "'" + sim::did_you_mean(word, known.words()) +
                                   "; known: " + sim::list_text(known.words()));
  return {key, std::move(action)};
}

std::vector<BoundAction> actions_of(const std::vector<std::string>& texts) {
  std::vector<BoundAction> actions;
  for (const std::string& text : texts) {
    BoundAction action = action_of(text);
    for (const BoundAction& other : actions)
      if (other.key == action.key) throw command_line::UsageError("--on: key '" + action.key + "' has two actions");
    actions.push_back(std::move(action));
  }
  return actions;
}

/// Throws UsageError when the recording would replace files that are not its own: those of an earlier recording of the
/// motion over which it records are.
void check_files(const RecordArguments& arguments, bool is_over) {
  if (arguments.overwrite) return;
  const std::string take = take_path(arguments.file);
  if (!is_over && fs::exists(arguments.file))
    throw command_line::UsageError("'" + arguments.file +
                                   "' exists: record over it with --overdub or --punch-in, or replace it with "
                                   "--overwrite");
  const auto is_recording = [&] {
    try {
      return sim::load_motion(take).recorded.has_value();
    } catch (const sim::ConfigError&) {
      return false;
    }
  };
  if (fs::exists(take) && (!is_over || !is_recording()))
    throw command_line::UsageError("'" + take + "' exists" + (is_over ? " and is not a recording" : "") +
                                   "; --overwrite replaces it");
  for (const std::string& file : {arguments.file, take}) check_frames(file, false);
}

/// Throws ConfigError when a journal names joints that its vehicle, if that is known, does not have.
void check_joints(const TakeSettings& settings, const std::string& file) {
  const std::string vehicle_file = vehicle_file_of(settings.model, file);
  if (vehicle_file.empty()) return;
  const sim::VehicleConfig vehicle = sim::load_vehicle(vehicle_file);
  const std::vector<devices::ServoOfVehicle> servos = devices::servos_of(vehicle);
  std::vector<std::string> known;
  for (const devices::ServoOfVehicle& servo : servos) known.push_back(servo.device);
  for (const std::string& joint : settings.joints)
    if (std::none_of(servos.begin(), servos.end(), [&](const auto& servo) { return servo.is_called(joint); }))
      throw sim::ConfigError({journal_path(file) + ":2: joint '" + sim::shortened(sim::printable(joint)) +
                              "' is not a servo of vehicle '" + settings.model + "'" + sim::did_you_mean(joint, known) +
                              "; known: " + sim::list_text(known)});
}

/// Saves a recording that its program could not end.  Returns whether there was one.
bool recover(const std::string& file) {
  const std::optional<RecoveredTake> recovered = read_journal(file);
  if (!recovered) return false;
  check_joints(recovered->take.settings, file);
  const SavedTake saved = save_take(file, *recovered, "", "record --recover");
  const double end_s = static_cast<double>(recovered->take.frame_count() - 1) * recovered->take.settings.frame_s;
  std::cerr << fmt::format("{}: recovered a recording of {:.3f} s\n", file, end_s);
  if (recovered->damage)
    std::cerr << fmt::format("{}; this line and all after it, {} in all, are dropped; the journal is kept as {}\n",
                             recovered->damage->error, recovered->damage->lines, saved.damaged_journal);
  return true;
}

/// Line on a terminal: time, what happens, joints that move.
class RecordLine {
 public:
  /// `file`: name of the motion file.
  RecordLine(bool is_shown, bool shows_set, std::string file)
      : is_shown_(is_shown && isatty(STDERR_FILENO) != 0), shows_set_(shows_set), file_(std::move(file)) {}
  ~RecordLine() { end(); }
  void show(MotionRecorder& recorder, const JointCommands& commands, const std::vector<double>& velocities,
            bool is_paused) {
    if (!is_shown_ || Clock::now() < next_) return;
    next_ = Clock::now() + std::chrono::milliseconds(100);
    std::string line = fmt::format("{:8.2f} s  {}", recorder.now_s(),
                                   is_paused                 ? "paused   "
                                   : recorder.is_recording() ? "recording"
                                                             : "playing  ");
    if (recorder.over_end_s() && recorder.now_s() > *recorder.over_end_s() + recorder.frame_s() / 2)
      line += fmt::format("  past the end of {}: {:.1f} s", file_, *recorder.over_end_s());
    if (commands.speed() != 1) line += fmt::format("  speed {:.2f}", commands.speed());
    if (shows_set_ && !commands.set().empty()) line += "  set " + commands.set();
    const std::vector<std::string>& sliders = recorder.settings().sliders;
    for (std::size_t i = 0; i < velocities.size(); ++i) {
      if (velocities[i] == 0) continue;
      const std::string& joint = recorder.joints()[i];
      const bool is_slider = std::find(sliders.begin(), sliders.end(), joint) != sliders.end();
      const double value = recorder.set_points()[i];
      line += is_slider ? fmt::format("  {} {:+.3f} m", joint, value)
                        : fmt::format("  {} {:+.1f}", joint, value * 180 / std::numbers::pi);
      if (recorder.is_at_limit(i)) line += " limit";
    }
    if (tilt_rad(recorder.stage().vehicle()) > fallen_rad) line += "  fallen";
    std::cerr << "\r\x1b[K" << command_line::cut_to(line, 100) << std::flush;
    has_line_ = true;
  }
  void end() {
    if (has_line_) std::cerr << '\n';
    has_line_ = false;
  }

 private:
  bool is_shown_, shows_set_, has_line_ = false;
  std::string file_;
  Clock::time_point next_{};
};

/// A recording that lasts.
class Session {
 public:
  Session(const RecordArguments& arguments, MotionRecorder& recorder, std::vector<BoundAction> actions)
      : arguments_(arguments),
        recorder_(recorder),
        actions_(std::move(actions)),
        commands_(
            recorder.controls(), recorder.joints(), [&](const std::string& joint) { return recorder.find(joint); },
            keys_of(actions_)) {
    for (const BoundAction& one : actions_)
      if (commands_.uses(one.key)) throw command_line::UsageError("--on: key '" + one.key + "' has another effect");
    if (!arguments.events.empty()) inputs_.push_back(std::make_unique<EventFileInput>(arguments.events));
    for (const std::string& device : arguments.devices)
      inputs_.push_back(std::make_unique<DeviceInput>(device, commands_));
    if (arguments.events.empty() && TerminalKeys::possible()) {
      auto terminal = std::make_unique<TerminalInput>(!arguments.devices.empty());
      if (arguments.devices.empty()) terminal_ = terminal.get();
      inputs_.push_back(std::move(terminal));
    }
    if (inputs_.empty()) throw command_line::UsageError("needs a terminal, or --input or --events");
    if (!arguments.with_page) return;
    view_.emplace(arguments.view, recorder.stage());
    std::cerr << "live page: " << view_->url() << '\n';
  }

  /// Records until an input ends it; returns the exit code.
  int run() {
    if (arguments_.events.empty())
      std::cerr << commands_.help()
                << "  space pauses, backspace goes back 1 s, tab stops all, - and = set the speed, enter ends\n";
    const double period_s = recorder_.frame_s() / arguments_.rate.value_or(1);
    RecordLine line(arguments_.events.empty(), !arguments_.devices.empty(),
                    fs::path(arguments_.file).filename().string());
    mode_until_ = Clock::now() + time_to_answer;
    for (std::int64_t tick = 0; caught_signal() == 0 && !is_over(); ++tick) {
      bool goes_on = true;
      try {
        const auto until_us = static_cast<std::int64_t>(std::llround(static_cast<double>(tick) * period_s * 1e6));
        for (const auto& input : inputs_) goes_on = input->read(until_us, commands_) && goes_on;
      } catch (const DriveError& error) {
        line.end();
        std::cerr << "shoal motion record: " << error.what() << "; what was recorded is saved\n";
        return exit_bus;
      }
      show_mode(line);
      carry_out(line);
      const std::vector<double> velocities = commands_.velocities();
      if (!is_paused_) recorder_.frame(velocities);
      if (view_) view_->serve(is_paused_);
      line.show(recorder_, commands_, velocities, is_paused_);
      if (!goes_on || is_finished_) break;
      if (arguments_.events.empty()) wait(period_s);
    }
    return exit_ok;
  }

 private:
  static std::vector<std::string> keys_of(const std::vector<BoundAction>& actions) {
    std::vector<std::string> keys;
    for (const BoundAction& one : actions) keys.push_back(one.key);
    return keys;
  }

  bool is_over() const {
    if (arguments_.duration_s && recorder_.now_s() >= *arguments_.duration_s - recorder_.frame_s() * 1.5) return true;
    return recorder_.is_full();
  }

  /// Says once, when the terminal has answered or cannot, how its keys move joints.
  void show_mode(RecordLine& line) {
    if (terminal_ == nullptr || (!terminal_->reports_releases() && Clock::now() < mode_until_)) return;
    line.end();
    std::cerr << (terminal_->reports_releases()
                      ? "hold the keys: a joint moves while its key is held\n"
                      : "a key starts its joint, the same key stops it: this terminal reports no releases\n");
    terminal_ = nullptr;
  }

  void carry_out(RecordLine& line) {
    for (const RecordWish wish : commands_.take_wishes()) switch (wish) {
        case RecordWish::pause:
          is_paused_ = !is_paused_;
          break;
        case RecordWish::finish:
          is_finished_ = true;
          break;
        case RecordWish::back:
          recorder_.back(back_s);
          if (view_) view_->went_back();
          commands_.release_all();
          is_paused_ = arguments_.events.empty();
          break;
      }
    for (const std::size_t number : commands_.take_actions()) {
      try {
        recorder_.change(actions_[number].action);
      } catch (const std::runtime_error& error) {
        line.end();
        std::cerr << "shoal motion record: key '" << actions_[number].key << "': " << error.what() << '\n';
      }
    }
  }

  /// Waits for the next frame.  When the machine is too slow, the recording is slower than the clock.
  void wait(double period_s) {
    const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_s));
    const Clock::time_point now = Clock::now();
    next_ = next_ + period < now - std::chrono::milliseconds(100) ? now : next_ + period;
    std::this_thread::sleep_until(next_);
  }

  const RecordArguments& arguments_;
  MotionRecorder& recorder_;
  std::vector<BoundAction> actions_;
  JointCommands commands_;
  std::vector<std::unique_ptr<RecordInput>> inputs_;
  const TerminalInput* terminal_ = nullptr;  ///< whose mode is not shown yet
  Clock::time_point mode_until_{};
  std::optional<RecordView> view_;
  bool is_paused_ = false, is_finished_ = false;
  Clock::time_point next_{};
};

RecordOptions options_of(const RecordArguments& arguments) {
  RecordOptions options;
  options.stage = arguments.stage;
  options.stage.world = file_by_name({ShippedKind::world}, arguments.stage.world);
  options.name = motion_name_of(arguments.file);
  options.joints = arguments.overdub;
  options.from_s = arguments.from_s;
  options.to_s = arguments.to_s;
  const bool is_over = !arguments.overdub.empty() || arguments.from_s || arguments.to_s;
  if (is_over) options.over = motion_of(arguments.file);
  check_files(arguments, is_over);
  return options;
}

int record(const RecordArguments& arguments) {
  try {
    const bool was_recovered = recover(arguments.file);
    if (arguments.recover) {
      if (!was_recovered) std::cerr << "shoal: there is nothing to recover for '" << arguments.file << "'\n";
      return was_recovered ? exit_ok : exit_bus;
    }
    if (arguments.stage.world.empty()) throw command_line::UsageError("needs --world");
    const RecordOptions options = options_of(arguments);
    const std::vector<BoundAction> actions = actions_of(arguments.actions);
    catch_signals(false);
    int exit_code = exit_ok;
    std::string hash;
    sim::ConfigNode embedded;
    {
      MotionRecorder recorder(options, journal_path(arguments.file));
      try {
        if (arguments.embed) embedded = embeddable_world(recorder.stage().resolved_world(), recorder.settings().world);
        Session session(arguments, recorder, actions);
        exit_code = session.run();
      } catch (...) {
        // Nothing was recorded when there is no input.
        if (recorder.now_s() <= recorder.frame_s()) fs::remove(journal_path(arguments.file));
        throw;
      }
      hash = fmt::format("{:016x}", recorder.finish());
    }
    const bool loops = options.over && options.over->loop;
    const std::optional<RecoveredTake> recorded = read_journal(arguments.file);
    if (!recorded) throw std::runtime_error("'" + journal_path(arguments.file) + "' is gone");
    const sim::JointMotion motion = save_take(arguments.file, *recorded, loops ? "" : hash, arguments.operation).motion;
    if (arguments.embed) embed_world(take_path(arguments.file), embedded);
    std::cout << fmt::format("{}: {:.3f} s, {} joints, {} keys; each frame is in {}\nstate hash at the end {}\n",
                             arguments.file, motion.end_s(), motion.tracks().size(), motion.keys.size(),
                             take_path(arguments.file), hash);
    return exit_code;
  } catch (const sim::ConfigError&) {
    throw;
  } catch (const command_line::UsageError&) {
    throw;
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

}  // namespace

void add_motion_record_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("record", "Record a motion with keys or a gamepad");
  const auto arguments = std::make_shared<RecordArguments>();
  add_log_level_option(*command, "warn");
  command->add_option("FILE", arguments->file, "motion file")->required();
  command->add_option("--world", arguments->stage.world, "world with a vehicle that has a motion_player")
      ->type_name("WORLD");
  command->add_option("--vehicle", arguments->stage.vehicle, "its name; needed when several have one")
      ->type_name("NAME");
  // Inputs.
  CLI::Option* input =
      command
          ->add_option("--input", arguments->devices,
                       "keyboard or gamepad in place of the terminal: /dev/input/eventX; may be repeated")
          ->type_name("DEVICE")
          ->type_size(1)
          ->allow_extra_args(false);
  command->add_option("--events", arguments->events, "record what a file of the events of a device does, at full speed")
      ->type_name("FILE")
      ->excludes(input);
  command->add_option("--on", arguments->actions, "key that executes an action of the world; may be repeated")
      ->type_name("KEY=ACTION")
      ->type_size(1)
      ->allow_extra_args(false);
  command
      ->add_option("--rate", arguments->rate,
                   "simulated seconds in a second of the clock; below 1: slow motion; usual 1")
      ->type_name("R")
      ->check(number_from(0.01, 10));
  // What is recorded.
  command_line::add_name_list(*command, "--overdub", arguments->overdub,
                              "joints that are recorded while the others play the file; comma separated")
      ->type_name("JOINTS");
  command->add_option("--punch-in", arguments->from_s, "start of the part of the file that is recorded, s")
      ->type_name("S")
      ->check(number_from(0, sim::max_motion_s));
  command
      ->add_option("--punch-out", arguments->to_s,
                   "end of this part, s; until then the joints return to the values of the file")
      ->type_name("S")
      ->check(number_from(0, sim::max_motion_s));
  command->add_option("--duration", arguments->duration_s, "end after this time of the motion, s")
      ->type_name("S")
      ->check(number_from(0.01, sim::max_motion_s));
  command->add_flag("--overwrite", arguments->overwrite,
                    "replace existing files; `shoal motion edit undo` brings FILE back");
  CLI::Option* embed = command->add_flag("--embed", arguments->embed,
                                         "keep the world in FILE_take.yaml, so that it can be played without the file");
  command->add_flag("--recover", arguments->recover, "only save a recording that was cut off")->excludes(embed);
  CLI::Option* page = command->add_flag("--view", arguments->with_page,
                                        "serve a live page of the recording in 3-D, and print its address");
  command->add_option("--view-port", arguments->view.port, "port of the live page; the next free one if it is taken")
      ->type_name("PORT")
      ->check(whole_from(0, 65535))
      ->needs(page);
  add_set_option(*command, arguments->stage.load.sets);
  add_allow_path_option(*command, arguments->stage.load);
  command_line::set_help_end(
      *command,
      {{"shoal motion record wave.yaml --world ers7_studio --view",
        "shoal motion record wave.yaml --world ers7_studio --input /dev/input/event5 --rate 0.25",
        "shoal motion record wave.yaml --world ers7_studio --overdub head_pan,head_nod",
        "shoal motion record wave.yaml --world ers7_studio --punch-in 2 --punch-out 3.5",
        "shoal motion record push.yaml --world ers7_field --on '[={remove: crate}'",
        "shoal motion edit undo wave.yaml"},
       {{0, "recorded, or ended by a signal; the file is written"},
        {2, "wrong usage or configuration"},
        {4, "a file cannot be written, or a device is gone; what was recorded is saved"}},
       {"FILE gets keys within 0.25 degrees, FILE_take.yaml each frame: played in the same world, it ends in the "
        "same state.  While it records, FILE.journal holds each frame: when the program is killed, the next "
        "recording of FILE, or --recover, saves it.  Keys and sticks: 'controls' of the joint_group of the "
        "vehicle.  KEY of --on is a character of the keyboard, or up, down, left, right, escape."}});
  command->callback([arguments, command, &exit_code] {
    arguments->operation = operation_of(*command);
    exit_code = record(*arguments);
  });
}

}  // namespace tools
