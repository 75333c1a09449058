// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/common_keys.hpp"

#include <charconv>
#include <string>

#include "sim/config/message_text.hpp"

namespace sim {

void read_version(ParamReader& in, const char* key, int& version) {
  in.require(key);
  const ConfigNode* node = in.describing() ? nullptr : in.node()->find(key);
  const std::string text = node != nullptr && node->kind == ConfigNode::Kind::scalar ? node->scalar : "";
  int given = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), given);
  if (error != std::errc() || end != text.data() + text.size() || given < 2)
    return in.read(key, version, between(1, 1), "version of the file format");
  in.child(key);
  in.error(key, "'" + std::string(key) + "' must be 1, got " + text + ": the file is of a newer Shoal");
}

void read_points(ParamReader& in, const char* key, std::vector<Vector3d>& value, std::size_t columns,
                 const char* meaning) {
  ParamInfo info;
  info.key = key;
  info.type = columns == 2 ? "list of [x, y]" : "list of [x, y, z]";
  info.initial = "[]";
  info.meaning = meaning;
  in.describe(std::move(info));
  const ConfigNode* list = in.child(key);
  if (list == nullptr) return;
  if (list->kind != ConfigNode::Kind::list)
    return in.error(key, "'" + std::string(key) + "' must be a list of points, got " + shown(*list));
  value.clear();
  // Each point is read as its own list, so that errors name its index and line.
  for (std::size_t i = 0; i < list->items.size(); ++i) {
    const std::string name = std::string(key) + "[" + std::to_string(i + 1) + "]";
    const ConfigNode item = map_node(name, list->items[i]);
    ParamReader one(item, in.who(), in.diagnostics());
    std::vector<double> numbers;
    one.read(name.c_str(), numbers, any_place(), "");
    if (list->items[i].kind == ConfigNode::Kind::list && list->items[i].items.size() != columns)
      one.error(name.c_str(),
                "'" + name + "' must be " + std::to_string(columns) + " numbers, got " + shown(list->items[i]));
    else if (numbers.size() == columns)
      value.emplace_back(numbers[0], numbers[1], columns == 3 ? numbers[2] : 0.0);
  }
}

}  // namespace sim
