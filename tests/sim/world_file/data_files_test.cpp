// SPDX-License-Identifier: BSD-3-Clause
// Every key of worlds, vehicles and registered devices that names a file is of the kind that is checked.

#include "sim/world_file/data_files.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <functional>
#include <regex>

#include "sim/config/file_access.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/world_file/world_config.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using sim::ConfigNode;
using sim::ParamInfo;
using sim::ParamKind;
using sim::PathUse;

/// Something whose keys a world may set.
struct Owner {
  std::string name;
  std::function<void(sim::ParamReader&)> read;
};

std::vector<Owner> owners() {
  std::vector<Owner> all{{"world", [](sim::ParamReader& in) { sim::WorldConfig().read(in); }},
                         {"vehicle", [](sim::ParamReader& in) { sim::VehicleConfig().read(in); }}};
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all())
    all.push_back({type->name, [type](sim::ParamReader& in) { type->make_params()->read(in); }});
  return all;
}

/// A key, and the keys above it.
using Visit = std::function<void(const std::vector<const ParamInfo*>&)>;

void walk(const std::vector<ParamInfo>& table, std::vector<const ParamInfo*>& above, const Visit& visit) {
  for (const ParamInfo& info : table) {
    above.push_back(&info);
    visit(above);
    walk(info.children, above, visit);
    above.pop_back();
  }
}

void walk(const Owner& owner, const Visit& visit) {
  std::vector<ParamInfo> table;
  sim::ParamReader in(table);
  owner.read(in);
  std::vector<const ParamInfo*> above;
  walk(table, above, visit);
}

std::string text_of(const std::vector<const ParamInfo*>& keys) {
  std::string text;
  for (const ParamInfo* info : keys) text += (text.empty() ? "" : ".") + info->key;
  return text;
}

/// The value below the keys: maps, and lists of one map.
ConfigNode tree_of(const std::vector<const ParamInfo*>& keys, const std::string& value, const std::string& file) {
  const sim::SourcePlace place{sim::intern_file_name(file), 1, 1};
  ConfigNode node = sim::scalar_node(value, place);
  for (std::size_t i = keys.size(); i > 0; --i) {
    node = sim::map_node(keys[i - 1]->key, node);
    const bool in_list = i > 1 && keys[i - 2]->kind == ParamKind::maps;
    if (!in_list) continue;
    ConfigNode list;
    list.kind = ConfigNode::Kind::list;
    list.place = place;
    list.items.push_back(std::move(node));
    node = std::move(list);
  }
  return node;
}

/// The errors about `key`.
std::vector<std::string> errors_of(const Owner& owner, const ConfigNode& tree, const std::string& key,
                                   const sim::FileAccessPointer& access) {
  sim::Diagnostics diagnostics(access);
  sim::ParamReader in(tree, "", diagnostics);
  owner.read(in);
  std::vector<std::string> lines;
  for (const std::string& line : diagnostics.lines())
    if (line.find("'" + key + "' must lie") != std::string::npos ||
        line.find("'" + key + "' must be relative") != std::string::npos ||
        line.find("'" + key + "' cannot be used in a request from the bus") != std::string::npos)
      lines.push_back(line);
  return lines;
}

TEST(PathKeys, EveryKeyThatNamesAFileIsOfTheKindPath) {
  // What they say of files is not their value.
  const std::set<std::string> others = {"world.description", "world.processes.command",  // started by --launch only
                                        "world.channels.", "vehicle.description"};
  const std::regex words(R"(\b(file|files|path|folder|directory|mesh|png|csv|library|libraries)\b)", std::regex::icase);
  int paths = 0;
  for (const Owner& owner : owners())
    walk(owner, [&](const std::vector<const ParamInfo*>& keys) {
      const ParamInfo& info = *keys.back();
      const std::string name = owner.name + "." + text_of(keys);
      if (info.kind == ParamKind::path || info.kind == ParamKind::paths) ++paths;
      const bool text = info.kind == ParamKind::text || info.kind == ParamKind::texts || info.kind == ParamKind::any;
      if (!text || !info.choices.empty() || others.contains(name)) return;
      EXPECT_FALSE(std::regex_search(info.key + " " + info.meaning, words)) << name << ": " << info.meaning;
    });
  EXPECT_GE(paths, 8);
}

TEST(PathKeys, OfAPeerAreRefusedAndOutsideOnesSayTheRule) {
  const test_support::ScratchFolder folder;
  std::filesystem::create_directories(folder.file("world"));
  const std::string file = folder.file("world/w.yaml");
  const auto access = std::make_shared<const sim::FileAccess>(std::vector<std::string>{folder.file("world")},
                                                              std::vector<std::string>{}, std::set<std::string>{});
  int tried = 0;
  for (const Owner& owner : owners())
    walk(owner, [&](const std::vector<const ParamInfo*>& keys) {
      const ParamInfo& info = *keys.back();
      if (info.kind != ParamKind::path || info.path_use == PathUse::looked_up) return;
      ++tried;
      const std::string name = owner.name + "." + text_of(keys);
      ConfigNode inside = tree_of(keys, "meshes/a.obj", file);
      EXPECT_EQ(errors_of(owner, inside, info.key, access).size(), 0u) << name;
      for (const char* outside : {"/etc/passwd", "../secret"})
        EXPECT_EQ(errors_of(owner, tree_of(keys, outside, file), info.key, access).size(), 1u)
            << name << " " << outside;
      if (info.path_use == PathUse::read) {
        ConfigNode resolved =
            owner.name == "world" || owner.name == "vehicle" ? inside : sim::map_node("devices", inside);
        sim::make_paths_absolute(resolved);
        EXPECT_NE(sim::to_yaml(resolved).find(folder.file("world/meshes/a.obj")), std::string::npos) << name;
      }
      sim::set_origin(inside, sim::Origin::bus);
      for (const auto& any : {access, sim::FileAccessPointer()})
        EXPECT_THAT(errors_of(owner, inside, info.key, any), testing::SizeIs(1)) << name;
    });
  EXPECT_GE(tried, 6);
}

}  // namespace
