// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/key_path.hpp"

#include <algorithm>

#include "tools/experiment/upgrade/old_actions.hpp"

namespace tools {

namespace {

constexpr std::string_view action_pattern = "events.*.do.*";

/// Keys of an entry of `vehicles:`; a dotted path with any other key there leads into the vehicle.
bool is_key_of_entry(std::string_view key) {
  static constexpr std::string_view keys[] = {"name",  "file",      "model",      "position_m", "rpy_deg",
                                              "count", "placement", "parameters", "overrides",  "bus"};
  return std::find(std::begin(keys), std::end(keys), key) != std::end(keys);
}

}  // namespace

bool KeyPath::is(FileKind kind, std::string_view pattern) const {
  if (kind != kind_ || pattern.empty()) return kind == kind_ && keys_.empty();
  std::size_t i = 0;
  for (std::size_t begin = 0; begin <= pattern.size(); ++i) {
    const std::size_t end = std::min(pattern.find('.', begin), pattern.size());
    const std::string_view key = pattern.substr(begin, end - begin);
    if (i == keys_.size() || (key != "*" && key != keys_[i])) return false;
    begin = end + 1;
  }
  return i == keys_.size();
}

bool KeyPath::has_dotted_keys() const {
  return is(FileKind::world, "vehicles.*.overrides") || is(FileKind::study, "cases.*.set") ||
         is(FileKind::world, "events.*.do.*.set.values");
}

bool KeyPath::is_action() const {
  return is(FileKind::world, action_pattern);
}

KeyPath KeyPath::item() const {
  KeyPath path = *this;
  path.add("*");
  return path;
}

KeyPath KeyPath::value_of(std::string_view key) const {
  KeyPath path = *this;
  if (!has_dotted_keys()) {
    path.add(key);
    return path;
  }
  path = top_of_dotted();
  if (is(FileKind::world, "vehicles.*.overrides"))  // `NAME3/devices...`: one vehicle of a count
    key.remove_prefix(key.find('/') == std::string_view::npos ? 0 : key.find('/') + 1);
  for (std::size_t begin = 0; begin <= key.size();) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    path.add(key.substr(begin, end - begin));
    begin = end + 1;
  }
  return path;
}

KeyPath KeyPath::top_of_dotted() const {
  if (is(FileKind::study, "cases.*.set")) return KeyPath(FileKind::world);
  KeyPath path(FileKind::vehicle);
  if (!is(FileKind::world, "vehicles.*.overrides")) path.keys_ = {"devices", "*"};
  return path;
}

KeyPath KeyPath::value_of_action(std::string_view key, std::string_view word) const {
  KeyPath path = *this;
  path.keys_.emplace_back(word);
  const OldAction* action = find_old_action(word);
  path.add(key == word && action != nullptr ? action->main_key : key);
  return path;
}

void KeyPath::add(std::string_view key) {
  keys_.emplace_back(key);
  if (is(FileKind::world, "vehicles.*.model")) {
    *this = KeyPath(FileKind::vehicle);
  } else if (keys_.size() == 3 && is(FileKind::world, "vehicles.*.*") && !is_key_of_entry(key)) {
    *this = KeyPath(FileKind::vehicle);
    add(key);
  } else if (is(FileKind::world, "events.*.do.*.one_of.choices.*.*")) {
    keys_.resize(4);
  } else if (is(FileKind::world, "events.*.do.*.one_of.*") && key == "*") {
    keys_.back() = "choices";  // `one_of: [[...], [...]]` has the lists without their key
    keys_.emplace_back("*");
  }
}

}  // namespace tools
