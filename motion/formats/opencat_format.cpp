// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/opencat_format.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/formats/pose_table.hpp"
#include "motion/formats/skill_array.hpp"
#include "sim/config/message_text.hpp"

namespace motion {

namespace {

constexpr int max_unrolled_rows = 20'000;

std::string joint_of_slot(const MotionSource& source, int slot) {
  if (source.names.empty()) return "joint_" + std::to_string(slot);
  if (source.names.find_list("opencat") == nullptr)
    throw sim::ConfigError({source.file + ": the names of joints of vehicle '" + source.names.vehicle() +
                            "' must have the list 'opencat' (--names)"});
  return source.names.joint_of("opencat", std::to_string(slot)).value_or("");
}

/// Reader of one skill.
class SkillMotion {
 public:
  SkillMotion(const MotionSource& source, Losses& losses)
      : source_(source), losses_(losses), skill_(parse_skill(source.bytes, source.file, source.options.name)) {}

  sim::JointMotion read() {
    choose_joints();
    motion_.angles = sim::AngleUnit::rad;
    if (!skill_.name.empty()) motion_.name = motion_name(skill_.name);
    if (skill_.period == 1)
      add_key(0, skill_.rows[0], sim::Easing::linear);
    else if (skill_.period > 1)
      read_gait();
    else
      read_behavior();
    if (skill_.roll_deg != 0 || skill_.pitch_deg != 0) losses_.push_back("the expected roll and pitch are not kept");
    if (skill_.period != 1)
      losses_.push_back("how long a row or step takes is not in the file: " +
                        sim::number_text(source_.options.row_s * 1000) + " ms are assumed (--row-ms)");
    return std::move(motion_);
  }

 private:
  void choose_joints() {
    std::vector<std::string> unknown;
    for (int slot = skill_.first_joint; slot < skill_joints; ++slot) {
      const std::string joint = joint_of_slot(source_, slot);
      if (!joint.empty()) joints_.emplace_back(static_cast<std::size_t>(slot), joint);
      // Arrays list 16 joints, whatever the robot has; zeros of missing ones are not a loss.
      const bool is_used = std::any_of(skill_.rows.begin(), skill_.rows.end(), [&](const SkillRow& row) {
        return row.angles_deg[static_cast<std::size_t>(slot)] != 0;
      });
      if (joint.empty() && is_used) unknown.push_back(std::to_string(slot));
    }
    if (joints_.empty()) throw sim::ConfigError({source_.file + ": the vehicle has none of the joints of the skill"});
    if (!unknown.empty())
      losses_.push_back("joints that the vehicle does not have are left out: " + sim::list_text(unknown));
  }

  void add_key(double at_s, const SkillRow& row, sim::Easing ease) {
    sim::MotionKey& key = motion_.keys.emplace_back();
    key.at_s = std::round(at_s * 1e6) / 1e6;
    if (ease != sim::Easing::linear) key.ease = ease;
    for (const auto& [slot, joint] : joints_) key.joints.emplace_back(joint, row.angles_deg[slot] * rad_per_deg);
  }

  void read_gait() {
    motion_.loop = true;
    for (std::size_t i = 0; i <= skill_.rows.size(); ++i)
      add_key(static_cast<double>(i) * source_.options.row_s, skill_.rows[i % skill_.rows.size()], sim::Easing::linear);
  }

  /// Rows in the order in which they are played.
  std::vector<const SkillRow*> played_rows() {
    std::vector<const SkillRow*> rows;
    int repeats = skill_.loop_count >= 0 && skill_.loop_count < 2 ? 0 : skill_.loop_count - 1;
    if (repeats < 0) {
      losses_.push_back("the endless loop of the behavior is written once");
      repeats = 0;
    } else if (repeats > 0) {
      losses_.push_back("the loop of the behavior is written " + std::to_string(repeats + 1) + " times");
    }
    for (int i = 0; i < static_cast<int>(skill_.rows.size()); ++i) {
      if (rows.size() == max_unrolled_rows) throw sim::ConfigError({source_.file + ": the behavior has too many rows"});
      rows.push_back(&skill_.rows[static_cast<std::size_t>(i)]);
      if (repeats > 0 && i != 0 && i == skill_.loop_last) {
        i = skill_.loop_first - 1;
        --repeats;
      }
    }
    return rows;
  }

  void read_behavior() {
    double at_s = 0;
    bool has_trigger = false;
    const SkillRow* before = nullptr;
    for (const SkillRow* row : played_rows()) {
      // Such a row waits for an angle of the IMU, which a motion with fixed times cannot express.
      has_trigger = has_trigger || row->trigger_axis != 0;
      int distance = 0;
      for (std::size_t j = 0; before != nullptr && j < skill_joints; ++j)
        distance = std::max(distance, std::abs(row->angles_deg[j] - before->angles_deg[j]));
      const double steps = row->speed > 0 ? std::max(1.0, std::round(4.0 * distance / row->speed)) : 1.0;
      if (distance > 0) at_s += steps * source_.options.row_s;
      if (distance > 0 || before == nullptr)
        add_key(at_s, *row, before == nullptr ? sim::Easing::linear : sim::Easing::cosine);
      if (row->delay > 0) {
        at_s += row->delay * skill_delay_s;
        add_key(at_s, *row, sim::Easing::linear);
      }
      if (at_s > sim::max_motion_s) throw sim::ConfigError({source_.file + ": the behavior must last at most 86400 s"});
      before = row;
    }
    if (has_trigger) losses_.push_back("rows do not wait for their trigger angle");
  }

  const MotionSource& source_;
  Losses& losses_;
  SkillArray skill_;
  sim::JointMotion motion_;
  std::vector<std::pair<std::size_t, std::string>> joints_;
};

}  // namespace

sim::JointMotion read_opencat(const MotionSource& source, Losses& losses) {
  return SkillMotion(source, losses).read();
}

MotionFormat opencat_format() {
  return {.name = "opencat",
          .meaning = "skill array of OpenCat (Petoi)",
          .endings = {".skill"},
          .head = "",
          .list = "opencat",
          .uses_aliases = false,
          .write = write_opencat,
          .read = read_opencat};
}

}  // namespace motion
