// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/drive_mapping.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiment/drive/drive_profile.hpp"
#include "shoal/ackermann_command_t.hpp"
#include "shoal/actuator_command_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/inclination_t.hpp"
#include "shoal/joint_command_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/joint_settings_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/pan_tilt_zoom_command_t.hpp"
#include "shoal/thrust_rudder_command_t.hpp"
#include "shoal/thrust_rudder_elevator_command_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/wrench_t.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

bool takes(const DrivenDevice& device, const std::string& type) {
  return (", " + device.command_types + ",").find(" shoal." + type + ",") != std::string::npos;
}

const DrivenDevice* find_device(const DrivenVehicle& vehicle, const std::string& name) {
  const auto found = std::find_if(vehicle.devices.begin(), vehicle.devices.end(),
                                  [&](const DrivenDevice& device) { return device.name == name; });
  return found == vehicle.devices.end() ? nullptr : &*found;
}

double value_of(const DriveValues& values, std::string_view axis) {
  const auto found = values.find(axis);
  return found == values.end() || !std::isfinite(found->second) ? 0 : std::clamp(found->second, -1.0, 1.0);
}

template <typename Message>
sim::Bytes stamped(Message message, std::int64_t utime) {
  message.utime = utime;
  return shoal::encode(message);
}

/// Returns a command with the thrust and the rudder of the axes.
template <typename Message>
Message thrust_rudder(const DriveProfile::Thrust& limits, const DriveValues& values) {
  Message command{};
  command.thrust = value_of(values, "forward") * limits.thrust;
  command.rudder = value_of(values, "turn") * limits.rudder;
  return command;
}

std::string words_of(const std::vector<DriveKind>& kinds) {
  std::string words;
  for (const DriveKind kind : kinds)
    words += (words.empty() ? "" : ", ") + std::string(sim::word_of(drive_kind_words, kind));
  return words;
}

sim::Bytes mix_payload(bool wrench, const std::vector<DriveProfile::Share>& shares, const DriveValues& values,
                       std::int64_t utime) {
  using Part = DriveProfile::Part;
  std::array<double, 7> parts{};  // by Part
  for (const DriveProfile::Share& share : shares)
    parts.at(static_cast<std::size_t>(share.part)) +=
        share.forward * value_of(values, "forward") + share.turn * value_of(values, "turn") +
        share.dive * value_of(values, "dive") + share.side * value_of(values, "side");
  const auto part = [&](Part which) { return parts.at(static_cast<std::size_t>(which)); };
  if (!wrench) {
    shoal::actuator_command_t command{};
    command.value = part(Part::value);
    return stamped(command, utime);
  }
  shoal::wrench_t command{};
  command.force_N[0] = part(Part::force_x_N);
  command.force_N[1] = part(Part::force_y_N);
  command.force_N[2] = part(Part::force_z_N);
  command.torque_Nm[0] = part(Part::torque_x_Nm);
  command.torque_Nm[1] = part(Part::torque_y_Nm);
  command.torque_Nm[2] = part(Part::torque_z_Nm);
  return stamped(command, utime);
}

}  // namespace

DrivenVehicle driven_vehicle(const shoal::sim_vehicle_t& message) {
  DrivenVehicle vehicle{message.vehicle, {}};
  for (std::size_t i = 0; i < message.device.size(); ++i)
    vehicle.devices.push_back(
        {message.device[i], message.device_type[i], message.command_channel[i], message.command_types[i]});
  return vehicle;
}

std::vector<DriveKind> drive_kinds(const DriveProfile& profile, const DrivenVehicle& vehicle) {
  std::vector<DriveKind> kinds;
  for (const DriveKind kind :
       {DriveKind::twist, DriveKind::tilt, DriveKind::helm, DriveKind::thrust, DriveKind::camera, DriveKind::joints})
    if (DriveMapping(profile).find(kind, vehicle)) kinds.push_back(kind);
  return kinds;
}

DriveMapping::DriveMapping(const DriveProfile& profile, const DrivenVehicle& vehicle, std::optional<DriveKind> kind)
    : profile_(profile) {
  const std::vector<DriveKind> kinds = drive_kinds(profile, vehicle);
  const std::string who = "vehicle '" + sim::shortened(sim::printable(vehicle.name)) + "'";
  if (kinds.empty()) throw DriveError(who + " has no devices by which it can be driven");
  if (!find(kind.value_or(kinds.front()), vehicle))
    throw DriveError(who + " cannot be driven by '" + std::string(sim::word_of(drive_kind_words, *kind)) +
                     "', only by: " + words_of(kinds));
}

bool DriveMapping::find(DriveKind kind, const DrivenVehicle& vehicle) {
  kind_ = kind;
  switch (kind) {
    case DriveKind::twist:
      find_twist(vehicle);
      break;
    case DriveKind::tilt:
      axes_ = {"forward", "turn"};
      find_program(true, vehicle);
      break;
    case DriveKind::helm:
      find_helm(vehicle);
      break;
    case DriveKind::thrust:
      find_thrust(vehicle);
      break;
    case DriveKind::camera:
      find_cameras(vehicle);
      break;
    case DriveKind::joints:
      find_joints(vehicle);
  }
  return !targets_.empty() || !mix_.empty();
}

void DriveMapping::find_twist(const DrivenVehicle& vehicle) {
  axes_ = {"forward", "turn"};
  for (const DrivenDevice& device : vehicle.devices)
    if (takes(device, "ackermann_command_t"))
      targets_.push_back({Form::ackermann, device.channel});
    else if (takes(device, "twist_command_t"))
      targets_.push_back({Form::twist, device.channel});
  if (targets_.empty()) find_program(false, vehicle);
}

/// Finds a program that drives the vehicle, of kind tilt by its turn rate and then its tilt.
void DriveMapping::find_program(bool tilts, const DrivenVehicle& vehicle) {
  for (const DriveProfile::Program& program : profile_.programs) {
    if (tilts && !program.tilts) continue;
    const bool fits = std::all_of(program.devices.begin(), program.devices.end(),
                                  [&](const std::string& name) { return find_device(vehicle, name) != nullptr; });
    if (!fits) continue;
    targets_.push_back({Form::twist, vehicle.name + "." + program.name + ".cmd"});
    if (tilts) targets_.push_back({Form::tilt, targets_.back().channel});
    return;
  }
}

void DriveMapping::find_helm(const DrivenVehicle& vehicle) {
  axes_ = {"forward", "turn", "dive"};
  // An autopilot may command another helm: only one of them is driven.
  const DrivenDevice* helm = nullptr;
  for (const DrivenDevice& device : vehicle.devices)
    if (takes(device, "helm_command_t") && (helm == nullptr || device.type == "autopilot")) helm = &device;
  if (helm != nullptr) targets_.push_back({Form::helm, helm->channel});
}

void DriveMapping::find_thrust(const DrivenVehicle& vehicle) {
  axes_ = {"forward", "turn"};
  for (const DrivenDevice& device : vehicle.devices)
    if (takes(device, "thrust_rudder_elevator_command_t")) {
      axes_ = {"forward", "turn", "dive"};
      targets_.push_back({Form::thrust_rudder_elevator, device.channel});
    } else if (takes(device, "thrust_rudder_command_t")) {
      targets_.push_back({Form::thrust_rudder, device.channel});
    }
  // A drive that takes thrust and rudder goes first; else the profile knows how to mix thrusters and fins.
  if (!targets_.empty()) return;
  for (const DriveProfile::Craft& craft : profile_.crafts)
    if (add_craft(craft, vehicle)) return;
}

/// Adds the actuators of a craft if the vehicle has them all.
bool DriveMapping::add_craft(const DriveProfile::Craft& craft, const DrivenVehicle& vehicle) {
  std::vector<MixTarget> mix;
  std::array<bool, 4> moves{};  // forward, turn, dive, side
  for (const DriveProfile::Share& share : craft.shares) {
    const bool wrench = share.part != DriveProfile::Part::value;
    const DrivenDevice* const device = find_device(vehicle, share.device);
    if (device == nullptr || !takes(*device, wrench ? "wrench_t" : "actuator_command_t")) return false;
    // Shares of the same device make one command.
    auto same =
        std::find_if(mix.begin(), mix.end(), [&](const MixTarget& other) { return other.channel == device->channel; });
    if (same == mix.end()) same = mix.insert(mix.end(), {device->channel, wrench, {}});
    same->shares.push_back(share);
    const double gains[] = {share.forward, share.turn, share.dive, share.side};
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = moves[i] || gains[i] != 0;
  }
  axes_.clear();
  for (std::size_t i = 0; i < moves.size(); ++i)
    if (moves[i]) axes_.emplace_back(sim::word_of(drive_axis_words, static_cast<DriveAxis>(i)));
  mix_ = std::move(mix);
  return !mix_.empty();
}

void DriveMapping::find_cameras(const DrivenVehicle& vehicle) {
  axes_ = {"forward", "turn", "dive"};
  for (const DrivenDevice& device : vehicle.devices)
    if (takes(device, "pan_tilt_zoom_command_t")) targets_.push_back({Form::pan_tilt_zoom, device.channel});
}

void DriveMapping::find_joints(const DrivenVehicle& vehicle) {
  for (const DrivenDevice& device : vehicle.devices) {
    if (takes(device, "joint_servo_command_t"))
      targets_.push_back({Form::joint_servo, device.channel, device.name});
    else if (takes(device, "joint_command_t"))
      targets_.push_back({Form::joint, device.channel, device.name});
    else if (takes(device, "joint_settings_t"))
      targets_.push_back({Form::joint_settings, device.channel, device.name});
    else
      continue;
    axes_.push_back(device.name);
  }
}

std::vector<DriveCommand> DriveMapping::commands(const DriveValues& values, std::int64_t utime,
                                                 const std::optional<DrivePose>& pose) {
  std::vector<DriveCommand> commands;
  for (const Target& target : targets_) {
    // A vehicle that tilts no more rolls on: what stops it is the speed of 0 before.
    if (target.form == Form::tilt && value_of(values, "forward") == 0) continue;
    commands.push_back({target.channel, payload(target, values, utime, pose)});
  }
  for (const MixTarget& target : mix_)
    commands.push_back({target.channel, mix_payload(target.wrench, target.shares, values, utime)});
  return commands;
}

sim::Bytes DriveMapping::payload(const Target& target, const DriveValues& values, std::int64_t utime,
                                 const std::optional<DrivePose>& pose) {
  const double forward = value_of(values, "forward"), turn = value_of(values, "turn");
  const double joint = profile_.joints.velocity * value_of(values, target.axis);
  switch (target.form) {
    case Form::twist: {
      shoal::twist_command_t command{};
      // With kind tilt the speed follows from the tilt; the twist only turns.
      command.forward_mps = kind_ == DriveKind::tilt ? 0 : forward * profile_.twist.forward_mps;
      command.turn_radps = turn * (kind_ == DriveKind::tilt ? profile_.tilt.turn_radps : profile_.twist.turn_radps);
      return stamped(command, utime);
    }
    case Form::tilt: {
      shoal::inclination_t command{};
      command.pitch_rad = forward * profile_.tilt.tilt_rad;
      return stamped(command, utime);
    }
    case Form::ackermann: {
      shoal::ackermann_command_t command{};
      command.speed_mps = forward * profile_.twist.forward_mps;
      command.steering_rad = turn * profile_.twist.steering_rad;
      return stamped(command, utime);
    }
    case Form::helm:
      return helm_payload(values, utime, pose);
    case Form::thrust_rudder_elevator: {
      auto command = thrust_rudder<shoal::thrust_rudder_elevator_command_t>(profile_.thrust, values);
      command.elevator = value_of(values, "dive") * profile_.thrust.elevator;
      return stamped(command, utime);
    }
    case Form::thrust_rudder:
      return stamped(thrust_rudder<shoal::thrust_rudder_command_t>(profile_.thrust, values), utime);
    case Form::pan_tilt_zoom: {
      shoal::pan_tilt_zoom_command_t command{};
      command.pan_rad = command.tilt_rad = command.fov_rad = nothing;
      command.pan_radps = turn * profile_.camera.pan_radps;
      command.tilt_radps = forward * profile_.camera.tilt_radps;
      command.fov_radps = -value_of(values, "dive") * profile_.camera.zoom_radps;
      return stamped(command, utime);
    }
    case Form::joint_servo: {
      shoal::joint_servo_command_t command{};
      command.mode = 1;
      command.velocity = joint;
      return stamped(command, utime);
    }
    case Form::joint: {
      shoal::joint_command_t command{};
      command.velocity = joint;
      return stamped(command, utime);
    }
    case Form::joint_settings: {
      shoal::joint_settings_t command{};
      // NaN: as before, for all but the velocity.
      command.axis = -1;
      command.velocity = joint;
      command.max_force = command.low_stop = command.high_stop = nothing;
      return stamped(command, utime);
    }
  }
  return {};
}

/// Makes a helm command: heading and depth ahead of the present ones while their axes are deflected, the present ones
/// once when they come back, and unchanged otherwise.
sim::Bytes DriveMapping::helm_payload(const DriveValues& values, std::int64_t utime,
                                      const std::optional<DrivePose>& pose) {
  const double turn = value_of(values, "turn"), dive = value_of(values, "dive");
  shoal::helm_command_t command{};
  command.speed_mps = value_of(values, "forward") * profile_.helm.speed_mps;
  command.heading_rad = command.depth_m = command.altitude_m = nothing;
  if (pose && (turn != 0 || turned_))
    command.heading_rad = std::remainder(pose->yaw_rad + turn * profile_.helm.heading_lead_rad, 2 * std::numbers::pi);
  if (pose && (dive != 0 || dived_)) command.depth_m = std::max(0.0, pose->depth_m + dive * profile_.helm.depth_lead_m);
  turned_ = turn != 0;
  dived_ = dive != 0;
  return stamped(command, utime);
}

}  // namespace experiment
