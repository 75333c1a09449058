// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/motion_format.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>

#include "motion/formats/pose_table.hpp"
#include "sim/config/message_text.hpp"
#include "sim/motion/motion.hpp"

namespace motion {

const std::vector<MotionFormat>& motion_formats() {
  static const std::vector<MotionFormat> formats{
      csv_format(),          ros_format(),           play_motion2_format(), webots_format(), mtn_format(),
      open_r_table_format(), open_r_object_format(), mot_format(),          pos_format(),    opencat_format()};
  return formats;
}

std::vector<std::string> motion_format_names() {
  std::vector<std::string> names;
  for (const MotionFormat& format : motion_formats()) names.emplace_back(format.name);
  return names;
}

const MotionFormat* find_motion_format(std::string_view name) {
  for (const MotionFormat& format : motion_formats())
    if (format.name == name) return &format;
  return nullptr;
}

const MotionFormat* motion_format_of_file(const std::string& path, std::string_view bytes) {
  for (const MotionFormat& format : motion_formats())
    if (!format.head.empty() && bytes.starts_with(format.head)) return &format;
  for (const MotionFormat& format : motion_formats())
    for (const std::string& ending : format.endings)
      if (path.ends_with(ending)) return &format;
  return nullptr;
}

namespace {

sim::JointMotion without_lights(const sim::JointMotion& motion, Losses& losses) {
  const std::size_t count = motion.lights.size();
  losses.push_back("intensities of " + std::to_string(count) + (count == 1 ? " light" : " lights") + " are not kept");
  sim::JointMotion kept = motion;
  const auto is_light = [&](const auto& value) { return motion.is_light(value.first); };
  for (sim::MotionPose& pose : kept.poses) std::erase_if(pose.joints, is_light);
  for (sim::MotionKey& key : kept.keys) std::erase_if(key.joints, is_light);
  std::erase_if(kept.frames, [&](const sim::MotionTrack& track) { return motion.is_light(track.joint); });
  kept.lights.clear();
  return kept;
}

}  // namespace

std::vector<ExportedFile> files_of_motion(const MotionFormat& format, const sim::JointMotion& motion,
                                          const JointNames& names, const FormatOptions& options, Losses& losses) {
  if (format.write == nullptr && format.write_folder == nullptr)
    refuse_motion(motion, std::string("'") + format.name + "' files can only be read");
  std::optional<sim::JointMotion> unlit;
  if (!format.holds_lights && !motion.lights.empty()) unlit = without_lights(motion, losses);
  const sim::JointMotion& kept = unlit ? *unlit : motion;
  if (kept.tracks().empty()) refuse_motion(motion, "needs a joint");
  if (format.write_folder != nullptr) return format.write_folder(kept, names, options, losses);
  return {{"", format.write(kept, names, options, losses)}};
}

std::string bytes_of_motion(const MotionFormat& format, const sim::JointMotion& motion, const JointNames& names,
                            const FormatOptions& options, Losses& losses) {
  return files_of_motion(format, motion, names, options, losses).front().bytes;
}

sim::JointMotion motion_of_bytes(const MotionFormat& format, const MotionSource& source, Losses& losses) {
  if (format.read == nullptr)
    throw sim::ConfigError({source.file + ": '" + format.name + "' files can only be written"});
  sim::JointMotion motion = format.read(source, losses);
  if (motion.name.empty()) motion.name = motion_name(std::filesystem::path(source.file).stem().string());
  motion.vehicle = source.names.vehicle();
  if (source.options.loop_step_s > 0) {
    // A player of loops goes from the last pose to the first one in one step.
    sim::MotionKey last;
    last.at_s = motion.end_s() + source.options.loop_step_s;
    for (const sim::MotionTrack& track : motion.tracks())
      last.joints.emplace_back(track.joint, track.keys.front().value);
    motion.keys.push_back(std::move(last));
    motion.loop = true;
  }
  for (const sim::MotionTrack& track : motion.tracks()) {
    const NamedJoint* const joint = source.names.find(track.joint);
    if (joint != nullptr && joint->is_slider) motion.sliders.push_back(track.joint);
    if (joint != nullptr && joint->is_light) motion.lights.push_back(track.joint);
  }
  return motion;
}

void refuse_motion(const sim::JointMotion& motion, const std::string& text) {
  throw sim::ConfigError({"motion '" + motion.name + "': " + text});
}

void check_joint_name(std::string_view name, const sim::SourcePlace& place, const std::string& who) {
  if (const std::string error = sim::joint_name_error(name); !error.empty()) sim::throw_config_error(place, who, error);
}

std::string joint_called(const MotionSource& source, const char* list, const std::string& foreign,
                         const sim::SourcePlace& place) {
  check_joint_name(foreign, place);
  if (const auto joint = source.names.joint_of(list, foreign)) return *joint;
  const std::vector<std::string> known = source.names.foreign_names(list);
  sim::throw_config_error(place, "",
                          "joint '" + sim::shortened(sim::printable(foreign)) + "' is unknown to vehicle '" +
                              source.names.vehicle() + "'" + sim::did_you_mean(foreign, known) +
                              "; known: " + sim::list_text(known));
}

std::string motion_name(std::string_view text) {
  std::string name;
  for (const char c : text.substr(0, 60))
    name += std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' ? c : '_';
  return name.empty() ? "motion" : name;
}

void list_losses(const sim::JointMotion& motion, const Keeps& keeps, Losses& losses) {
  std::size_t notes = 0;
  for (const sim::MotionKey& key : motion.keys) notes += key.note.empty() ? 0 : 1;
  const auto counted = [](std::size_t count, const char* what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
  };
  if (!keeps.description && !motion.description.empty()) losses.push_back("the description is not kept");
  if (!motion.poses.empty())
    losses.push_back("names of " + counted(motion.poses.size(), "pose") + " are not kept; their values are");
  if (!keeps.notes && notes > 0) losses.push_back(counted(notes, "note") + " of keys are not kept");
  if (!keeps.loop && motion.loop)
    losses.push_back("one cycle of the loop is written: the player of the file repeats it");
  if (!motion.changes.empty())
    losses.push_back(counted(motion.changes.size(), "change") + " of the world are not kept");
  if (!motion.sounds.empty())
    losses.push_back(counted(motion.sounds.size(), "sound") + (motion.sounds.size() == 1 ? " is" : " are") +
                     " not kept");
  if (motion.recorded) losses.push_back("the place of the recording is not kept");
  // A start with default values is no loss.
  const sim::MotionStart usual;
  if (!keeps.start && (motion.start.max_velocity != usual.max_velocity || motion.start.min_s != usual.min_s))
    losses.push_back("'start' is not kept: the player chooses the way to the first pose");
}

}  // namespace motion
