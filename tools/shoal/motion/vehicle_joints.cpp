// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/vehicle_joints.hpp"

#include <algorithm>
#include <filesystem>

#include "devices/motion/servo_bank.hpp"
#include "devices/signals/led.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "sim/config/file_access.hpp"
#include "sim/world_file/vehicle_loader.hpp"

namespace tools {

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
