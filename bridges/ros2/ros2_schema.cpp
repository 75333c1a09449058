// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/ros2_schema.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "bridges/ros2/ros2_names.hpp"

namespace bridges::ros2 {
namespace {

std::string base_type(const shoal::Member& member) {
  using shoal::WireType;
  switch (member.type) {
    case WireType::boolean:
      return "bool";
    case WireType::byte:
      return "uint8";
    case WireType::int8:
      return "int8";
    case WireType::int16:
      return "int16";
    case WireType::int32:
      return "int32";
    case WireType::int64:
      return "int64";
    case WireType::float32:
      return "float32";
    case WireType::float64:
      return "float64";
    case WireType::string:
      return "string";
    case WireType::compound:
      return short_type_name(member.compound->name);
  }
  return "uint8";
}

std::string array_suffix(const shoal::Member& member) {
  if (member.dimensions.empty()) return "";
  if (member.is_variable()) return "[]";
  std::uint64_t count = 1;
  for (const shoal::Dimension& dimension : member.dimensions) count *= static_cast<std::uint64_t>(dimension.constant);
  return "[" + std::to_string(count) + "]";
}

/// A comment of one line.
std::string comment_of(const std::string& text) {
  if (text.empty()) return "";
  std::string line = text;
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return "  # " + line;
}

std::string definition(const shoal::MessageSchema& schema) {
  if (schema.members.empty()) return std::string("uint8 ") + only_member + "\n";
  const std::vector<std::string> names = field_names(schema);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const shoal::Member& member = schema.members[i];
    text += base_type(member) + array_suffix(member) + " " + names[i] + comment_of(member.comment) + "\n";
  }
  return text;
}

/// Adds the types that a type uses, before those that these use.
void add_used(const shoal::MessageSchema& schema, std::vector<const shoal::MessageSchema*>& used,
              std::set<const shoal::MessageSchema*>& known) {
  std::vector<const shoal::MessageSchema*> fresh;
  for (const shoal::Member& member : schema.members)
    if (member.compound != nullptr && known.insert(member.compound).second) fresh.push_back(member.compound);
  used.insert(used.end(), fresh.begin(), fresh.end());
  for (const shoal::MessageSchema* each : fresh) add_used(*each, used, known);
}

}  // namespace

std::string schema_text(const shoal::MessageSchema& schema) {
  std::vector<const shoal::MessageSchema*> used;
  std::set<const shoal::MessageSchema*> known{&schema};
  add_used(schema, used, known);
  std::string text = definition(schema);
  for (const shoal::MessageSchema* each : used)
    text += schema_separator + "MSG: " + short_type_name(each->name) + "\n" + definition(*each);
  return text;
}

}  // namespace bridges::ros2
