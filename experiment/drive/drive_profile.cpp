// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/drive_profile.hpp"

#include <algorithm>
#include <set>

namespace experiment {

namespace {

constexpr std::size_t max_items = 1000;
constexpr int max_code = 0x2ff;

void check_key(sim::ParamReader& in, const char* key, const std::string& value) {
  if (in.describing() || !in.has(key)) return;
  const std::vector<std::string> named{"space", "up", "down", "left", "right", "tab", "enter"};
  const bool character = value.size() == 1 && value[0] > ' ' && value[0] < 127;
  if (!character && std::find(named.begin(), named.end(), value) == named.end())
    in.error(key, std::string("'") + key +
                      "' must be one character, or one of: space, up, down, left, right, tab, "
                      "enter");
}

void check_size(sim::ParamReader& in, const char* key, std::size_t size) {
  if (size > max_items) in.error(key, std::string("'") + key + "' must have at most 1000 items");
}

}  // namespace

void DriveProfile::Key::read(sim::ParamReader& in) {
  in.require("key");
  in.read("key", key, "one character, or space, up, down, left, right, tab, enter");
  check_key(in, "key", key);
  in.require("axis");
  in.read_choice("axis", axis, drive_axis_words, "axis that it moves");
  in.read("step", step, sim::between(-1, 1), "change of the set position at each press; negative: back");
}

void DriveProfile::Keys::read(sim::ParamReader& in) {
  in.read("hold", hold, "dead-man key: the vehicle moves while it is held");
  check_key(in, "hold", hold);
  in.read("centre", centre, "key that sets all axes to 0");
  check_key(in, "centre", centre);
  in.read("next_joint", next_joint, "key that selects the next joint; of kind joints");
  check_key(in, "next_joint", next_joint);
  in.read_list("steps", steps, "key", "keys that move an axis");
  check_size(in, "steps", steps.size());
  if (in.describing()) return;
  // A key has one meaning.
  std::set<std::string> used;
  for (const std::string& one : {hold, centre, next_joint})
    if (!used.insert(one).second) in.error("key '" + one + "' has two meanings");
  for (const Key& one : steps)
    if (!one.key.empty() && !used.insert(one.key).second) in.error("steps", "key '" + one.key + "' has two meanings");
}

void DriveProfile::PadAxis::read(sim::ParamReader& in) {
  in.require("code");
  in.read("code", code, sim::between(0, 63), "number of the axis (ABS_... in linux/input-event-codes.h)");
  in.require("axis");
  in.read_choice("axis", axis, drive_axis_words, "axis that it moves");
  in.read("scale", scale, sim::between(-1, 1), "share of full deflection; negative: reversed");
  in.read("low", low, sim::between(-2147483648.0, 2147483647.0), "lowest value, if the device does not report it");
  in.read("high", high, sim::between(-2147483648.0, 2147483647.0), "highest value, if the device does not report it");
  if (!in.describing() && !(low < high)) in.error("high", "'high' must be above 'low'");
}

void DriveProfile::Gamepad::read(sim::ParamReader& in) {
  in.read("hold", hold, sim::between(0, max_code), "code of the dead-man button (BTN_...)");
  in.read("next_joint", next_joint, sim::between(0, max_code), "button that selects the next joint; of kind joints");
  in.read("dead_band", dead_band, sim::between(0, 0.9), "deflection below which an axis is 0");
  in.read_list("axes", axes, "axis", "axes of the gamepad");
  check_size(in, "axes", axes.size());
}

void DriveProfile::Twist::read(sim::ParamReader& in) {
  in.read("forward_mps", forward_mps, sim::between(0, 100), "speed at full deflection");
  in.read("turn_radps", turn_radps, sim::between(0, 100), "turn rate at full deflection");
  in.read_deg("steering_deg", steering_rad, sim::between(0, 90), "steering angle of a car at full deflection");
}

void DriveProfile::Tilt::read(sim::ParamReader& in) {
  in.read_deg("tilt_deg", tilt_rad, sim::between(0, 45), "tilt from the balance at full deflection");
  in.read("turn_radps", turn_radps, sim::between(0, 100), "turn rate at full deflection");
}

void DriveProfile::Helm::read(sim::ParamReader& in) {
  in.read("speed_mps", speed_mps, sim::between(0, 100), "speed at full deflection");
  in.read_deg("heading_lead_deg", heading_lead_rad, sim::between(0, 180),
              "heading set point ahead of the present heading, at full deflection");
  in.read("depth_lead_m", depth_lead_m, sim::between(0, 1000),
          "depth set point below the present depth, at full deflection");
}

void DriveProfile::Thrust::read(sim::ParamReader& in) {
  in.read("thrust", thrust, sim::between(0, 1), "thrust at full deflection");
  in.read("rudder", rudder, sim::between(0, 1), "rudder at full deflection");
  in.read("elevator", elevator, sim::between(0, 1), "elevator at full deflection");
}

void DriveProfile::Camera::read(sim::ParamReader& in) {
  in.read_deg("pan_degps", pan_radps, sim::between(0, 3600), "speed of the pan at full deflection of turn");
  in.read_deg("tilt_degps", tilt_radps, sim::between(0, 3600), "speed of the tilt at full deflection of forward");
  in.read_deg("zoom_degps", zoom_radps, sim::between(0, 3600),
              "rate at which the field of view narrows at full deflection of dive");
}

void DriveProfile::Joints::read(sim::ParamReader& in) {
  in.read("velocity", velocity, sim::between(0, 1000), "velocity of a joint at full deflection, rad/s or m/s");
}

void DriveProfile::Share::read(sim::ParamReader& in) {
  in.require("device");
  in.read_name("device", device, "device that is commanded");
  in.read_choice("part", part, drive_part_words,
                 "value: of an actuator commanded by one number; else a component of a wrench");
  const sim::Rule any_gain = sim::between(-1e9, 1e9);
  in.read("forward", forward, any_gain, "command at full deflection of forward, in the unit of the device");
  in.read("turn", turn, any_gain, "command at full deflection of turn");
  in.read("dive", dive, any_gain, "command at full deflection of dive");
  in.read("side", side, any_gain, "command at full deflection of side");
}

void DriveProfile::Craft::read(sim::ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "name of the row");
  in.require("devices");
  in.read_list("devices", shares, "device", "devices and their shares; they drive a vehicle that has them all");
  if (!in.describing() && in.has("devices") && shares.empty()) in.error("devices", "'devices' must name a device");
  check_size(in, "devices", shares.size());
}

void DriveProfile::Program::read(sim::ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "it takes shoal.twist_command_t on VEHICLE.NAME.cmd");
  in.require("devices");
  in.read("devices", devices, "devices that such a vehicle has");
  if (!in.describing() && in.has("devices") && devices.empty()) in.error("devices", "'devices' must name a device");
  in.read("tilts", tilts, "it takes shoal.inclination_t, the tilt of kind tilt, on the same channel");
}

void DriveProfile::read(sim::ParamReader& in) {
  in.read("rate_hz", rate_hz, sim::between(5, 100), "commands per second of wall time");
  in.read("hold_s", hold_s, sim::between(0.05, 0.2), "the vehicle stops this long after the last input of the driver");
  in.read("keys", keys, "keys of the terminal");
  in.read("gamepad", gamepad, "buttons and axes of a gamepad");
  in.read("twist", twist, "limits of kind twist");
  in.read("tilt", tilt, "limits of kind tilt");
  in.read("helm", helm, "limits of kind helm");
  in.read("thrust", thrust, "limits of kind thrust, of a drive that takes thrust and rudder");
  in.read("camera", camera, "limits of kind camera");
  in.read("joints", joints, "limits of kind joints");
  in.read_list("crafts", crafts, "craft", "thrusters and fins of crafts for kind thrust; the first that fits is used");
  in.read_list("programs", programs, "program", "programs that drive a vehicle by twist; the first that fits is used");
  check_size(in, "crafts", crafts.size());
  check_size(in, "programs", programs.size());
}

namespace {

/// Reads a profile from a tree in which there are no mistakes so far.
DriveProfile profile_in(const sim::ConfigNode& tree, sim::Diagnostics& diagnostics) {
  diagnostics.throw_if_any();
  DriveProfile profile;
  sim::ParamReader in(tree, "drive profile", diagnostics);
  profile.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return profile;
}

}  // namespace

DriveProfile parse_drive_profile(const std::string& text, const std::string& name) {
  sim::Diagnostics diagnostics;
  return profile_in(sim::parse_config_text(text, name, diagnostics), diagnostics);
}

DriveProfile read_drive_profile(const std::string& file) {
  if (file.empty()) return parse_drive_profile(std::string(default_drive_profile()), "the drive profile of shoal");
  sim::Diagnostics diagnostics;
  return profile_in(sim::load_config_file(file, diagnostics), diagnostics);
}

}  // namespace experiment
