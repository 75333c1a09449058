// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "motion/formats/mtn_file.hpp"
#include "motion/formats/pose_table.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"

// A segment with n frames between its keys lasts (n + 1) * 16 ms.  Sony's player sends 2n + 2 frames of 8 ms in it, the
// first of which is the key itself; the step between two is the difference divided by 2n + 2 as integers, and the last
// key of the file is never sent.

namespace motion {

namespace {

constexpr double microradian = 1e-6;
constexpr double max_angle = 2147;  // 2^31 of them
constexpr std::size_t max_keys = 65535;
constexpr std::size_t max_name = 127, max_design = 31, max_text = 255;  // of Sony's player, and of the format

/// Attitude of the body in the note of a key.
std::string note_of(const MtnKey& key) {
  if (key.roll == 0 && key.pitch == 0 && key.yaw == 0) return "";
  return "body roll " + std::to_string(key.roll) + " pitch " + std::to_string(key.pitch) + " yaw " +
         std::to_string(key.yaw) + " (1e-6 rad)";
}

bool read_note(const std::string& note, MtnKey& key) {
  constexpr std::size_t max_note = 100;
  long long roll = 0, pitch = 0, yaw = 0;
  int end = 0;
  // The attitude of the body that MTN keeps is not part of a motion; it travels in the note of a key.
  const bool is_attitude =
      note.size() <= max_note && std::sscanf(note.c_str(), "body roll %12lld pitch %12lld yaw %12lld (1e-6 rad)%n",
                                             &roll, &pitch, &yaw, &end) == 3;
  if (!is_attitude || static_cast<std::size_t>(end) != note.size()) return false;
  for (const long long angle : {roll, pitch, yaw})
    if (angle < std::numeric_limits<std::int32_t>::min() || angle > std::numeric_limits<std::int32_t>::max())
      return false;
  key.roll = static_cast<std::int32_t>(roll);
  key.pitch = static_cast<std::int32_t>(pitch);
  key.yaw = static_cast<std::int32_t>(yaw);
  return true;
}

std::string limited(const sim::JointMotion& motion, const std::string& text, std::size_t max, const char* what) {
  if (text.size() > max)
    refuse_motion(motion, std::string(what) + " must have at most " + std::to_string(max) + " bytes, got '" +
                              sim::shortened(sim::printable(text)) + "'");
  return text;
}

std::string write_mtn(const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options,
                      Losses& losses) {
  list_losses(motion, {.notes = true}, losses);
  const TableRules rules{
      .tick_s = mtn_frame_s, .max_rows = max_keys, .max_value = max_angle, .holds_sliders = false, .keeps_notes = true};
  const PoseTable table = pose_table(motion, names, mtn_format(), rules, losses);
  MtnFile file;
  const JointNameList* const list = names.find_list("open-r");
  file.name = limited(motion, options.name.empty() ? motion.name : options.name, max_name, "the name");
  file.creator = limited(motion, options.creator, max_text, "the creator");
  file.design = limited(motion, !options.design.empty() || list == nullptr ? options.design : list->design, max_design,
                        "the design label");
  for (const TableJoint& joint : table.joints)
    file.locators.push_back(limited(motion, joint.foreign, max_text, "the locator of a joint"));
  std::size_t notes = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    MtnKey& key = file.keys.emplace_back();
    if (i > 0) {
      const double frames = std::round((table.times_s[i] - table.times_s[i - 1]) / mtn_frame_s);
      key.between = static_cast<std::int32_t>(frames) - 1;
    }
    for (const double value : table.rows[i])
      key.joints.push_back(static_cast<std::int32_t>(std::lround(value / microradian)));
    if (!table.notes[i].empty() && !read_note(table.notes[i], key)) ++notes;
  }
  if (notes > 0) losses.push_back(std::to_string(notes) + " notes of keys are not kept");
  return mtn_bytes(file);
}

sim::JointMotion read_mtn(const MotionSource& source, Losses& losses) {
  const MtnFile file = parse_mtn(source.bytes, source.file);
  const sim::SourcePlace place{sim::intern_file_name(source.file), 0, 0};
  sim::JointMotion motion;
  motion.angles = sim::AngleUnit::rad;
  motion.name = motion_name(file.name);
  if (motion.name != file.name)
    losses.push_back("the name '" + sim::shortened(sim::printable(sim::in_utf8(file.name))) + "' becomes '" +
                     motion.name + "'");
  motion.description = sim::printable(sim::in_utf8("MTN file of " + file.creator + " for " + file.design));
  std::vector<std::string> joints;
  for (const std::string& locator : file.locators) {
    check_joint_name(locator, place, "section 2: joint " + std::to_string(joints.size() + 1));
    joints.push_back(joint_called(source, "open-r", locator, place));
    if (std::count(joints.begin(), joints.end(), joints.back()) > 1)
      sim::throw_config_error(
          place, "", "section 2 must name each joint once, got '" + sim::shortened(sim::printable(locator)) + "'");
  }
  std::int64_t frames = 0;
  for (std::size_t i = 0; i < file.keys.size(); ++i) {
    const MtnKey& from = file.keys[i];
    if (i > 0) frames += from.between + std::int64_t{1};
    sim::MotionKey& key = motion.keys.emplace_back();
    key.at_s = static_cast<double>(frames * 16) / 1000;
    key.note = note_of(from);
    for (std::size_t j = 0; j < joints.size(); ++j)
      key.joints.emplace_back(joints[j], static_cast<double>(from.joints[j]) / 1e6);
  }
  return motion;
}

}  // namespace

MotionFormat mtn_format() {
  return {.name = "mtn",
          .meaning = "motion of Sony's OPEN-R sample player",
          .endings = {".mtn", ".MTN"},
          .head = "OMTN",
          .list = "open-r",
          .uses_aliases = true,
          .write = write_mtn,
          .read = read_mtn};
}

}  // namespace motion
