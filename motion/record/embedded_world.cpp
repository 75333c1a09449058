// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/embedded_world.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "motion/analysis/motion_file.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world_file/data_files.hpp"

namespace motion {

namespace {

using sim::ConfigNode;

/// Puts the motions of players in place of their files.
void insert_motions(ConfigNode& node) {
  for (ConfigNode& item : node.items) insert_motions(item);
  for (ConfigNode::Entry& entry : node.entries) {
    const bool is_list = entry.key == "motions" || entry.key.ends_with(".motions");
    for (ConfigNode& item : entry.value.items)
      if (const ConfigNode* file = is_list ? item.find("file") : nullptr)
        item = node_of(sim::load_motion(file->scalar));
    insert_motions(entry.value);
  }
}

/// Calls `found` for names of files that hold a parameter, such as ${part}.obj.
template <typename Found>
void visit_composed_names(const ConfigNode& node, const std::string& key,
                          const std::set<std::pair<std::string, std::string>>& keys, const Found& found) {
  for (const ConfigNode& item : node.items) visit_composed_names(item, key, keys, found);
  for (const ConfigNode::Entry& entry : node.entries) {
    const std::string& text = entry.value.scalar;
    const bool is_whole = text.starts_with("${") && text.find('}') + 1 == text.size();
    if (keys.contains({key, entry.key}) && text.find("${") != std::string::npos && !is_whole) found(text);
    visit_composed_names(entry.value, entry.key, keys, found);
  }
}

/// Throws sim::ConfigError when a world needs more than what stands in it.  `who`: in messages.
void check_complete(ConfigNode world, const std::string& who) {
  const auto refuse = [&](const std::string& what) {
    throw sim::ConfigError({who + " " + what + ": a world in a take has no other files and no programs"});
  };
  if (world.kind != ConfigNode::Kind::map) throw sim::ConfigError({who + " must be a map, the keys of a world file"});
  for (const char* key : {"include", "plugins", "processes", "bridges"})
    if (world.find(key) != nullptr) refuse("has the key '" + std::string(key) + "'");
  if (const ConfigNode* vehicles = world.find("vehicles"))
    for (const ConfigNode& vehicle : vehicles->items)
      if (const ConfigNode* file = vehicle.find("file"))
        refuse("names the file '" + sim::shortened(sim::printable(file->scalar)) + "'");
  const auto refuse_file = [&](const std::string& path) {
    refuse("names the file '" + sim::shortened(sim::printable(path)) + "'");
  };
  sim::visit_data_files(world, [&](const std::string& path, const std::string*) { refuse_file(path); });
  visit_composed_names(world, "", sim::data_file_keys(), refuse_file);
  if (const std::size_t bytes = sim::to_yaml(world).size(); bytes > max_embedded_bytes)
    throw sim::ConfigError(
        {who + " must have at most " + std::to_string(max_embedded_bytes) + " bytes, got " + std::to_string(bytes)});
}

}  // namespace

ConfigNode embeddable_world(const ConfigNode& resolved, const std::string& name) {
  ConfigNode world = resolved;
  std::erase_if(world.entries,
                [](const ConfigNode::Entry& entry) { return entry.key == "processes" || entry.key == "bridges"; });
  if (world.find("name") == nullptr) world.entries.push_back({"name", {}, sim::scalar_node(name, {})});
  insert_motions(world);
  check_complete(world, "--embed: world '" + name + "'");
  return world;
}

void embed_world(const std::string& take, const ConfigNode& world) {
  sim::JointMotion motion = sim::load_motion(take);
  motion.recorded->embedded_world = world;
  write_motion(take, motion);
}

bool use_embedded_world(StageOptions& stage, const sim::JointMotion& take, const std::string& take_path) {
  if (!take.recorded || take.recorded->embedded_world.kind == ConfigNode::Kind::null) return false;
  check_complete(take.recorded->embedded_world, take_path + ": 'embedded_world'");
  stage.world = take_path;
  stage.tree = std::make_shared<const ConfigNode>(take.recorded->embedded_world);
  stage.load.only_own_files = true;
  if (stage.vehicle.empty()) stage.vehicle = take.recorded->vehicle;
  return true;
}

}  // namespace motion
