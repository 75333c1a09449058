// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The templates of ParamReader; included by param_reader.hpp.

#include <algorithm>

#include "sim/config/param_reader.hpp"

namespace sim {

namespace detail {

/// Object whose address identifies the type T.
template <typename T>
inline constexpr char type_mark = 0;

}  // namespace detail

template <typename Enum>
requires std::is_enum_v<Enum>
void ParamReader::read_choice(const char* key, Enum& value, const std::type_identity_t<ChoiceWords<Enum>>& words,
                              const char* meaning) {
  std::vector<std::string> choices;
  for (const ChoiceWord<Enum>& each : words) choices.emplace_back(each.word);
  const std::size_t chosen = take_choice(key, choices, std::string(word_of(words, value)), meaning);
  if (chosen < words.size()) value = words.begin()[chosen].value;
}

template <typename Enum>
requires std::is_enum_v<Enum>
void ParamReader::read_choice(const char* key, std::optional<Enum>& value, const char* word_of_none,
                              const std::type_identity_t<ChoiceWords<Enum>>& words, const char* meaning) {
  std::vector<std::string> choices{word_of_none};
  for (const ChoiceWord<Enum>& each : words) choices.emplace_back(each.word);
  const std::string initial = value ? std::string(word_of(words, *value)) : word_of_none;
  const std::size_t chosen = take_choice(key, choices, initial, meaning);
  if (chosen == 0) value.reset();
  if (chosen > 0 && chosen < choices.size()) value = words.begin()[chosen - 1].value;
}

template <typename Enum>
requires std::is_enum_v<Enum>
void ParamReader::read_choice(const char* key, Enum& value, const std::type_identity_t<ChoiceWords<Enum>>& words,
                              std::span<const std::type_identity_t<Enum>> allowed, const char* meaning) {
  std::vector<std::string> choices;
  std::vector<Enum> values;
  for (const ChoiceWord<Enum>& each : words) {
    if (std::find(allowed.begin(), allowed.end(), each.value) == allowed.end()) continue;
    choices.emplace_back(each.word);
    values.push_back(each.value);
  }
  const std::size_t chosen = take_choice(key, choices, std::string(word_of(words, value)), meaning);
  if (chosen < values.size()) value = values[chosen];
}

template <ReadsParams T>
void ParamReader::read(const char* key, T& value, const char* meaning) {
  if (describing()) {
    // Read a copy: read() may set members that are derived from others.
    const auto read_copy = [&value](ParamReader& in) { T(value).read(in); };
    describe_nested(key, ParamKind::map, "{}", &detail::type_mark<T>, read_copy, meaning);
    return;
  }
  if constexpr (requires { value.set_key(key); }) value.set_key(key);
  if (const ConfigNode* node = take(key)) read_nested(key, *node, [&value](ParamReader& in) { value.read(in); });
}

template <ReadsParams T>
void ParamReader::read(const char* key, std::optional<T>& value, const char* meaning) {
  if (describing()) {
    const auto read_sample = [](ParamReader& in) { T().read(in); };
    describe_nested(key, ParamKind::map, "~", &detail::type_mark<T>, read_sample, meaning);
    return;
  }
  const ConfigNode* node = take(key);
  if (node == nullptr) return;
  if (node->kind == ConfigNode::Kind::null) {
    value.reset();
    return;
  }
  if (!value) value.emplace();
  read_nested(key, *node, [&value](ParamReader& in) { value->read(in); });
}

template <ReadsParams T>
void ParamReader::read_list(const char* key, std::vector<T>& value, const char* kind, const char* meaning) {
  if (describing()) {
    const auto read_sample = [](ParamReader& in) { T().read(in); };
    describe_nested(key, ParamKind::maps, "[]", &detail::type_mark<T>, read_sample, meaning);
    return;
  }
  const ConfigNode* node = take(key);
  if (node == nullptr) return;
  std::vector<T> items;
  if (read_items(key, *node, kind, [&items](ParamReader& in) { items.emplace_back().read(in); }))
    value = std::move(items);
}

template <ReadsParams T>
void ParamReader::read_lists(const char* key, std::vector<std::vector<T>>& value, const char* kind) {
  const ConfigNode* node = take(key);
  if (node == nullptr) return;
  if (node->kind != ConfigNode::Kind::list) return error(key, "'" + std::string(key) + "' must be a list of lists");
  value.clear();
  for (const ConfigNode& list : node->items) {
    std::vector<T>& items = value.emplace_back();
    read_items(key, list, kind, [&items](ParamReader& in) { items.emplace_back().read(in); });
  }
}

}  // namespace sim
