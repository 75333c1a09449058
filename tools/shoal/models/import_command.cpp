// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "experiment/log_import/mrclam_record.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/mesh/mesh_import.hpp"
#include "tools/shoal/options/shared_options.hpp"
#include "tools/shoal/sdf/sdf_import.hpp"
#include "tools/shoal/urdf/shoal_names.hpp"
#include "tools/shoal/urdf/urdf_import.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

struct ImportArguments {
  std::string file, output;
  std::string model;  ///< SDF: of a world
  std::vector<std::string> packages, model_folders;
  std::string meshes = "hull";
  std::optional<double> density_kgpm3;
  bool fixed_base = false;
  bool overwrite = false;
};

RobotMeshOptions mesh_options(const ImportArguments& arguments) {
  RobotMeshOptions options;
  options.use = arguments.meshes == "hull" ? MeshUse::hull : arguments.meshes == "box" ? MeshUse::box : MeshUse::none;
  options.folder = plain_name(fs::path(arguments.output).stem().string()) + "_meshes";
  for (const std::string& package : arguments.packages) {
    const std::size_t equals = package.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == package.size())
      throw command_line::UsageError("--package must be NAME=DIR, got " + command_line::quoted(package));
    const std::string folder = package.substr(equals + 1);
    std::error_code error;
    if (!fs::is_directory(folder, error))
      throw command_line::UsageError("--package: there is no folder " + command_line::quoted(folder));
    options.folders.packages[package.substr(0, equals)] = folder;
  }
  options.folders.models = arguments.model_folders;
  return options;
}

/// Path of the shipped schema as seen from the folder of a file: relative when the file is a shipped one.
std::string schema_for(const std::string& output) {
  if (sim::shipped_folder().empty()) return "";
  std::error_code error;
  const fs::path shipped = fs::weakly_canonical(sim::shipped_folder(), error);
  const fs::path schema = shipped / "docs/reference/schema/vehicle.schema.json";
  if (!fs::is_regular_file(schema, error)) return "";
  const fs::path folder = fs::weakly_canonical(fs::absolute(output, error).parent_path(), error);
  const bool is_shipped =
      std::mismatch(shipped.begin(), shipped.end(), folder.begin(), folder.end()).first == shipped.end();
  return is_shipped ? schema.lexically_relative(folder).string() : schema.string();
}

void check_output(const ImportArguments& arguments) {
  const fs::path output = arguments.output;
  if (output.extension() != ".yaml")
    throw command_line::UsageError("--output must end in .yaml, got " + command_line::quoted(arguments.output));
  std::error_code error;
  if (fs::exists(output, error) && !arguments.overwrite)
    throw command_line::UsageError(arguments.output + ": already exists; --overwrite replaces it");
  check_writable(arguments.output);
}

void write_files(const ImportArguments& arguments, const RobotImport& result) {
  const fs::path folder = fs::path(arguments.output).parent_path();
  std::error_code error;
  for (const auto& [path, mesh] : result.meshes) {
    fs::create_directories((folder / path).parent_path(), error);  // save_mesh() reports a failure
    try {
      save_mesh(mesh, (folder / path).string());
    } catch (const sim::MeshError& problem) {
      throw std::runtime_error((folder / path).string() + ": " + problem.what());
    }
  }
  std::ofstream file(arguments.output, std::ios::binary);
  if (!(file << result.text << std::flush)) throw std::runtime_error(arguments.output + ": cannot be written");
}

void print_notes(const std::vector<ImportNote>& notes) {
  constexpr std::size_t max_notes = 500;
  for (std::size_t i = 0; i < std::min(notes.size(), max_notes); ++i)
    std::cerr << notes[i].place.text() << ": " << sim::printable(notes[i].text) << '\n';
  if (notes.size() > max_notes) std::cerr << notes.size() - max_notes << " more notes are not shown\n";
}

std::string counted(std::size_t count, const std::string& word) {
  return std::to_string(count) + ' ' + (count == 1 ? word : sim::plural_of(word));
}

/// Formats of robots.
enum class RobotFormat { urdf, sdf };

int import_robot(const ImportArguments& arguments, RobotFormat format) {
  const RobotImportOptions options{.base = arguments.fixed_base ? Base::fixed : Base::free,
                                   .density_kgpm3 = arguments.density_kgpm3,
                                   .meshes = mesh_options(arguments),
                                   .schema = schema_for(arguments.output)};
  check_output(arguments);
  const RobotImport result = format == RobotFormat::urdf ? import_urdf(arguments.file, options)
                                                         : import_sdf(arguments.file, arguments.model, options);
  write_files(arguments, result);
  print_notes(result.vehicle.notes);
  const std::vector<ImportedJoint>& joints = result.vehicle.joints;
  const auto servos =
      std::count_if(joints.begin(), joints.end(), [](const ImportedJoint& joint) { return joint.has_servo(); });
  std::cout << arguments.output << ": vehicle '" << result.vehicle.name
            << "': " << counted(result.vehicle.bodies.size(), "body") << ", " << counted(joints.size(), "joint") << ", "
            << counted(static_cast<std::size_t>(servos), "servo") << ", " << counted(result.meshes.size(), "mesh file")
            << "; `shoal check " << arguments.output << "` checks it\n";
  return exit_ok;
}

/// Adds the options that the imports of all formats have.
void add_robot_options(CLI::App& command, ImportArguments& arguments) {
  command.add_option("--output", arguments.output, "vehicle file to write; mesh files are written into NAME_meshes")
      ->type_name("NAME.yaml")
      ->required();
  command
      .add_option("--package", arguments.packages,
                  "folder of a ROS package or model, for files named package://NAME/... or model://NAME/...")
      ->type_name("NAME=DIR")
      ->type_size(1)
      ->allow_extra_args(false);
  command
      .add_option("--models", arguments.model_folders,
                  "folder with a folder for each model, for files named model://NAME/...")
      ->type_name("DIR")
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(CLI::ExistingDirectory.description(""));
  command
      .add_option("--meshes", arguments.meshes,
                  "meshes become their convex hull (those that are only visual stay as they are), their bounding box, "
                  "or are left out")
      ->type_name("USE")
      ->check(one_of({"hull", "box", "none"}).description(""))
      ->capture_default_str();
  command
      .add_option("--density", arguments.density_kgpm3,
                  "density of bodies without mass, which get the mass of their shapes, kg/m^3")
      ->type_name("DENSITY")
      ->check(number_from(1e-3, 1e5).description(""));
  command.add_flag("--fixed-base", arguments.fixed_base, "fix the root link to the world, such as an arm on a table");
  command.add_flag("--overwrite", arguments.overwrite, "replace an existing file");
}

void add_urdf_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("urdf", "Convert a robot in URDF into a vehicle file");
  const auto arguments = std::make_shared<ImportArguments>();
  add_log_level_option(*command);
  command->add_option("FILE", arguments->file, "URDF file; expand xacro first")->required();
  add_robot_options(*command, *arguments);
  command_line::set_help_end(
      *command,
      {{"shoal import urdf bittle.urdf --output vehicles/bittle.yaml",
        "shoal import urdf arm.urdf --output arm.yaml --package arm_description=../arm_description --meshes box",
        "shoal import urdf panda.urdf --output panda.yaml --fixed-base --density 1000"},
       {{0, "the vehicle file was written"}, {2, "wrong usage, or an error in the URDF"}, {4, "file error"}},
       {"Each part of the URDF that a vehicle file cannot express is reported on stderr, as file:line: text.  "
        "docs/guides/import_urdf.md has the details."}});
  command->callback([arguments, &exit_code] { exit_code = import_robot(*arguments, RobotFormat::urdf); });
}

void add_sdf_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("sdf", "Convert a model in SDF, of Gazebo, into a vehicle file");
  const auto arguments = std::make_shared<ImportArguments>();
  add_log_level_option(*command);
  command->add_option("FILE", arguments->file, "SDF file, version 1.4 to 1.12")->required();
  command->add_option("--model", arguments->model, "model of a world that has several")->type_name("NAME");
  add_robot_options(*command, *arguments);
  command_line::set_help_end(
      *command,
      {{"shoal import sdf bluerov2/model.sdf --output vehicles/rov.yaml",
        "shoal import sdf x500/model.sdf --output x500.yaml --models ../models",
        "shoal import sdf harbor.sdf --model wamv --output wamv.yaml --meshes box"},
       {{0, "the vehicle file was written"}, {2, "wrong usage, or an error in the SDF"}, {4, "file error"}},
       {"Links, joints, shapes, sensors with their noise, and the plugins Hydrodynamics, Thruster, LiftDrag, "
        "BuoyancyEngine and DiffDrive become a vehicle.  What does not is reported on stderr, as file:line: text.  "
        "docs/guides/import_sdf.md has the details."}});
  command->callback([arguments, &exit_code] { exit_code = import_robot(*arguments, RobotFormat::sdf); });
}

struct MrclamArguments {
  std::string directory, output;
  bool overwrite = false;
};

int import_mrclam(const MrclamArguments& arguments) {
  const experiment::MrclamData data = experiment::read_mrclam(arguments.directory);
  const experiment::MrclamRecord record = experiment::write_mrclam_record(data, arguments.output, arguments.overwrite);
  int unknown = 0;
  for (const experiment::MrclamData::Robot& robot : data.robots) unknown += robot.unknown_barcodes;
  if (unknown > 0) std::cerr << unknown << " measurements have barcodes that no subject has: left out\n";
  std::cout << arguments.output << ": " << counted(data.robots.size(), "robot") << ", "
            << counted(data.landmarks.size(), "landmark") << ", " << record.odometries << " odometry messages, "
            << record.measurements << " sightings, " << std::llround(record.duration_s) << " s\n";
  return exit_ok;
}

void add_mrclam_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("mrclam", "Convert a UTIAS MR.CLAM data set into a record");
  const auto arguments = std::make_shared<MrclamArguments>();
  add_log_level_option(*command, "error");
  command->add_option("DIR", arguments->directory, "folder of the data set")->required();
  command->add_option("--output", arguments->output, "record to write")->type_name("LOG")->required();
  command->add_flag("--overwrite", arguments->overwrite, "replace an existing file");
  command_line::set_help_end(
      *command, {{"shoal import mrclam MRCLAM_Dataset6 --output mrclam6.lcm",
                  "shoal score mrclam6.lcm --estimate robot1.csv --metric robot1"},
                 {{0, "the record was written"}, {2, "wrong usage, or an error in the files"}, {4, "file error"}},
                 {"docs/guides/scoring.md has the channels."}});
  command->callback([arguments, &exit_code] { exit_code = import_mrclam(*arguments); });
}

}  // namespace

static void add_import_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("import");
  command->require_subcommand(1);
  add_urdf_command(*command, exit_code);
  add_sdf_command(*command, exit_code);
  add_mrclam_command(*command, exit_code);
  command_line::set_help_end(
      *command, {{"shoal import urdf bittle.urdf --output vehicles/bittle.yaml",
                  "shoal import sdf bluerov2/model.sdf --output vehicles/rov.yaml",
                  "shoal import mrclam MRCLAM_Dataset6 --output mrclam6.lcm"},
                 {{0, "the file was written"}, {2, "wrong usage, or an error in the file"}, {4, "file error"}},
                 {}});
}

SHOAL_COMMAND(make, "import", "Convert robots and data sets of other programs", add_import_command);

}  // namespace tools
