// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "motion/formats/pose_table.hpp"
#include "motion/formats/yaml_text.hpp"
#include "sim/config/message_text.hpp"

// The time of the first pose is the least time of the approach to it; if the approach takes longer, all later times
// move with it.  So the first pose is at the time `start: min_s` of the motion.

namespace motion {

namespace {

struct PalMotion {
  std::vector<std::string> joints;
  std::vector<double> positions, times_s;
  sim::ConfigNode meta;
  sim::SourcePlace place;
  void read(sim::ParamReader& in) {
    if (in.node() != nullptr) place = in.node()->place;
    in.require("joints");
    in.read("joints", joints, "names of joints");
    in.require("positions");
    in.read("positions", positions, sim::between(-1e6, 1e6), "rad or m, all joints of a pose, then those of the next");
    in.require("times_from_start");
    in.read("times_from_start", times_s, sim::between(0, sim::max_motion_s), "s, of each pose");
    in.read_raw("meta", meta, "name, usage, description");
  }
};

constexpr std::size_t values_in_line = 8;

std::string write_play_motion2(const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options,
                               Losses& losses) {
  list_losses(motion, {.start = true, .description = true}, losses);
  if (motion.start.max_velocity != sim::MotionStart{}.max_velocity)
    losses.push_back("'start: max_velocity' is not kept: approach_velocity of play_motion2 holds for all motions");
  const PoseTable table = pose_table(motion, names, play_motion2_format(), {}, losses);
  const std::string name = motion_name(options.name.empty() ? motion.name : options.name);
  const std::string inset(8, ' ');
  std::string text = "play_motion2:\n  ros__parameters:\n    motions:\n      " + yaml_word(name) + ":\n";
  const auto add_list = [&](const char* key, const std::vector<std::string>& words) {
    text += inset + key + ": [";
    for (std::size_t i = 0; i < words.size(); ++i)
      text += (i == 0 ? "" : i % values_in_line == 0 ? ",\n" + inset + "  " : ", ") + words[i];
    text += "]\n";
  };
  std::vector<std::string> joints, positions, times;
  for (const TableJoint& joint : table.joints) joints.push_back(yaml_word(joint.foreign));
  for (const std::vector<double>& row : table.rows)
    for (const double value : row) positions.push_back(yaml_double(value));
  // The approach to the first pose counts as part of the motion.
  for (const double t_s : table.times_s) times.push_back(yaml_double(motion.start.min_s + t_s));
  add_list("joints", joints);
  add_list("positions", positions);
  add_list("times_from_start", times);
  return text + inset + "meta: {name: " + yaml_word(name) +
         ", usage: shoal, description: " + yaml_word(motion.description.empty() ? name : motion.description) + "}\n";
}

/// Returns the map of motions of a file: NODE: ros__parameters: motions, with or without the outer keys.
const sim::ConfigNode& motions_of(const sim::ConfigNode& root) {
  const sim::ConfigNode* node = &root;
  for (int depth = 0; depth < 3; ++depth) {
    if (node->kind != sim::ConfigNode::Kind::map) break;
    const sim::ConfigNode* inner = node->find("motions");
    if (inner != nullptr && inner->kind == sim::ConfigNode::Kind::map) return *inner;
    if (inner == nullptr) inner = node->find("ros__parameters");
    if (inner == nullptr && node->entries.size() == 1) inner = &node->entries[0].value;
    if (inner == nullptr) break;
    node = inner;
  }
  sim::throw_config_error(root.place, "", "needs the map 'motions', below 'NODE: ros__parameters:'");
}

const sim::ConfigNode::Entry& chosen_motion(const sim::ConfigNode& motions, const std::string& name) {
  std::vector<std::string> known;
  for (const sim::ConfigNode::Entry& entry : motions.entries) {
    if (entry.key == name || (name.empty() && motions.entries.size() == 1)) return entry;
    known.push_back(entry.key);
  }
  if (name.empty())
    sim::throw_config_error(motions.place, "", "has several motions: choose one (--name) of " + sim::list_text(known));
  sim::throw_config_error(motions.place, "",
                          "there is no motion '" + sim::shortened(sim::printable(name)) + "'" +
                              sim::did_you_mean(name, known) + "; known: " + sim::list_text(known));
}

void check(const PalMotion& file, sim::Diagnostics& diagnostics) {
  const std::size_t joints = file.joints.size(), poses = file.times_s.size();
  if (joints == 0 || joints > sim::max_motion_joints)
    diagnostics.error(file.place, "", "'joints' must have 1 to 200 names, got " + std::to_string(joints));
  if (poses == 0) diagnostics.error(file.place, "", "'times_from_start' must have a time");
  if (file.positions.size() != joints * poses)
    diagnostics.error(file.place, "",
                      "'positions' must have " + std::to_string(joints) + " x " + std::to_string(poses) +
                          " values, for each joint and time, got " + std::to_string(file.positions.size()));
  for (std::size_t i = 1; i < poses; ++i)
    if (!(file.times_s[i] > file.times_s[i - 1])) {
      diagnostics.error(file.place, "",
                        "'times_from_start' must increase: " + sim::number_text(file.times_s[i]) + " comes after " +
                            sim::number_text(file.times_s[i - 1]));
      return;
    }
}

sim::JointMotion read_play_motion2(const MotionSource& source, Losses& losses) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode root = parse_yaml_document(source, diagnostics);
  const sim::ConfigNode::Entry& chosen = chosen_motion(motions_of(root), source.options.name);
  PalMotion file;
  if (chosen.value.kind != sim::ConfigNode::Kind::map)
    sim::throw_config_error(chosen.place, "",
                            "motion '" + sim::shortened(sim::printable(chosen.key)) + "' must be a map");
  sim::ParamReader in(chosen.value, "motion '" + sim::shortened(sim::printable(chosen.key)) + "'", diagnostics);
  file.read(in);
  in.finish();
  diagnostics.throw_if_any();
  check(file, diagnostics);
  diagnostics.throw_if_any();
  const std::vector<std::string> joints = joints_called(source, "play_motion2", file.joints, file.place);
  sim::JointMotion motion;
  motion.angles = sim::AngleUnit::rad;
  motion.name = motion_name(chosen.key);
  if (const sim::ConfigNode* text = file.meta.find("description");
      text != nullptr && text->kind == sim::ConfigNode::Kind::scalar && text->scalar != chosen.key)
    motion.description = text->scalar;
  constexpr double max_approach_s = 600;
  motion.start.min_s = std::min(file.times_s[0], max_approach_s);
  for (std::size_t i = 0; i < file.times_s.size(); ++i) {
    sim::MotionKey& key = motion.keys.emplace_back();
    // Decimal times: without the rounding of the difference.
    key.at_s = std::round((file.times_s[i] - file.times_s[0]) * 1e9) / 1e9;
    if (i > 0 && !(key.at_s > motion.keys[i - 1].at_s))
      sim::throw_config_error(file.place, "", "'times_from_start' must increase by at least 1e-9 s");
    for (std::size_t j = 0; j < joints.size(); ++j)
      key.joints.emplace_back(joints[j], file.positions[i * joints.size() + j]);
  }
  const sim::ConfigNode* const usage = file.meta.find("usage");
  if (usage != nullptr && usage->scalar != "shoal") losses.push_back("'meta: usage' is not kept");
  return motion;
}

}  // namespace

MotionFormat play_motion2_format() {
  return {.name = "play_motion2",
          .meaning = "motion of PAL's play_motion2 as YAML",
          .endings = {".play_motion2.yaml"},
          .head = "play_motion2:",
          .list = "play_motion2",
          .uses_aliases = false,
          .write = write_play_motion2,
          .read = read_play_motion2};
}

}  // namespace motion
