// SPDX-License-Identifier: BSD-3-Clause
// Describing functions of ParamReader, which make rows of tables instead of reading values.
#include <algorithm>

#include "sim/config/message_text.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

void ParamReader::describe(ParamInfo info) {
  if (!describing()) return;
  if (const auto required = std::find(required_.begin(), required_.end(), info.key); required != required_.end()) {
    required_.erase(required);
    info.required = true;
  }
  if (info.required) info.initial.clear();
  table_->push_back(std::move(info));
}

void ParamReader::describe_value(const char* key, ParamKind kind, const Rule& range, std::string initial,
                                 const char* meaning) {
  ParamInfo info;
  info.key = key;
  info.type = type_text(kind);
  info.rule = range.text();
  info.initial = std::move(initial);
  info.meaning = meaning;
  info.kind = kind;
  info.range = range;
  info.may_be_null = info.initial == "~" || kind == ParamKind::numbers || kind == ParamKind::texts ||
                     kind == ParamKind::paths || kind == ParamKind::raw;
  describe(std::move(info));
}

void ParamReader::describe_or_word(const char* key, ParamKind kind, const Rule& range, const NumberWord& word,
                                   double initial, const char* meaning) {
  ParamInfo info;
  info.key = key;
  info.type = type_text(kind) + " or " + word.word;
  info.rule = range.text();
  info.initial = initial == word.value ? word.word : number_text(initial);
  info.meaning = meaning;
  info.kind = kind;
  info.range = range;
  info.word = word.word;
  describe(std::move(info));
}

void ParamReader::describe_words(const char* key, ParamKind kind, std::string rule, std::string initial,
                                 const char* meaning, std::vector<std::string> choices) {
  ParamInfo info;
  info.key = key;
  info.type = type_text(kind);
  info.rule = std::move(rule);
  info.initial = std::move(initial);
  info.meaning = meaning;
  info.kind = kind;
  info.choices = std::move(choices);
  info.may_be_null = kind == ParamKind::texts;
  describe(std::move(info));
}

std::vector<ParamInfo> ParamReader::describe_children(const void* type, const ReadInto& read_into) const {
  for (const ParamReader* reader = this; reader != nullptr; reader = reader->parent_)
    if (reader->type_ == type) return {};  // the type contains itself
  std::vector<ParamInfo> children;
  ParamReader nested(children, this, type);
  read_into(nested);
  return children;
}

void ParamReader::describe_nested(const char* key, ParamKind kind, const std::string& initial, const void* type,
                                  const ReadInto& read_into, const char* meaning) {
  ParamInfo info;
  info.key = key;
  info.type = type_text(kind);
  info.initial = initial;
  info.meaning = meaning;
  info.children = describe_children(type, read_into);
  info.kind = kind;
  info.may_be_null = true;
  describe(std::move(info));
}

}  // namespace sim
