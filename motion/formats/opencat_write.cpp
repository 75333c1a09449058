// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "motion/formats/opencat_format.hpp"
#include "motion/formats/pose_table.hpp"
#include "motion/formats/skill_array.hpp"
#include "sim/config/message_text.hpp"

namespace motion {

namespace {

constexpr int max_rows = 127;
constexpr int max_angle_deg = 254;
constexpr int max_delay = 127, max_speed = 127;
constexpr int first_of_gait = 8;

/// Returns the number of a joint from its name in the list, or joint_NUMBER.
int slot_of(const sim::JointMotion& motion, const std::string& foreign) {
  std::string digits = foreign.starts_with("joint_") ? foreign.substr(6) : foreign;
  const bool is_number = !digits.empty() && digits.size() <= 2 &&
                         std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c); });
  const int slot = is_number ? std::stoi(digits) : -1;
  if (slot < 0 || slot >= skill_joints)
    refuse_motion(motion,
                  "joint '" + sim::shortened(sim::printable(foreign)) +
                      "' has no number from 0 to 15 in OpenCat: needs a vehicle whose names of joints have the list "
                      "'opencat' (--vehicle, --names)");
  return slot;
}

/// Returns degrees that are a multiple of `ratio`.
int whole_degrees(double value, int ratio) {
  return static_cast<int>(std::lround(value / rad_per_deg / ratio)) * ratio;
}

/// Writer of one motion.
class SkillWriter {
 public:
  SkillWriter(const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options, Losses& losses)
      : motion_(motion), options_(options), losses_(losses) {
    const TableRules rules{.max_value = 10, .holds_sliders = false, .samples_easing = false};
    table_ = pose_table(motion, names, opencat_format(), rules, losses);
    for (const TableJoint& joint : table_.joints)
      slots_.push_back(static_cast<std::size_t>(slot_of(motion, joint.foreign)));
    tracks_ = motion.tracks();
    for (const std::vector<double>& row : table_.rows)
      for (std::size_t j = 0; j < row.size(); ++j) check_angle(table_.joints[j].joint, row[j]);
  }

  std::string write() {
    const SkillKind kind = options_.skill.value_or(motion_.end_s() <= 0 || options_.at_s ? SkillKind::posture
                                                   : motion_.loop                        ? SkillKind::gait
                                                                                         : SkillKind::behavior);
    list_losses(motion_, {.loop = kind == SkillKind::gait}, losses_);
    skill_.name = motion_name(options_.name.empty() ? motion_.name : options_.name);
    // The name becomes an identifier of C.
    std::replace(skill_.name.begin(), skill_.name.end(), '-', '_');
    if (std::isdigit(static_cast<unsigned char>(skill_.name[0]))) skill_.name.insert(0, "_");
    list_unused_joints();
    switch (kind) {
      case SkillKind::posture:
        make_posture();
        break;
      case SkillKind::gait:
        make_gait();
        break;
      case SkillKind::behavior:
        make_behavior();
        break;
    }
    list_rounding();
    return skill_text(skill_);
  }

 private:
  /// Angles above 127 degrees are written as half of them.
  void check_angle(const std::string& joint, double value) {
    const double degrees = value / rad_per_deg;
    if (std::abs(degrees) > max_angle_deg)
      refuse_motion(motion_,
                    "joint '" + joint + "': must be from -254 to 254 degrees, got " + sim::number_text(degrees));
    if (std::abs(whole_degrees(value, 1)) > 127) ratio_ = 2;
  }

  SkillRow row_of(const std::vector<double>& values) const {
    SkillRow row;
    for (std::size_t j = 0; j < slots_.size(); ++j) row.angles_deg[slots_[j]] = whole_degrees(values[j], ratio_);
    return row;
  }

  std::vector<double> values_at(double t_s) const {
    std::vector<double> values;
    for (const TableJoint& joint : table_.joints)
      for (const sim::MotionTrack& track : tracks_)
        if (track.joint == joint.joint) values.push_back(track.value_at(t_s));
    return values;
  }

  void list_unused_joints() {
    std::vector<std::string> absent;
    for (std::size_t slot = 0; slot < skill_joints; ++slot)
      if (std::find(slots_.begin(), slots_.end(), slot) == slots_.end()) absent.push_back(std::to_string(slot));
    if (!absent.empty()) losses_.push_back("joints that the motion does not name are at 0: " + sim::list_text(absent));
  }

  void list_rounding() {
    losses_.push_back(ratio_ == 2 ? "angles are rounded to even degrees, because one is above 127"
                                  : "angles are rounded to whole degrees");
  }

  void make_posture() {
    const double at_s = options_.at_s.value_or(0);
    if ((!options_.at_s && motion_.end_s() > 0) || at_s < 0 || at_s > motion_.end_s())
      refuse_motion(motion_, "a posture holds one instant from 0 to " + sim::number_text(motion_.end_s()) +
                                 " s: choose it (--at)");
    if (motion_.end_s() > 0) losses_.push_back("only the pose at " + sim::number_text(at_s) + " s is kept");
    skill_.period = 1;
    skill_.rows.push_back(row_of(values_at(at_s)));
  }

  void make_gait() {
    const double rows = std::round(motion_.end_s() / options_.row_s);
    if (rows < 2 || rows > max_rows)
      refuse_motion(motion_, "a gait must have 2 to 127 rows of " + sim::number_text(options_.row_s * 1000) +
                                 " ms (--row-ms), got " + sim::number_text(rows));
    if (std::abs(rows * options_.row_s - motion_.end_s()) > 1e-6)
      losses_.push_back("the gait lasts " + sim::number_text(rows * options_.row_s) + " s instead of " +
                        sim::number_text(motion_.end_s()) + " s");
    skill_.period = static_cast<int>(rows);
    skill_.first_joint = first_of_gait;
    // At equal shares of the cycle, so that the loop closes although rows have a fixed duration.
    for (double k = 0; k < rows; ++k) skill_.rows.push_back(row_of(values_at(k * motion_.end_s() / rows)));
    std::vector<std::string> left_out;
    for (std::size_t j = 0; j < slots_.size(); ++j)
      if (slots_[j] < first_of_gait) left_out.push_back(table_.joints[j].joint);
    for (SkillRow& row : skill_.rows) std::fill_n(row.angles_deg.begin(), first_of_gait, 0);
    if (!left_out.empty())
      losses_.push_back("a gait has only joints 8 to 15: left out are " + sim::list_text(left_out));
  }

  void make_behavior() {
    double written_s = 0;
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
      SkillRow row = row_of(table_.rows[i]);
      if (i == 0) {
        skill_.rows.push_back(row);
        continue;
      }
      const double duration_s = table_.times_s[i] - table_.times_s[i - 1];
      const int distance = distance_between(skill_.rows.back(), row);
      written_s += distance == 0 ? wait(duration_s, row) : move(duration_s, distance, row);
      if (skill_.rows.size() > max_rows) refuse_motion(motion_, "a behavior must have at most 127 rows");
    }
    // A negative number of rows marks a behavior.
    skill_.period = -static_cast<int>(skill_.rows.size());
    if (std::abs(written_s - motion_.end_s()) > 1e-6)
      losses_.push_back("the behavior lasts " + sim::number_text(written_s) + " s instead of " +
                        sim::number_text(motion_.end_s()) + " s, with steps of " +
                        sim::number_text(options_.row_s * 1000) + " ms (--row-ms)");
    for (const sim::MotionTrack& track : tracks_)
      for (std::size_t i = 1; i < track.keys.size(); ++i)
        if (track.keys[i].ease != sim::Easing::cosine && track.keys[i].value != track.keys[i - 1].value) {
          losses_.push_back("between rows all joints move on a cosine");
          return;
        }
  }

  static int distance_between(const SkillRow& from, const SkillRow& to) {
    int distance = 0;
    for (std::size_t j = 0; j < skill_joints; ++j)
      distance = std::max(distance, std::abs(to.angles_deg[j] - from.angles_deg[j]));
    return distance;
  }

  /// Adds a time without motion; returns how long it is.
  double wait(double duration_s, const SkillRow& row) {
    const int delay = static_cast<int>(std::lround(std::min(duration_s / skill_delay_s, 1e6)));
    int left = delay;
    while (left > 0) {
      SkillRow& last = skill_.rows.back();
      const int taken = std::min(left, max_delay - last.delay);
      last.delay += taken;
      left -= taken;
      if (left > 0) skill_.rows.push_back(row);
      if (skill_.rows.size() > max_rows) refuse_motion(motion_, "a behavior must have at most 127 rows");
    }
    return delay * skill_delay_s;
  }

  double move(double duration_s, int distance_deg, SkillRow row) {
    const double steps = std::max(1.0, duration_s / options_.row_s);
    row.speed = static_cast<int>(std::clamp(std::round(4 * distance_deg / steps), 1.0, double{max_speed}));
    skill_.rows.push_back(row);
    return std::max(1.0, std::round(4.0 * distance_deg / row.speed)) * options_.row_s;
  }

  const sim::JointMotion& motion_;
  const FormatOptions& options_;
  Losses& losses_;
  PoseTable table_;
  std::vector<std::size_t> slots_;  ///< of each joint of the table
  std::vector<sim::MotionTrack> tracks_;
  SkillArray skill_;
  int ratio_ = 1;
};

}  // namespace

std::string write_opencat(const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options,
                          Losses& losses) {
  return SkillWriter(motion, names, options, losses).write();
}

}  // namespace motion
