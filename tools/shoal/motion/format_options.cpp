// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/format_options.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "devices/motion/servo_bank.hpp"
#include "devices/signals/led.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

void add_format_options(CLI::App& command, FormatArguments& arguments) {
  command.add_option("--output", arguments.output, "file to write")->type_name("FILE")->required();
  command.add_option("--format", arguments.format, "format of the other program; unset: by the file")
      ->type_name("FORMAT")
      ->check(command_line::one_of(motion::motion_format_names()).description(""));
  command.add_option("--vehicle", arguments.vehicle, "vehicle with the joints; unset: that of the motion")
      ->type_name("VEHICLE");
  command
      .add_option(
          "--names", arguments.names,
          "file of the names of joints in other programs; unset: joint_names/VEHICLE.yaml beside the vehicle file")
      ->type_name("FILE")
      ->needs(command.get_option("--vehicle"));
  command.add_flag("--keep-names", arguments.keep_names, "do not convert joint names")
      ->excludes(command.get_option("--vehicle"));
  command.add_option("--name", arguments.options.name, "name of the motion in the file of the other program")
      ->type_name("NAME");
  command
      .add_option(
          "--loop-step-ms", arguments.loop_step_ms,
          "webots: control step of the player that repeats the file; the file then ends one step before the loop does")
      ->type_name("MS")
      ->check(command_line::number_from(1, 10000).description(""));
  command.add_option("--row-ms", arguments.row_ms, "opencat: time of a row of a gait, and of a step of a behavior")
      ->type_name("MS")
      ->check(command_line::number_from(0.1, 10000).description(""))
      ->capture_default_str();
  command.add_flag("--strict", arguments.strict, "write nothing if something would be lost");
  command.add_flag("--overwrite", arguments.overwrite, "replace an existing file");
}

motion::JointNames names_for(const FormatArguments& arguments, const std::string& vehicle_of_motion) {
  if (!arguments.vehicle.empty())
    return joint_names_of(experiment::file_by_name({experiment::ShippedKind::vehicle}, arguments.vehicle),
                          arguments.names);
  if (arguments.keep_names || vehicle_of_motion.empty()) return {};
  const std::string file = vehicle_file_of(vehicle_of_motion, arguments.input);
  if (!file.empty()) return joint_names_of(file, "");
  std::cerr << arguments.input << ": no file of vehicle '" << vehicle_of_motion
            << "': names of joints stay as they are\n";
  return {};
}

void check_output(const FormatArguments& arguments, const std::string& path) {
  std::error_code error;
  if (std::filesystem::equivalent(arguments.input, path, error))
    throw CLI::ValidationError("--output", "must not be the file that is read");
  if (!arguments.overwrite && std::filesystem::exists(path, error))
    throw CLI::ValidationError("--output", "'" + path + "' exists; --overwrite replaces it");
  check_writable(path);
}

bool may_lose(const FormatArguments& arguments, const motion::Losses& losses) {
  for (const std::string& loss : losses) std::cerr << arguments.input << ": " << sim::printable(loss) << '\n';
  if (losses.empty() || !arguments.strict) return true;
  std::cerr << arguments.input << ": nothing is written, because of --strict\n";
  return false;
}

std::string formats_text(bool is_import) {
  std::string text;
  for (const motion::MotionFormat& format : motion::motion_formats())
    if (is_import ? format.read != nullptr : format.write != nullptr || format.write_folder != nullptr)
      text += (text.empty() ? "Formats: " : "; ") + std::string(format.name) + ", " + format.meaning;
  return text + ".";
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  if (!(file << bytes << std::flush)) throw std::runtime_error(path + ": cannot be written");
}

namespace {

namespace fs = std::filesystem;

std::string existing_names_file(const std::string& vehicle_file, const std::string& vehicle) {
  const fs::path name = fs::path("joint_names") / (vehicle + ".yaml");
  for (const fs::path& folder : {fs::path(vehicle_file).parent_path(), fs::path(sim::shipped_folder()) / "vehicles"}) {
    std::error_code error;
    if (fs::is_regular_file(folder / name, error)) return (folder / name).string();
  }
  return "";
}

}  // namespace

motion::JointNames joint_names_of(const std::string& vehicle_file, const std::string& names_file) {
  const sim::VehicleConfig vehicle = sim::load_vehicle(vehicle_file);
  std::vector<motion::NamedJoint> joints;
  for (const devices::ServoOfVehicle& servo : devices::servos_of(vehicle)) {
    const auto joint = std::find_if(vehicle.joints.begin(), vehicle.joints.end(),
                                    [&](const sim::JointConfig& one) { return one.name == servo.params->joint; });
    const sim::JointConfig* const found = joint == vehicle.joints.end() ? nullptr : &*joint;
    // Joints that a motion leaves out rest at their park positions.
    joints.push_back({servo.device, servo.params->alias, std::clamp(servo.params->park_position, servo.low, servo.high),
                      found != nullptr && !sim::joint_info(found->type).turns});
  }
  if (joints.empty()) throw sim::ConfigError({vehicle_file + ": the vehicle has no joint_servo"});
  for (const std::string& light : devices::lights_of(vehicle)) joints.push_back({light, "", 0, false, true});
  const std::string file = names_file.empty() ? existing_names_file(vehicle_file, vehicle.vehicle) : names_file;
  std::vector<motion::JointNameList> lists;
  if (!file.empty()) lists = motion::load_joint_names(file).lists;
  return {vehicle.vehicle, std::move(joints), std::move(lists)};
}

std::string vehicle_file_of(const std::string& vehicle, const std::string& motion_file) {
  std::error_code error;
  const fs::path beside = fs::path(motion_file).parent_path() / (vehicle + ".yaml");
  if (vehicle.empty()) return "";
  if (fs::is_regular_file(beside, error) && !fs::equivalent(beside, motion_file, error)) return beside.string();
  for (const experiment::ShippedFile& file : experiment::shipped_files(experiment::ShippedKind::vehicle))
    if (file.name == vehicle) return file.path;
  return "";
}

}  // namespace tools
