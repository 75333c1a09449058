// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The templates of ParamReader; included by param_reader.hpp.

#include "sim/config/param_reader.hpp"

namespace sim {

namespace detail {

/// Its address names the type T.
template <typename T>
inline constexpr char type_mark = 0;

}  // namespace detail

template <typename Enum>
requires std::is_enum_v<Enum>
void ParamReader::read_choice(const char* key, Enum& value, const std::vector<std::pair<std::string, Enum>>& choices,
                              const char* meaning) {
  std::vector<std::string> words;
  std::string initial;
  for (const auto& [word, choice] : choices) {
    words.push_back(word);
    if (choice == value) initial = word;
  }
  const std::size_t chosen = take_choice(key, words, initial, meaning);
  if (chosen < choices.size()) value = choices[chosen].second;
}

template <ReadsParams T>
void ParamReader::read(const char* key, T& value, const char* meaning) {
  if (describing()) {
    // A copy: read() may set members that follow from others.
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
