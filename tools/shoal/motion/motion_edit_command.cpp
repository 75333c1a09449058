// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>

#include "devices/motion/servo_bank.hpp"
#include "devices/signals/led.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "motion/analysis/motion_file.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/shoal/motion/format_options.hpp"
#include "tools/shoal/motion/motion_commands.hpp"
#include "tools/shoal/motion/motion_output.hpp"

namespace tools {

namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;

struct EditArguments {
  std::string file, output, other, vehicle, name;
  std::string operation;  ///< in the words of the command line
  std::vector<std::string> joints, values;
  double from_s = 0, to_s = 0, at_s = 0, by = 0;
  bool replace = false, overwrite = false;
};
using Edit = std::function<sim::JointMotion(const EditArguments&, const sim::JointMotion&)>;

/// Returns the name of a joint in a motion: where the motion names its servo, that name, else the given one.  Throws
/// UsageError when neither the motion nor its vehicle, if that is known, has the joint.
std::string known_joint(const std::string& joint, const EditArguments& arguments, const sim::JointMotion& motion) {
  std::vector<std::string> known;
  for (const sim::MotionTrack& track : motion.tracks()) known.push_back(track.joint);
  const auto has = [&](const std::string& name) { return std::find(known.begin(), known.end(), name) != known.end(); };
  if (has(joint)) return joint;
  const std::string file = arguments.vehicle.empty()
                               ? vehicle_file_of(motion.vehicle, arguments.file)
                               : experiment::file_by_name({experiment::ShippedKind::vehicle}, arguments.vehicle);
  if (file.empty()) return joint;
  const sim::VehicleConfig vehicle = sim::load_vehicle(file);
  for (const devices::ServoOfVehicle& servo : devices::servos_of(vehicle)) {
    const std::string& alias = servo.params->alias;
    const bool is_it = joint == servo.device || (!alias.empty() && joint == alias);
    if (is_it) return has(servo.device) ? servo.device : has(alias) ? alias : joint;
    if (!has(servo.device)) known.push_back(servo.device);
  }
  for (const std::string& light : devices::lights_of(vehicle)) {
    if (joint == light) return joint;
    if (!has(light)) known.push_back(light);
  }
  std::sort(known.begin(), known.end());
  throw command_line::UsageError("joint '" + sim::shortened(sim::printable(joint)) + "' is not a servo of vehicle '" +
                                 vehicle.vehicle + "'" + sim::did_you_mean(joint, known) +
                                 "; known: " + sim::list_text(known));
}

/// Returns the motion with those lights of its vehicle that the arguments set.
sim::JointMotion with_lights(const EditArguments& arguments, const sim::JointMotion& motion) {
  const std::string file = arguments.vehicle.empty()
                               ? vehicle_file_of(motion.vehicle, arguments.file)
                               : experiment::file_by_name({experiment::ShippedKind::vehicle}, arguments.vehicle);
  sim::JointMotion lit = motion;
  if (file.empty()) return lit;
  for (const std::string& light : devices::lights_of(sim::load_vehicle(file)))
    for (const std::string& text : arguments.values)
      if (text.starts_with(light + "=") && !lit.is_light(light)) lit.lights.push_back(light);
  return lit;
}

/// Parses `joint=value`, in the unit of the motion.
sim::JointValues values_of(const EditArguments& arguments, const sim::JointMotion& motion) {
  const std::vector<std::string>& texts = arguments.values;
  sim::JointValues values;
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    const bool has_both = equals != std::string::npos && equals > 0;
    const auto value = has_both ? sim::exact_number<double>(std::string_view(text).substr(equals + 1)) : std::nullopt;
    if (!value)
      throw command_line::UsageError("must be JOINT=VALUE, got '" + sim::shortened(sim::printable(text)) + "'");
    const std::string joint = known_joint(text.substr(0, equals), arguments, motion);
    values.emplace_back(joint, *value * motion.unit_of(joint));
  }
  return values;
}

int edit(const EditArguments& arguments, const Edit& change) {
  const sim::JointMotion motion = motion_of(arguments.file);
  try {
    sim::JointMotion changed = change(arguments, motion);
    std::error_code error;
    // --output may name the same file by another path, which must get a history, too.
    const bool in_place =
        arguments.output.empty() || std::filesystem::equivalent(arguments.file, arguments.output, error);
    const std::string output = in_place ? arguments.file : arguments.output;
    if (!arguments.output.empty()) check_new_file(arguments.output, arguments.overwrite);
    if (!in_place) changed.name = motion::motion_name_of(output);
    check_frames(output, changed, arguments.overwrite);
    if (in_place)
      motion::MotionHistory(arguments.file).replace(changed, arguments.operation);
    else
      motion::write_motion(output, changed);
    std::cout << fmt::format("{}: {}; before {}\n", output, content_text(changed), content_text(motion));
    return exit_ok;
  } catch (const motion::EditError& error) {
    throw command_line::UsageError(error.what());
  } catch (const sim::ConfigError&) {
    throw;
  } catch (const command_line::UsageError&) {
    throw;
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

/// Adds one edit, with the file and the output; the caller adds its options to the command that is returned.
class EditCommands {
 public:
  EditCommands(CLI::App& parent, int& exit_code) : parent_(parent), exit_code_(exit_code) {}

  struct Added {
    CLI::App& command;
    EditArguments& arguments;
  };
  Added add(const std::string& name, const std::string& meaning, const std::string& example, Edit change) {
    CLI::App* command = parent_.add_subcommand(name, meaning);
    const auto arguments = std::make_shared<EditArguments>();
    command->add_option("FILE", arguments->file, "motion file")->required();
    command->add_option("--output", arguments->output, "file to write; unset: FILE itself, which 'undo' can restore")
        ->type_name("OUTPUT");
    add_overwrite_option(*command, arguments->overwrite);
    command_line::set_help_end(*command,
                               {{"shoal motion edit " + name + " " + example},
                                {{0, "success"}, {2, "wrong usage, or mistakes in a file"}, {4, "file error"}},
                                {}});
    command->callback([arguments, command, change = std::move(change), this_exit = &exit_code_] {
      arguments->operation = operation_of(*command);
      *this_exit = edit(*arguments, change);
    });
    return {*command, *arguments};
  }

 private:
  CLI::App& parent_;
  int& exit_code_;
};

const auto time_s = number_from(0, sim::max_motion_s);

void add_part(const EditCommands::Added& added) {
  added.command.add_option("--from", added.arguments.from_s, "start of the part, s")
      ->type_name("S")
      ->check(time_s)
      ->required();
  added.command.add_option("--to", added.arguments.to_s, "end of the part, s")
      ->type_name("S")
      ->check(time_s)
      ->required();
}

void add_vehicle(const EditCommands::Added& added) {
  added.command
      .add_option("--vehicle", added.arguments.vehicle, "vehicle file with the mirror rule; unset: that of the motion")
      ->type_name("FILE");
}

motion::MirrorRule rule_for(const EditArguments& arguments, const sim::JointMotion& motion) {
  return motion::mirror_rule(vehicle_of(arguments.vehicle, motion));
}

void add_cuts(EditCommands& commands) {
  add_part(commands.add("trim", "Keep a part", "wave.yaml --from 0.5 --to 2",
                        [](const auto& a, const auto& motion) { return motion::trimmed(motion, a.from_s, a.to_s); }));
  add_part(commands.add("cut", "Remove a part", "wave.yaml --from 0.5 --to 2",
                        [](const auto& a, const auto& motion) { return motion::without(motion, a.from_s, a.to_s); }));
}

void add_joining(EditCommands& commands) {
  const auto append = commands.add(
      "append", "Append another motion", "sit.yaml wave.yaml --gap 0.5",
      [](const auto& a, const auto& motion) { return motion::appended(motion, motion_of(a.other), a.by); });
  append.arguments.by = 0.5;
  append.command.add_option("OTHER", append.arguments.other, "motion file to append")->required();
  append.command.add_option("--gap", append.arguments.by, "pause between the two, s; default 0.5")
      ->type_name("S")
      ->check(time_s);
  const auto merge = commands.add(
      "merge", "Add the joints of another motion", "legs.yaml head.yaml",
      [](const auto& a, const auto& motion) { return motion::merged(motion, motion_of(a.other), a.replace); });
  merge.command.add_option("OTHER", merge.arguments.other, "motion file whose joints are added")->required();
  merge.command.add_flag("--replace", merge.arguments.replace, "take joints that both files have from OTHER");
}

void add_mirrors(EditCommands& commands) {
  add_vehicle(
      commands.add("mirror", "Exchange left and right", "kick_left.yaml --output kick_right.yaml",
                   [](const auto& a, const auto& motion) { return motion::mirrored(motion, rule_for(a, motion)); }));
  add_vehicle(commands.add(
      "halfcycle", "Append the mirrored motion: half a cycle becomes a whole one", "step.yaml --output walk.yaml",
      [](const auto& a, const auto& motion) { return motion::with_mirrored_half(motion, rule_for(a, motion)); }));
}

void add_times(EditCommands& commands) {
  const auto shift =
      commands.add("shift", "Move joints in time", "wave.yaml --by 0.2 --joints lf_knee",
                   [](const auto& a, const auto& motion) { return motion::shifted(motion, a.by, a.joints); });
  shift.command.add_option("--by", shift.arguments.by, "time, s; negative: earlier")
      ->type_name("S")
      ->check(number_from(-sim::max_motion_s, sim::max_motion_s))
      ->required();
  command_line::add_name_list(shift.command, "--joints", shift.arguments.joints, "joints; unset: all")
      ->type_name("JOINT,...");
  const auto scale = commands.add("scale", "Make a motion slower or faster", "wave.yaml --by 2",
                                  [](const auto& a, const auto& motion) { return motion::stretched(motion, a.by); });
  scale.command.add_option("--by", scale.arguments.by, "factor by which all times are multiplied; 2: half as fast")
      ->type_name("FACTOR")
      ->check(number_from(1e-6, 1e6))
      ->required();
  const auto retime =
      commands.add("retime", "Move a key in time", "wave.yaml --at 0.5 --to 0.7",
                   [](const auto& a, const auto& motion) { return motion::retimed(motion, a.at_s, a.to_s); });
  retime.command.add_option("--at", retime.arguments.at_s, "time of the key, s")
      ->type_name("S")
      ->check(time_s)
      ->required();
  retime.command.add_option("--to", retime.arguments.to_s, "its new time, s")
      ->type_name("S")
      ->check(time_s)
      ->required();
}

void add_values(EditCommands& commands) {
  const auto smooth = commands.add("smooth", "Round the corners", "wave.yaml --window 0.1",
                                   [](const auto& a, const auto& motion) { return motion::smoothed(motion, a.by); });
  smooth.command.add_option("--window", smooth.arguments.by, "time over which values are averaged, s")
      ->type_name("S")
      ->check(time_s)
      ->required();
  const auto simplify =
      commands.add("simplify", "Leave out keys", "recorded.yaml --tolerance 0.25",
                   [](const auto& a, const auto& motion) { return motion::simplified(motion, a.by * rad_per_deg); });
  simplify.arguments.by = 0.25;
  simplify.command.add_option("--tolerance", simplify.arguments.by, "largest change of a value, deg; default 0.25")
      ->type_name("DEG")
      ->check(number_from(0, 360));
  const auto set = commands.add("set", "Set values of joints", "wave.yaml --at 0.5 lf_knee=40 rf_knee=40",
                                [](const auto& a, const auto& motion) {
                                  const sim::JointMotion lit = with_lights(a, motion);
                                  return motion::with_values(lit, a.at_s, values_of(a, lit));
                                });
  set.command.add_option("--at", set.arguments.at_s, "time, s")->type_name("S")->check(time_s)->required();
  set.command.add_option("VALUES", set.arguments.values, "JOINT=VALUE, in the unit of the file; a light from 0 to 1")
      ->required();
  set.command.add_option("--vehicle", set.arguments.vehicle, "vehicle file with the joints; unset: that of the motion")
      ->type_name("FILE");
  const auto pose =
      commands.add("pose", "Store the values at a time as a named pose", "wave.yaml --at 1 --name stand",
                   [](const auto& a, const auto& motion) { return motion::with_pose(motion, a.name, a.at_s); });
  pose.command.add_option("--at", pose.arguments.at_s, "time, s")->type_name("S")->check(time_s)->required();
  pose.command.add_option("--name", pose.arguments.name, "name of the pose")->type_name("NAME")->required();
}

/// Returns what a file has, even when it is not a good motion file.
std::string present_content(const std::string& file) {
  try {
    return content_text(sim::load_motion(file));
  } catch (const sim::ConfigError&) {
    return "a file with mistakes";
  }
}

void add_history(CLI::App& parent, int& exit_code, const std::string& name, const std::string& meaning,
                 const std::string& done, std::string (motion::MotionHistory::*go)() const) {
  CLI::App* command = parent.add_subcommand(name, meaning);
  const auto file = std::make_shared<std::string>();
  command->add_option("FILE", *file, "motion file")->required();
  command_line::set_help_end(*command, {{"shoal motion edit " + name + " wave.yaml"},
                                        {{0, "success"}, {4, "there is no such version, or a file error"}},
                                        {"Versions are kept in the folder FILE.history."}});
  command->callback([file, done, go, &exit_code] {
    try {
      const std::string before = present_content(*file);
      const std::string operation = (motion::MotionHistory(*file).*go)();
      std::cout << fmt::format("{}: {} {}; now {}; before {}\n", *file, done,
                               operation.empty() ? "the last change" : "'" + sim::printable(operation) + "'",
                               present_content(*file), before);
      exit_code = exit_ok;
    } catch (const sim::ConfigError&) {
      throw;
    } catch (const std::runtime_error& error) {
      std::cerr << "shoal: " << error.what() << '\n';
      exit_code = exit_bus;
    }
  });
}

}  // namespace

void add_motion_edit_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("edit", "Change a motion file");
  add_log_level_option(*command);
  command->require_subcommand(1);
  EditCommands commands(*command, exit_code);
  add_cuts(commands);
  add_joining(commands);
  add_mirrors(commands);
  add_times(commands);
  add_values(commands);
  add_history(*command, exit_code, "undo", "Undo the last edit", "took back", &motion::MotionHistory::undo);
  add_history(*command, exit_code, "redo", "Redo an edit that was undone", "did again", &motion::MotionHistory::redo);
  command_line::set_help_end(*command, {{"shoal motion edit trim wave.yaml --from 0.5 --to 2",
                                         "shoal motion edit mirror kick_left.yaml --output kick_right.yaml",
                                         "shoal motion edit undo wave.yaml"},
                                        {{0, "success"}, {2, "wrong usage, or mistakes in a file"}, {4, "file error"}},
                                        {}});
}

}  // namespace tools
