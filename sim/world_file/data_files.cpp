// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/data_files.hpp"

#include <filesystem>
#include <map>
#include <mutex>
#include <vector>

#include "sim/device/device_registry.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

namespace {

using Keys = std::set<std::pair<std::string, std::string>>;
using Visit = std::function<void(std::string& path, const std::string* named_in)>;

void collect(const std::vector<ParamInfo>& table, const std::string& parent, Keys& keys) {
  for (const ParamInfo& info : table) {
    if (info.kind == ParamKind::path && info.path_use == PathUse::read) keys.emplace(parent, info.key);
    collect(info.children, info.key, keys);
  }
}

/// Visitor of a tree.
class Visitor {
 public:
  Visitor(const Visit& visit, const Keys& keys) : visit_(visit), keys_(keys) {}

  void go(ConfigNode& node, const std::string& key) {
    for (ConfigNode& item : node.items) go(item, key);
    if (const ConfigNode* model = node.find("model"); model != nullptr && model->kind == ConfigNode::Kind::map)
      return go_vehicle(node);
    for (ConfigNode::Entry& entry : node.entries) {
      if (keys_.contains({key, entry.key}))
        found(entry.value, node.place.file);
      else
        go(entry.value, entry.key);
    }
  }

 private:
  void found(ConfigNode& value, const std::string* named_in) {
    std::string& text = value.scalar;
    const bool whole_parameter = text.starts_with("${") && text.find('}') + 1 == text.size();
    if (whole_parameter) parameters_[text.substr(2, text.size() - 3)] = named_in;
    if (!text.empty() && text.find("${") == std::string::npos) visit_(text, named_in);
  }

  /// Visits an entry of `vehicles:`, whose overrides and parameters become parts of the model.
  void go_vehicle(ConfigNode& node) {
    parameters_.clear();
    ConfigNode* model = node.find("model");
    go(*model, "model");
    if (ConfigNode* overrides = node.find("overrides"))
      for (ConfigNode::Entry& entry : overrides->entries) go_override(entry, model->place.file);
    for (ConfigNode* parameters : {model->find("parameters"), node.find("parameters")})
      for (std::size_t i = 0; parameters != nullptr && i < parameters->entries.size(); ++i) {
        ConfigNode::Entry& entry = parameters->entries[i];
        const auto used = parameters_.find(entry.key);
        if (used != parameters_.end() && !entry.value.scalar.empty()) visit_(entry.value.scalar, used->second);
      }
  }

  /// Visits an override such as `bodies.chassis.parts.hull.mesh`, with items of lists between the keys.
  void go_override(ConfigNode::Entry& entry, const std::string* model_file) {
    std::vector<std::string> path{""};
    for (const char c : entry.key)
      if (c == '.')
        path.emplace_back();
      else
        path.back() += c;
    const std::string last = path.back();
    const std::string above = path.size() > 1 ? path[path.size() - 2] : "";
    const std::string list = path.size() > 2 ? path[path.size() - 3] : "";
    if (keys_.contains({above, last}) || keys_.contains({list, last}))
      found(entry.value, model_file);
    else
      go(entry.value, last);
  }

  const Visit& visit_;
  const Keys& keys_;
  std::map<std::string, const std::string*>
      parameters_;  ///< parameters used as file names, and the file that uses them
};

}  // namespace

Keys data_file_keys() {
  std::vector<ParamInfo> table;
  ParamReader in(table);
  // The keys that name files come from the readers themselves, so that a new key is never forgotten here.
  WorldConfig().read(in);
  VehicleConfig().read(in);
  Keys keys;
  collect(table, "", keys);
  for (const DeviceType* type : DeviceRegistry::instance().all()) {
    std::vector<ParamInfo> own;
    ParamReader of_device(own);
    type->make_params()->read(of_device);
    collect(own, "devices", keys);
  }
  return keys;
}

void visit_data_files(ConfigNode& root, const Visit& visit) {
  // Recompute the keys only when plugins have added device types.
  static std::mutex mutex;
  static std::map<std::size_t, Keys> keys_by_types;
  const std::lock_guard lock(mutex);
  const auto [keys, fresh] = keys_by_types.try_emplace(DeviceRegistry::instance().all().size());
  if (fresh) keys->second = data_file_keys();
  Visitor(visit, keys->second).go(root, "");
}

void make_paths_absolute(ConfigNode& root) {
  visit_data_files(root, [](std::string& path, const std::string* named_in) {
    if (named_in == nullptr) return;
    std::error_code error;
    const std::filesystem::path whole =
        std::filesystem::absolute(std::filesystem::path(*named_in).parent_path() / path, error);
    if (!error) path = whole.lexically_normal().string();
  });
}

}  // namespace sim
