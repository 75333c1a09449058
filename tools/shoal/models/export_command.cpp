// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "experiment/world_files/world_by_name.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/models/exported_robot.hpp"
#include "tools/shoal/options/shared_options.hpp"
#include "tools/shoal/urdf/urdf_writer.hpp"

namespace tools {

namespace {

struct ExportArguments {
  std::string file, output;
  bool overwrite = false;
};

int export_vehicle(const ExportArguments& arguments) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::exists(arguments.output, error) && !arguments.overwrite)
    throw command_line::UsageError(arguments.output + ": already exists; --overwrite replaces it");
  check_writable(arguments.output);
  const std::string path = experiment::file_by_name({experiment::ShippedKind::vehicle}, arguments.file);
  const sim::VehicleConfig vehicle = sim::load_vehicle(path);
  RobotDescription robot =
      exported_robot(vehicle, masses_of(vehicle), fs::path(arguments.output).parent_path().string());
  const std::string source = sim::printable(fs::path(path).filename().string());
  robot.comment = {"Made by `shoal export urdf` from " +
                   (source.find("--") == source.npos ? source : "a vehicle file") + "."};
  std::ofstream file(arguments.output, std::ios::binary);
  if (!(file << urdf_text(robot) << std::flush)) throw std::runtime_error(arguments.output + ": cannot be written");
  for (const ImportNote& note : robot.notes) std::cerr << note.place.text() << ": " << note.text << '\n';
  std::cout << arguments.output << ": robot '" << robot.name << "': " << robot.links.size() << " links, "
            << robot.joints.size() << " joints\n";
  return exit_ok;
}

}  // namespace

static void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("export");
  command->require_subcommand(1);
  CLI::App* urdf = command->add_subcommand("urdf", "Convert a vehicle file into a robot in URDF");
  const auto arguments = std::make_shared<ExportArguments>();
  add_log_level_option(*urdf);
  urdf->add_option("FILE", arguments->file, "vehicle file, or the name of a shipped one")->required();
  urdf->add_option("--output", arguments->output, "URDF file to write")->type_name("NAME.urdf")->required();
  urdf->add_flag("--overwrite", arguments->overwrite, "replace an existing file");
  command_line::set_help_end(
      *urdf, {{"shoal export urdf bittle --output bittle.urdf", "shoal export urdf rover_arm.yaml --output arm.urdf"},
              {{0, "the URDF was written"}, {2, "wrong usage, or an error in the vehicle file"}, {4, "file error"}},
              {"What URDF does not hold, such as sensors and forces of the water, is reported on stderr, as "
               "file:line:column: text.  docs/guides/import_urdf.md has the details."}});
  command_line::set_help_end(
      *command, {{"shoal export urdf bittle --output bittle.urdf"},
                 {{0, "the file was written"}, {2, "wrong usage, or an error in the file"}, {4, "file error"}},
                 {}});
  urdf->callback([arguments, &exit_code] { exit_code = export_vehicle(*arguments); });
}

SHOAL_COMMAND(make, "export", "Convert vehicles into files of other programs", add_export_command);

}  // namespace tools
