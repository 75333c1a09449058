// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/config_node.hpp"

#include <algorithm>
#include <charconv>

#include "sim/config/message_text.hpp"

namespace sim {

namespace {

using Kind = ConfigNode::Kind;

constexpr std::size_t max_path_keys = 100;
constexpr std::size_t max_inserted_nodes = 2'000'000;
constexpr std::size_t max_inserted_bytes = 256'000'000;

std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> keys;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    keys.emplace_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return keys;
}

/// Returns the item with this name, or the item at this index, counted from 1 as in messages.
ConfigNode* find_item(ConfigNode& list, const std::string& key) {
  for (ConfigNode& item : list.items)
    if (const std::string* name = name_of(item); name != nullptr && *name == key) return &item;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  if (error != std::errc{} || end != key.data() + key.size()) return nullptr;
  return index >= 1 && index <= list.items.size() ? &list.items[index - 1] : nullptr;
}

std::string no_item_text(const ConfigNode& list, const std::string& list_name, const std::string& key) {
  std::vector<std::string> names;
  for (const ConfigNode& item : list.items)
    if (const std::string* name = name_of(item)) names.push_back(*name);
  std::string text = "'" + shortened(list_name) + "' has no item '" + shortened(key) + "'; ";
  if (names.empty() && !list.items.empty()) return text + "items: 1 to " + std::to_string(list.items.size());
  return text + "items: " + list_text(names) + did_you_mean(key, names);
}

/// Replaces ${names} below one node.
class Substitution {
 public:
  Substitution(const std::vector<std::pair<std::string, ConfigNode>>& parameters, const std::string& who,
               Diagnostics& diagnostics)
      : parameters_(parameters), who_(who), diagnostics_(diagnostics) {}

  void apply(ConfigNode& node) {
    if (node.kind == Kind::scalar) {
      apply_to_scalar(node);  // not searched again: a parameter that refers to itself would cause infinite recursion
      return;
    }
    for (ConfigNode& item : node.items) apply(item);
    for (ConfigNode::Entry& entry : node.entries) apply(entry.value);
  }

 private:
  void apply_to_scalar(ConfigNode& node) {
    const std::string& text = node.scalar;
    std::string result;
    std::size_t copied = 0;
    for (std::size_t begin = text.find("${"); begin != std::string::npos; begin = text.find("${", copied)) {
      const std::size_t end = text.find('}', begin);
      if (end == std::string::npos) return error(node, "'${' without '}' in " + shown(node));
      const std::string name = text.substr(begin + 2, end - begin - 2);
      const ConfigNode* value = find(name);
      if (value == nullptr) return error(node, unknown_text(name));
      // The whole scalar: take the node of the parameter.
      if (begin == 0 && end + 1 == text.size()) {
        if (within_limits(node, *value)) node = ConfigNode(*value);
        return;
      }
      // A part of the scalar: insert its text.
      if (value->kind != Kind::scalar)
        return error(node, "parameter '" + shortened(name) + "' must be text inside of text, got " + shown(*value));
      if (!within_limits(node, *value)) return;
      result.append(text, copied, begin - copied).append(value->scalar);
      if (value->place.origin == Origin::bus) node.place.origin = Origin::bus;  // a client wrote a part of it
      copied = end + 1;
    }
    if (copied == 0) return;
    result.append(text, copied);
    node.scalar = std::move(result);
    node.verbatim = false;
  }

  const ConfigNode* find(const std::string& name) const {
    for (const auto& [known, value] : parameters_)
      if (known == name) return &value;
    return nullptr;
  }

  std::string unknown_text(const std::string& name) const {
    std::vector<std::string> known;
    for (const auto& parameter : parameters_) known.push_back(parameter.first);
    std::sort(known.begin(), known.end());
    return "unknown parameter '" + shortened(name) + "'; known parameters: " + list_text(known);
  }

  void error(const ConfigNode& node, const std::string& text) { diagnostics_.error(node.place, who_, text); }

  /// Checks the size after substitution: a short file could otherwise use a large parameter often enough to exhaust
  /// memory.
  bool within_limits(const ConfigNode& at, const ConfigNode& value) {
    count(value);
    const bool within = nodes_ <= max_inserted_nodes && bytes_ <= max_inserted_bytes;
    if (!within && !too_much_) error(at, "the substituted parameters make the file too large");
    too_much_ = !within;
    return within;
  }

  void count(const ConfigNode& value) {
    if (nodes_ > max_inserted_nodes) return;
    ++nodes_;
    bytes_ += value.scalar.size();
    for (const ConfigNode& item : value.items) count(item);
    for (const ConfigNode::Entry& entry : value.entries) {
      bytes_ += entry.key.size();
      count(entry.value);
    }
  }

  const std::vector<std::pair<std::string, ConfigNode>>& parameters_;
  const std::string& who_;
  Diagnostics& diagnostics_;
  std::size_t nodes_ = 0;
  std::size_t bytes_ = 0;
  bool too_much_ = false;
};

}  // namespace

ConfigNode::ConfigNode() = default;
ConfigNode::ConfigNode(const ConfigNode&) = default;
ConfigNode::ConfigNode(ConfigNode&&) noexcept = default;
ConfigNode& ConfigNode::operator=(const ConfigNode&) = default;
ConfigNode& ConfigNode::operator=(ConfigNode&&) noexcept = default;
ConfigNode::~ConfigNode() = default;

const std::string* name_of(const ConfigNode& item) {
  const ConfigNode* name = item.kind == Kind::map ? item.find("name") : nullptr;
  return name != nullptr && name->kind == Kind::scalar ? &name->scalar : nullptr;
}

SourcePlace place_in(const ConfigNode& scalar, std::size_t offset) {
  SourcePlace place = scalar.place;
  if (scalar.verbatim && place.line > 0) place.column += static_cast<int>(offset) + (scalar.quoted ? 1 : 0);
  return place;
}

ConfigNode scalar_node(const std::string& text, const SourcePlace& place) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::scalar;
  node.scalar = text;
  node.place = place;
  return node;
}

void set_origin(ConfigNode& node, Origin origin) {
  node.place.origin = origin;
  for (ConfigNode& item : node.items) set_origin(item, origin);
  for (ConfigNode::Entry& entry : node.entries) {
    entry.place.origin = origin;
    set_origin(entry.value, origin);
  }
}

ConfigNode map_node(const std::string& key, const ConfigNode& value) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::map;
  node.place = value.place;
  node.entries.push_back({key, value.place, value});
  return node;
}

const ConfigNode* ConfigNode::find(std::string_view key) const {
  for (const Entry& entry : entries)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

ConfigNode* ConfigNode::find(std::string_view key) {
  return const_cast<ConfigNode*>(static_cast<const ConfigNode*>(this)->find(key));
}

void set_config_path(ConfigNode& root, std::string_view path, const ConfigNode& value, const SourcePlace& place,
                     Diagnostics& diagnostics) {
  const std::vector<std::string> keys = split_path(path);
  if (keys.size() > max_path_keys || std::find(keys.begin(), keys.end(), "") != keys.end()) {
    diagnostics.error(place, "", "bad path '" + shortened(path) + "'; a path is keys and names joined by dots");
    return;
  }
  ConfigNode* node = &root;
  std::string parent = "the file";
  // A path may set a key that the file leaves to its default, so maps on the way are created. Items of lists are not:
  // a name alone does not say what kind of item it would be.
  for (const std::string& key : keys) {
    if (node->kind == Kind::null) {
      node->kind = Kind::map;
      node->place = place;
    }
    if (node->kind == Kind::scalar) {
      diagnostics.error(place, "",
                        "no '" + shortened(key) + "' in '" + shortened(parent) + "', which is " + shown(*node));
      return;
    }
    ConfigNode* next = node->kind == Kind::list ? find_item(*node, key) : node->find(key);
    if (next == nullptr && node->kind == Kind::list) {
      diagnostics.error(place, "", no_item_text(*node, parent, key));
      return;
    }
    if (next == nullptr) next = &node->entries.emplace_back(ConfigNode::Entry{key, place, {}}).value;
    node = next;
    parent = key;
  }
  *node = value;
}

void substitute_parameters(ConfigNode& node, const std::vector<std::pair<std::string, ConfigNode>>& parameters,
                           const std::string& who, Diagnostics& diagnostics) {
  Substitution(parameters, who, diagnostics).apply(node);
}

}  // namespace sim
