// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "motion/formats/pose_table.hpp"
#include "motion/formats/tekkotsu_outputs.hpp"
#include "sim/config/message_text.hpp"

// Each output has its own keys, linear between them.  At the start the keys at 0 take the values that the robot has
// then: so the way to the first keys after 0 is the approach, and what Shoal calls time 0 is their time.

namespace motion {

namespace {

constexpr double ms_of_tekkotsu = 0.001;
constexpr double max_approach_s = 600;

std::string value_line(const sim::JointMotion& motion, const std::string& name, double value, const char* weight) {
  if (name.size() > max_tekkotsu_name || name.find_first_of(" \t\r\n#") != std::string::npos || name.empty())
    refuse_motion(motion,
                  "joint '" + sim::printable(name) + "' must be a word of at most 63 bytes in a file of Tekkotsu");
  return fmt::format("{}\t{:.6f}{}\n", name, value, weight);
}

std::string write_mot(const sim::JointMotion& motion, const JointNames& names, const FormatOptions&, Losses& losses) {
  list_losses(motion, {.start = true}, losses);
  if (motion.start.max_velocity != sim::MotionStart{}.max_velocity)
    losses.push_back("'start: max_velocity' is not kept: the way to the first pose takes 'min_s'");
  const PoseTable table = pose_table(motion, names, mot_format(), {.tick_s = ms_of_tekkotsu}, losses);
  const std::vector<sim::MotionTrack> tracks = table.tracks();
  const auto approach_ms = std::max(1LL, std::llround(motion.start.min_s / ms_of_tekkotsu));
  std::string text = "#MSq\nradians\nsetTime\t" + std::to_string(approach_ms) + "\n";
  // An output needs a key only where its path bends, at the start and at the end.
  double before_s = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    std::string values;
    for (std::size_t j = 0; j < tracks.size(); ++j) {
      const std::vector<sim::TrackKey>& keys = tracks[j].keys;
      const bool is_inner = i > 0 && i + 1 < keys.size();
      if (is_inner && keys[i].value == keys[i - 1].value && keys[i].value == keys[i + 1].value) continue;
      values += value_line(motion, table.joints[j].foreign, keys[i].value, "");
    }
    if (values.empty()) continue;
    const long long step_ms = std::llround((table.times_s[i] - before_s) / ms_of_tekkotsu);
    if (step_ms > 0) text += "advanceTime\t" + std::to_string(step_ms) + "\n";
    before_s = table.times_s[i];
    text += values;
  }
  return text + "#END\n";
}

/// Returns the keys of outputs as a motion that starts at the first key after `least_ms`.
sim::JointMotion motion_of_keys(const MotionSource& source, const TekkotsuKeys& keys, std::int64_t least_ms,
                                Losses& losses) {
  std::int64_t start_ms = -1;
  bool has_early = false, has_released = false, has_late = false;
  for (const auto& [joint, values] : keys.by_joint)
    for (const auto& [time_ms, value] : values) {
      has_early = has_early || time_ms < least_ms;
      has_released = has_released || value.weight <= 0;
      if (time_ms >= least_ms && value.weight > 0 && (start_ms < 0 || time_ms < start_ms)) start_ms = time_ms;
    }
  if (start_ms < 0)
    sim::throw_config_error({sim::intern_file_name(source.file), 0, 0}, "",
                            least_ms > 0 ? "needs the value of an output of the vehicle after time 0"
                                         : "needs the value of an output of the vehicle");
  std::map<std::int64_t, sim::JointValues> by_time;
  for (const std::string& joint : keys.order) {
    bool is_first = true;
    for (const auto& [time_ms, value] : keys.by_joint.at(joint)) {
      if (time_ms < least_ms || value.weight <= 0) continue;
      has_late = has_late || (is_first && time_ms > start_ms);
      is_first = false;
      by_time[time_ms].emplace_back(joint, value.value);
    }
  }
  sim::JointMotion motion;
  motion.angles = sim::AngleUnit::rad;
  motion.start.min_s = std::min(static_cast<double>(start_ms) / 1000, max_approach_s);
  for (auto& [time_ms, values] : by_time) {
    sim::MotionKey& key = motion.keys.emplace_back();
    key.at_s = static_cast<double>(time_ms - start_ms) / 1000;
    key.joints = std::move(values);
  }
  if (source.names.empty())
    for (const std::string& joint : keys.order)
      if (joint.starts_with("LED:")) motion.lights.push_back(joint);
  if (has_early) losses.push_back("keys at time 0 are left out: Tekkotsu replaces them by the values at the start");
  if (has_released) losses.push_back("keys of weight 0 are left out: the joint holds its last value");
  if (has_late)
    losses.push_back("joints whose first key is after " + sim::number_text(motion.start.min_s) +
                     " s are there from the start on, and do not move there from their values at the start");
  return motion;
}

sim::JointMotion read_mot(const MotionSource& source, Losses& losses) {
  TekkotsuOutputs outputs(source, losses);
  TekkotsuKeys keys;
  read_tekkotsu(source, 0, 0, outputs, keys, losses);
  outputs.list_unknown();
  return motion_of_keys(source, keys, 1, losses);
}

std::string write_pos(const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options,
                      Losses& losses) {
  if (!options.at_s && motion.end_s() > 0)
    refuse_motion(motion,
                  "a posture holds one instant of " + sim::number_text(motion.end_s()) + " s: choose it (--at)");
  const double at_s = options.at_s.value_or(0);
  if (at_s < 0 || at_s > motion.end_s())
    refuse_motion(motion, "the instant must be from 0 to " + sim::number_text(motion.end_s()) + " s, got " +
                              sim::number_text(at_s));
  // A single pose has no loop to lose.
  list_losses(motion, {.loop = true}, losses);
  if (motion.end_s() > 0) losses.push_back("only the pose at " + sim::number_text(at_s) + " s is kept");
  sim::JointMotion pose;
  pose.name = motion.name;
  pose.sliders = motion.sliders;
  pose.lights = motion.lights;
  sim::MotionKey& key = pose.keys.emplace_back();
  for (const sim::MotionTrack& track : motion.tracks()) key.joints.emplace_back(track.joint, track.value_at(at_s));
  const PoseTable table = pose_table(pose, names, pos_format(), {}, losses);
  std::string text = "#POS\n";
  for (std::size_t j = 0; j < table.joints.size(); ++j)
    text += value_line(motion, table.joints[j].foreign, table.rows[0][j], "\t1");
  return text + "#END\n";
}

sim::JointMotion read_pos(const MotionSource& source, Losses& losses) {
  TekkotsuOutputs outputs(source, losses);
  TekkotsuKeys keys;
  read_tekkotsu(source, 0, 0, outputs, keys, losses);
  outputs.list_unknown();
  sim::JointMotion motion = motion_of_keys(source, keys, 0, losses);
  motion.start = {};
  return motion;
}

}  // namespace

MotionFormat mot_format() {
  return {.name = "mot",
          .meaning = "motion sequence of Tekkotsu",
          .endings = {".mot"},
          .head = "#MSq",
          .list = "tekkotsu",
          .uses_aliases = false,
          .holds_lights = true,
          .write = write_mot,
          .read = read_mot};
}

MotionFormat pos_format() {
  return {.name = "pos",
          .meaning = "posture of Tekkotsu",
          .endings = {".pos"},
          .head = "#POS",
          .list = "tekkotsu",
          .uses_aliases = false,
          .holds_lights = true,
          .write = write_pos,
          .read = read_pos};
}

}  // namespace motion
