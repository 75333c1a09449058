// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/motion_parts.hpp"

#include <cctype>

#include "sim/config/message_text.hpp"
#include "sim/motion/motion.hpp"

namespace motion {

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
