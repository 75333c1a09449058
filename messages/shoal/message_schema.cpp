// SPDX-License-Identifier: BSD-3-Clause
#include "shoal/message_schema.hpp"

#include "shoal/lcm_parser.hpp"

namespace shoal {
namespace {

// Hash of lcm-gen: signed 64-bit arithmetic with wrap-around, computed with unsigned numbers.
std::uint64_t hash_char(std::uint64_t v, char c) {
  const auto shifted = static_cast<std::uint64_t>(static_cast<std::int64_t>(v) >> 55);
  return ((v << 8) ^ shifted) + static_cast<std::uint64_t>(static_cast<std::int64_t>(static_cast<signed char>(c)));
}

std::uint64_t hash_string(std::uint64_t v, std::string_view s) {
  v = hash_char(v, static_cast<char>(s.size()));
  for (const char c : s) v = hash_char(v, c);
  return v;
}

std::uint64_t members_hash(const MessageSchema& schema) {
  // As in lcmgen.c, so that fingerprints are those of lcm-gen: an enum counts by its name alone.
  if (schema.is_enum) return hash_string(0x87654321, schema.name.substr(schema.name.rfind('.') + 1));
  std::uint64_t v = 0x12345678;
  for (const Member& member : schema.members) {
    v = hash_string(v, member.name);
    if (member.type != WireType::compound) v = hash_string(v, member.type_name);
    v = hash_char(v, static_cast<char>(member.dimensions.size()));
    for (const Dimension& dimension : member.dimensions) {
      v = hash_char(v, dimension.is_variable() ? 1 : 0);
      v = hash_string(v, dimension.text);
    }
  }
  return v;
}

/// Computes the fingerprint.  `parents`: a recursive type contributes 0.
std::uint64_t compute_fingerprint(const MessageSchema& schema, std::vector<const MessageSchema*>& parents) {
  for (const MessageSchema* parent : parents)
    if (parent == &schema) return 0;
  if (parents.size() > 64) throw MessageError("type " + schema.name + " is nested deeper than 64");
  parents.push_back(&schema);
  std::uint64_t hash = members_hash(schema);
  for (const Member& member : schema.members)
    if (member.compound != nullptr) hash += compute_fingerprint(*member.compound, parents);
  parents.pop_back();
  return schema.is_enum ? hash : (hash << 1) + (hash >> 63);
}

std::size_t compute_min_size(const MessageSchema& schema, std::vector<const MessageSchema*>& parents) {
  for (const MessageSchema* parent : parents)
    if (parent == &schema) throw MessageError("type " + schema.name + " contains itself");
  parents.push_back(&schema);
  std::size_t size = 0;
  for (const Member& member : schema.members) {
    if (member.is_variable()) continue;
    std::size_t element =
        member.compound != nullptr ? compute_min_size(*member.compound, parents) : wire_size(member.type);
    for (const Dimension& dimension : member.dimensions)
      // A crafted type could have any size; the product must not wrap around.
      if (__builtin_mul_overflow(element, static_cast<std::size_t>(dimension.constant), &element))
        throw MessageError("type " + schema.name + ": member '" + member.name + "' is too large");
    size += element;
  }
  parents.pop_back();
  return size;
}

}  // namespace

std::size_t wire_size(WireType type) {
  switch (type) {
    case WireType::boolean:
    case WireType::byte:
    case WireType::int8:
      return 1;
    case WireType::int16:
      return 2;
    case WireType::int32:
    case WireType::float32:
      return 4;
    case WireType::int64:
    case WireType::float64:
      return 8;
    case WireType::string:
      return 5;  // minimum: length and NUL
    case WireType::compound:
      break;
  }
  return 0;
}

bool Member::is_variable() const {
  for (const Dimension& dimension : dimensions)
    if (dimension.is_variable()) return true;
  return false;
}

MessageTypes::MessageTypes(std::span<const LcmSource> sources) {
  for (const LcmSource& source : sources)
    for (MessageSchema& schema : parse_lcm(source)) {
      const std::string name = schema.name;
      if (!by_name_.emplace(name, std::move(schema)).second)
        throw MessageError(source.file + ": duplicate type " + name + "");
    }
  resolve();
}

void MessageTypes::resolve() {
  for (auto& [name, schema] : by_name_)
    for (Member& member : schema.members) {
      if (member.type != WireType::compound) continue;
      member.compound = find(member.type_name);
      if (member.compound == nullptr)
        throw MessageError("type " + name + ": member '" + member.name + "' has the unknown type " + member.type_name);
    }
  std::vector<const MessageSchema*> parents;
  // Sizes first: a type that contains itself is refused before its fingerprint, which would not end.
  for (auto& [name, schema] : by_name_) schema.min_size = compute_min_size(schema, parents);
  for (auto& [name, schema] : by_name_) {
    schema.fingerprint = compute_fingerprint(schema, parents);
    by_fingerprint_.emplace(schema.fingerprint, &schema);
  }
}

const MessageSchema* MessageTypes::find(std::string_view name) const {
  const auto it = by_name_.find(name);
  return it == by_name_.end() ? nullptr : &it->second;
}

const MessageSchema* MessageTypes::find(std::uint64_t fingerprint) const {
  const auto it = by_fingerprint_.find(fingerprint);
  return it == by_fingerprint_.end() ? nullptr : it->second;
}

const MessageSchema* MessageTypes::find(std::string_view short_name, std::uint64_t fingerprint) const {
  for (const auto& [name, schema] : by_name_)
    if (schema.fingerprint == fingerprint && std::string_view(name).substr(name.rfind('.') + 1) == short_name)
      return &schema;
  return nullptr;
}

}  // namespace shoal
