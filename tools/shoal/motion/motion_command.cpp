// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/world_files/world_by_name.hpp"
#include "motion/formats/motion_format.hpp"
#include "sim/world_file/file_kind.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/motion/motion_commands.hpp"

namespace tools {

void add_stage_options(CLI::App& command, std::string& world, std::string& vehicle) {
  command.add_option("--world", world, "world with a vehicle that has a motion_player")->type_name("WORLD")->required();
  command.add_option("--vehicle", vehicle, "name of the vehicle; required if several have a motion_player")
      ->type_name("NAME");
}

sim::JointMotion motion_of(const std::string& path) {
  if (const std::string other = sim::other_kind(path, sim::FileKind::motion); !other.empty())
    throw sim::ConfigError({path + ": this is " + other});
  try {
    return sim::load_motion(path);
  } catch (const sim::ConfigError& error) {
    // Files of other programs are given by mistake; a hint helps more than the errors of a YAML parser.
    const motion::MotionFormat* const format = motion::motion_format_of_file(path, "");
    if (format == nullptr || format->read == nullptr) throw;
    std::vector<std::string> lines = error.lines();
    lines.push_back(fmt::format("{}: looks like the format '{}'; `shoal motion import` reads it", path, format->name));
    throw sim::ConfigError(std::move(lines));
  }
}

sim::VehicleConfig vehicle_of(const std::string& file, const sim::JointMotion& motion) {
  if (file.empty() && motion.vehicle.empty())
    throw command_line::UsageError("the motion names no vehicle: give its file with --vehicle");
  return sim::load_vehicle(
      experiment::file_by_name({experiment::ShippedKind::vehicle}, file.empty() ? motion.vehicle : file), {});
}

static void add_motion_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("motion");
  command->require_subcommand(1);
  add_motion_show_command(*command, exit_code);
  add_motion_check_command(*command, exit_code);
  add_motion_edit_command(*command, exit_code);
  add_motion_play_command(*command, exit_code);
  add_motion_record_command(*command, exit_code);
  add_motion_compare_command(*command, exit_code);
  add_motion_stability_command(*command, exit_code);
  add_motion_divergence_command(*command, exit_code);
  add_motion_evolve_command(*command, exit_code);
  add_motion_connect_command(*command, exit_code);
  add_motion_export_command(*command, exit_code);
  add_motion_import_command(*command, exit_code);
  command_line::set_help_end(*command,
                             {{"shoal motion show vehicles/motions/ers7/wave.yaml",
                               "shoal motion play vehicles/motions/ers7/wave.yaml --world worlds/ers7_studio.yaml",
                               "shoal motion export wave.yaml --format webots --output wave.motion"},
                              {{0, "success"}, {2, "wrong usage"}},
                              {}});
}

SHOAL_COMMAND(make, "motion", "Record, show, check, edit, play and convert motions of robots with joints",
              add_motion_command);

}  // namespace tools
