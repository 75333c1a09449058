// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/joint_names.hpp"

#include <algorithm>
#include <set>

#include "sim/config/message_text.hpp"
#include "sim/motion/motion.hpp"

namespace motion {

void JointNameList::read(sim::ParamReader& in) {
  in.require("list");
  in.read_name("list", list, "name of the list, such as tekkotsu");
  in.read("design", design, "how these files name the robot");
  in.read("complete", complete, "a file has all these joints, in this order");
  in.require("joints");
  sim::ConfigNode map;
  in.read_raw("joints", map, "joint of the vehicle: its name in these files");
  // Names are translated in both directions, so two joints must not share one.
  std::set<std::string> foreign;
  for (const sim::ConfigNode::Entry& entry : map.entries) {
    const std::string& name = entry.value.scalar;
    if (entry.value.kind != sim::ConfigNode::Kind::scalar || name.empty() || !foreign.insert(name).second)
      in.diagnostics().error(
          entry.value.place, in.who(),
          "'" + entry.key + "' must be a name that no other joint has, got " + sim::shown(entry.value));
    names.emplace_back(entry.key, name);
  }
  if (names.size() > sim::max_motion_joints)
    in.error("joints", "'joints' must name at most " + std::to_string(sim::max_motion_joints) + " joints");
}

void JointNamesFile::read(sim::ParamReader& in) {
  int version = 1;
  in.require("shoal");
  in.read("shoal", version, sim::between(1, 1), "version of the file format");
  in.require("joint_names");
  in.read_name("joint_names", vehicle, "name of the vehicle model");
  in.read("description", description, "description in one sentence");
  in.read_list("lists", lists, "list", "names of the joints in files of other programs");
  for (const JointNameList& list : lists) in.declare("list", list.list);
}

JointNamesFile load_joint_names(const std::string& path) {
  sim::Diagnostics diagnostics;
  JointNamesFile file;
  const sim::ConfigNode root = sim::load_config_file(path, diagnostics);
  diagnostics.throw_if_any();
  sim::ParamReader in(root, "", diagnostics);
  file.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return file;
}

JointNames::JointNames(std::string vehicle, std::vector<NamedJoint> joints, std::vector<JointNameList> lists)
    : vehicle_(std::move(vehicle)), joints_(std::move(joints)), lists_(std::move(lists)) {}

const NamedJoint* JointNames::find(const std::string& name) const {
  for (const NamedJoint& joint : joints_)
    if (joint.servo == name || (!joint.alias.empty() && joint.alias == name)) return &joint;
  return nullptr;
}

const JointNameList* JointNames::find_list(const std::string& list) const {
  for (const JointNameList& one : lists_)
    if (one.list == list) return &one;
  return nullptr;
}

std::optional<std::string> JointNames::foreign_name(const std::string& list, bool uses_aliases,
                                                    const std::string& joint) const {
  // Without a vehicle names stay as they are.
  if (empty()) return joint;
  const NamedJoint* const found = find(joint);
  if (found == nullptr) {
    std::vector<std::string> known;
    for (const NamedJoint& one : joints_) known.push_back(one.servo);
    throw sim::ConfigError({"joint '" + sim::shortened(sim::printable(joint)) + "' is not a joint servo of vehicle '" +
                            vehicle_ + "'" + sim::did_you_mean(joint, known) + "; known: " + sim::list_text(known)});
  }
  if (const JointNameList* const names = find_list(list)) {
    for (const auto& [servo, foreign] : names->names)
      if (servo == found->servo) return foreign;
    return std::nullopt;
  }
  return uses_aliases && !found->alias.empty() ? found->alias : found->servo;
}

std::optional<std::string> JointNames::joint_of(const std::string& list, const std::string& foreign) const {
  if (empty()) return foreign;
  if (const JointNameList* const names = find_list(list))
    for (const auto& [servo, name] : names->names)
      if (name == foreign) return servo;
  if (const NamedJoint* const found = find(foreign)) return found->servo;
  return std::nullopt;
}

std::vector<std::string> JointNames::foreign_names(const std::string& list) const {
  std::vector<std::string> all;
  if (const JointNameList* const names = find_list(list))
    for (const auto& [servo, foreign] : names->names) all.push_back(foreign);
  else
    for (const NamedJoint& joint : joints_) all.push_back(joint.servo);
  return all;
}

}  // namespace motion
