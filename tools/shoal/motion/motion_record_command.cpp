// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include "devices/motion/servo_bank.hpp"
#include "experiment/process/browser.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "motion/analysis/motion_file.hpp"
#include "motion/record/embedded_world.hpp"
#include "motion/record/recorded_motion.hpp"
#include "sim/config/message_text.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/shoal/motion/format_options.hpp"
#include "tools/shoal/motion/motion_commands.hpp"
#include "tools/shoal/motion/motion_output.hpp"
#include "tools/shoal/motion/record_session.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

/// Parses `KEY=ACTION`; what the action names is looked up when it is executed.
BoundAction action_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw command_line::UsageError("--on must be KEY=ACTION, got '" + sim::shortened(sim::printable(text)) + "'");
  const std::string key = text.substr(0, equals);
  if (!motion::is_key_name(key))
    throw command_line::UsageError("--on: '" + sim::shortened(sim::printable(key)) +
                                   "' is not a key; known: a character, " + motion::key_words);
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
  const std::string take = motion::take_path(arguments.file);
  if (!is_over && fs::exists(arguments.file))
    throw command_line::UsageError("'" + arguments.file +
                                   "' exists: record over it with --overdub or --punch-in, continue at its end with "
                                   "--append, or replace it with --overwrite");
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
void check_joints(const motion::TakeSettings& settings, const std::string& file) {
  const std::string vehicle_file = vehicle_file_of(settings.model, file);
  if (vehicle_file.empty()) return;
  const sim::VehicleConfig vehicle = sim::load_vehicle(vehicle_file);
  const std::vector<devices::ServoOfVehicle> servos = devices::servos_of(vehicle);
  std::vector<std::string> known;
  for (const devices::ServoOfVehicle& servo : servos) known.push_back(servo.device);
  for (const std::string& joint : settings.joints)
    if (std::none_of(servos.begin(), servos.end(), [&](const auto& servo) { return servo.is_called(joint); }))
      throw sim::ConfigError({motion::journal_path(file) + ":2: joint '" + sim::shortened(sim::printable(joint)) +
                              "' is not a servo of vehicle '" + settings.model + "'" + sim::did_you_mean(joint, known) +
                              "; known: " + sim::list_text(known)});
}

/// Saves a recording that its program could not end.  Returns whether there was one.
bool recover(const std::string& file) {
  const std::optional<motion::RecoveredTake> recovered = motion::read_journal(file);
  if (!recovered) return false;
  check_joints(recovered->take.settings, file);
  const motion::SavedTake saved = motion::save_take(file, *recovered, "", "record --recover");
  const double end_s = static_cast<double>(recovered->take.frame_count() - 1) * recovered->take.settings.frame_s;
  std::cerr << fmt::format("{}: recovered a recording of {:.3f} s\n", file, end_s);
  if (recovered->damage)
    std::cerr << fmt::format("{}; this line and all after it, {} in all, are dropped; the journal is kept as {}\n",
                             recovered->damage->error, recovered->damage->lines, saved.damaged_journal);
  return true;
}

/// Throws command_line::UsageError for times at which nothing would be recorded.
void check_times(const RecordArguments& arguments, const motion::RecordOptions& options) {
  if (!arguments.duration_s) return;
  const auto error = [&](const std::string& rule) {
    return command_line::UsageError("--duration must be " + rule + ", got " + sim::number_text(*arguments.duration_s));
  };
  if (options.from_s && *arguments.duration_s <= *options.from_s)
    throw error(fmt::format("above {:.9g} s, where the recording starts", *options.from_s));
  if (!options.over || *arguments.duration_s <= options.over->end_s()) return;
  if (options.to_s || options.over->loop)
    throw error(fmt::format("at most {:.9g} s, the end of ", options.over->end_s()) +
                (options.to_s ? "the motion, to which it is played after --punch-out" : "a motion that loops"));
}

motion::RecordOptions options_of(const RecordArguments& arguments) {
  motion::RecordOptions options;
  options.stage = arguments.stage;
  options.stage.world = experiment::file_by_name({experiment::ShippedKind::world}, arguments.stage.world);
  options.stage.scores = arguments.with_page;
  options.name = motion::motion_name_of(arguments.file);
  options.joints = arguments.overdub;
  options.from_s = arguments.from_s;
  options.to_s = arguments.to_s;
  const bool is_over = arguments.append || !arguments.overdub.empty() || arguments.from_s || arguments.to_s;
  if (is_over) options.over = motion_of(arguments.file);
  if (arguments.append) {
    const sim::JointMotion& over = *options.over;
    if (over.loop) throw command_line::UsageError("--append: '" + arguments.file + "' loops, and has no end");
    options.from_s = std::ceil(over.end_s() / over.frame_s - 1e-6) * over.frame_s;  // whole frames
  }
  check_times(arguments, options);
  check_files(arguments, is_over);
  return options;
}

int record(RecordArguments arguments) {
  experiment::Browser browser;
  if (arguments.open) arguments.view.opened = [&browser](const std::string& url) { browser.open(url); };
  try {
    const bool was_recovered = recover(arguments.file);
    if (arguments.recover) {
      if (!was_recovered) std::cerr << "shoal: there is nothing to recover for '" << arguments.file << "'\n";
      return was_recovered ? exit_ok : exit_bus;
    }
    if (arguments.stage.world.empty()) throw command_line::UsageError("needs --world");
    const motion::RecordOptions options = options_of(arguments);
    const std::vector<BoundAction> actions = actions_of(arguments.actions);
    experiment::catch_signals(false);
    int exit_code = exit_ok;
    std::string hash;
    std::optional<double> unused_s;  ///< time of the end when nothing was recorded
    sim::ConfigNode embedded;
    {
      motion::MotionRecorder recorder(options, motion::journal_path(arguments.file));
      try {
        if (arguments.embed)
          embedded = motion::embeddable_world(recorder.stage().resolved_world(), recorder.settings().world);
        RecordSession session(arguments, recorder, actions);
        exit_code = session.run();
      } catch (...) {
        // Nothing was recorded when there is no input.
        if (recorder.now_s() <= recorder.frame_s()) fs::remove(motion::journal_path(arguments.file));
        throw;
      }
      if (options.from_s && recorder.now_s() < *options.from_s)
        unused_s = recorder.now_s();
      else
        hash = fmt::format("{:016x}", recorder.finish());
    }
    if (unused_s) {
      fs::remove(motion::journal_path(arguments.file));
      std::cerr << fmt::format(
          "{}: ended at {:.3f} s, before {:.3f} s where the recording starts: nothing was recorded\n", arguments.file,
          *unused_s, *options.from_s);
      return exit_code == exit_ok ? exit_bus : exit_code;
    }
    const bool loops = options.over && options.over->loop;
    const std::optional<motion::RecoveredTake> recorded = motion::read_journal(arguments.file);
    if (!recorded) throw std::runtime_error("'" + motion::journal_path(arguments.file) + "' is gone");
    const sim::JointMotion motion =
        motion::save_take(arguments.file, *recorded, loops ? "" : hash, arguments.operation).motion;
    if (arguments.embed) motion::embed_world(motion::take_path(arguments.file), embedded);
    std::cout << fmt::format("{}: {:.3f} s, {} joints, {} keys; each frame is in {}\nstate hash at the end {}\n",
                             arguments.file, motion.end_s(), motion.tracks().size(), motion.keys.size(),
                             motion::take_path(arguments.file), hash);
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
  command
      ->add_option("--vehicle", arguments->stage.vehicle,
                   "name of the vehicle; required if several have a motion_player")
      ->type_name("NAME");
  // Inputs.
  CLI::Option* input =
      command
          ->add_option("--input", arguments->devices,
                       "keyboard or gamepad in place of the terminal: /dev/input/eventX; may be repeated")
          ->type_name("DEVICE")
          ->type_size(1)
          ->allow_extra_args(false);
  command->add_option("--events", arguments->events, "record the events in a file of device events, at full speed")
      ->type_name("FILE")
      ->excludes(input);
  command->add_option("--on", arguments->actions, "key that executes an action of the world; may be repeated")
      ->type_name("KEY=ACTION")
      ->type_size(1)
      ->allow_extra_args(false);
  command->add_option("--rate", arguments->rate, "simulated seconds per wall second; below 1: slow motion; default 1")
      ->type_name("R")
      ->check(number_from(0.01, 10));
  // Options that select what is recorded.
  command_line::add_name_list(*command, "--overdub", arguments->overdub,
                              "joints that are recorded while the others play the file; comma separated")
      ->type_name("JOINTS");
  CLI::Option* in =
      command->add_option("--punch-in", arguments->from_s, "start of the part of the file that is recorded, s")
          ->type_name("S")
          ->check(number_from(0, sim::max_motion_s));
  CLI::Option* out = command
                         ->add_option("--punch-out", arguments->to_s,
                                      "end of this part, s; until then the joints return to the values of the file")
                         ->type_name("S")
                         ->check(number_from(0, sim::max_motion_s));
  command->add_flag("--append", arguments->append, "play the file, then continue recording from its last frame")
      ->excludes(in)
      ->excludes(out);
  command->add_option("--duration", arguments->duration_s, "end after this time of the motion, s")
      ->type_name("S")
      ->check(number_from(0.01, sim::max_motion_s));
  command->add_flag("--overwrite", arguments->overwrite,
                    "replace existing files; `shoal motion edit undo` brings FILE back");
  CLI::Option* embed =
      command->add_flag("--embed", arguments->embed,
                        "embed the world in FILE_take.yaml, so that it can be played without the world file");
  command->add_flag("--recover", arguments->recover, "only save an interrupted recording")->excludes(embed);
  CLI::Option* page = command->add_flag("--view", arguments->with_page,
                                        "serve a live page of the recording in 3-D, and print its address");
  add_open_option(*command, arguments->open)->needs(page);
  add_page_options(*command, arguments->view);
  command->get_option("--view-port")->needs(page);
  add_set_option(*command, arguments->stage.load.sets);
  add_allow_path_option(*command, arguments->stage.load);
  command_line::set_help_end(
      *command,
      {{"shoal motion record wave.yaml --world ers7_studio --view",
        "shoal motion record wave.yaml --world ers7_studio --input /dev/input/event5 --rate 0.25",
        "shoal motion record wave.yaml --world ers7_studio --overdub head_pan,head_nod",
        "shoal motion record wave.yaml --world ers7_studio --punch-in 2 --punch-out 3.5",
        "shoal motion record wave.yaml --world ers7_studio --append --duration 10",
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
