// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/ros2_names.hpp"

#include <algorithm>
#include <set>

namespace bridges::ros2 {
namespace {

bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || is_upper(c);
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

char lower(char c) {
  return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
}

char upper(char c) {
  return is_letter(c) && !is_upper(c) ? static_cast<char>(c - 'a' + 'A') : c;
}

/// Lower case; runs of other characters become one underscore, which is never the last character.
std::string field_name(std::string_view name) {
  std::string field;
  for (const char c : name) {
    const bool plain = is_letter(c) || is_digit(c);
    if (field.empty() && !is_letter(c)) field = "x_";
    if (plain)
      field += lower(c);
    else if (field.back() != '_')
      field += '_';
  }
  while (!field.empty() && field.back() == '_') field.pop_back();
  return field.empty() ? "x" : field;
}

/// Words with capital initials, without underscores and the ending _t.
std::string camel_case(std::string_view name) {
  if (name.ends_with("_t")) name.remove_suffix(2);
  std::string camel;
  bool first = true;
  for (const char c : name) {
    const bool plain = is_letter(c) || is_digit(c);
    if (plain) camel += first ? upper(c) : c;
    first = !plain;
  }
  return camel.empty() || !is_letter(camel.front()) ? "X" + camel : camel;
}

struct Split {
  std::string package, name;
};

Split split(std::string_view lcm_type) {
  const std::size_t dot = lcm_type.rfind('.');
  const std::string_view package = dot == std::string_view::npos ? "lcm" : lcm_type.substr(0, dot);
  const std::string_view name = dot == std::string_view::npos ? lcm_type : lcm_type.substr(dot + 1);
  return {field_name(package) + "_interfaces", camel_case(name)};
}

}  // namespace

std::string short_type_name(std::string_view lcm_type) {
  const Split type = split(lcm_type);
  return type.package + "/" + type.name;
}

std::string type_name(std::string_view lcm_type) {
  const Split type = split(lcm_type);
  return type.package + "/msg/" + type.name;
}

std::string dds_type_name(std::string_view ros_type) {
  std::string name;
  for (std::size_t slash = ros_type.find('/'); slash != std::string_view::npos; slash = ros_type.find('/')) {
    name.append(ros_type.substr(0, slash)).append("::");
    ros_type.remove_prefix(slash + 1);
  }
  return name.append("dds_::").append(ros_type).append("_");
}

std::vector<std::string> field_names(const shoal::MessageSchema& schema) {
  std::vector<std::string> names;
  std::set<std::string> used;
  for (const shoal::Member& member : schema.members) {
    const std::string plain = field_name(member.name);
    std::string name = plain;
    for (int number = 2; !used.insert(name).second; ++number) name = plain + "_" + std::to_string(number);
    names.push_back(name);
  }
  return names;
}

std::string topic_of(std::string_view channel) {
  std::string topic = "/";
  for (const char c : channel) {
    const bool separator = c == '.' || c == '/';
    if (separator && topic.back() == '/') continue;
    if (is_digit(c) && topic.back() == '/') topic += '_';  // no name starts with a digit
    topic += separator ? '/' : is_letter(c) || is_digit(c) ? c : '_';
  }
  if (topic.size() > 1 && topic.back() == '/') topic.pop_back();
  return topic.size() > 1 ? topic : "/_";
}

std::string frame_of(std::string_view channel) {
  if (channel.ends_with(".truth")) channel.remove_suffix(6);
  std::string frame(channel);
  std::replace(frame.begin(), frame.end(), '.', '/');
  return frame;
}

}  // namespace bridges::ros2
