// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/param_reader.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>

#include "sim/base/number.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"

namespace sim {

namespace {

using Kind = ConfigNode::Kind;

constexpr std::size_t max_unknown_keys = 20;

std::string quoted_name(std::string_view name) {
  return "'" + shortened(name) + "'";
}

std::string yaml_of(const std::string& text) {
  return to_flow_yaml(scalar_node(text, {}));
}

template <typename Values, typename ToText>
std::string yaml_list(const Values& values, const ToText& to_text) {
  std::string text;
  for (const auto& value : values) text += (text.empty() ? "" : ", ") + to_text(value);
  return "[" + text + "]";
}

/// Rounds the conversion error of angles: 45 degrees are converted from radians to about 45.000000000000007.
double rounded_degrees(double angle_rad) {
  return rounded_to(radians_to_degrees(angle_rad), 12);
}

enum class NumberText { number, not_finite, no_number };

/// Parses a decimal number in YAML syntax.
NumberText parse_number(std::string_view text, double& value) {
  std::string magnitude(text.substr(text.starts_with('-') || text.starts_with('+') ? 1 : 0));
  std::transform(magnitude.begin(), magnitude.end(), magnitude.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  for (const char* word : {".inf", ".nan", "inf", "nan", "infinity"})
    if (magnitude == word) return NumberText::not_finite;
  const std::optional<double> number = read_number(text);
  if (!number) return NumberText::no_number;
  value = *number;
  return std::isfinite(value) ? NumberText::number : NumberText::not_finite;
}

/// Describes a value found in place of a number, for messages.
std::string shown_as_no_number(const ConfigNode& node) {
  return (node.kind == Kind::scalar && node.quoted ? "the text " : "") + shown(node);
}

}  // namespace

ParamReader::ParamReader(const ConfigNode& node, std::string who, Diagnostics& diagnostics)
    : ParamReader(node, std::move(who), diagnostics, nullptr) {}

ParamReader::ParamReader(const ConfigNode& node, std::string who, Diagnostics& diagnostics, const ParamReader* parent)
    : node_(&node), who_(std::move(who)), diagnostics_(&diagnostics), parent_(parent) {
  if (node.kind == Kind::scalar || node.kind == Kind::list)
    error_at(node.place, "must be a map of keys and values, got " + shown(node));
}

ParamReader::ParamReader(std::vector<ParamInfo>& table) : ParamReader(table, nullptr, nullptr) {}

ParamReader::ParamReader(std::vector<ParamInfo>& table, const ParamReader* parent, const void* type)
    : diagnostics_(&unused_), table_(&table), parent_(parent), type_(type) {}

// Errors and keys

void ParamReader::error_at(const SourcePlace& place, const std::string& text) {
  if (!describing()) diagnostics_->error(place, who_, text);
}

void ParamReader::error(const std::string& text) {
  if (!describing()) error_at(node_->place, text);
}

void ParamReader::error(const char* key, const std::string& text) {
  if (describing()) return;
  const ConfigNode* value = node_->find(key);
  error_at(value != nullptr ? value->place : node_->place, text);
}

bool ParamReader::has(const char* key) const {
  return !describing() && node_->find(key) != nullptr;
}

const ConfigNode* ParamReader::child(const char* key) {
  return take(key);
}

void ParamReader::read_name(const char* key, std::string& value, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::name, {}, yaml_of(value), meaning);
  read(key, value, meaning);
  const bool plain = std::all_of(value.begin(), value.end(),
                                 [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
  if (has(key) && (value.empty() || !plain))
    error(key, "a name must be made of letters, digits, '_' and '-', got '" + shortened(value) + "'");
}

void ParamReader::require(const char* key) {
  required_.push_back(key);
}

const ConfigNode* ParamReader::take(const char* key) {
  if (describing()) return nullptr;
  known_.push_back(key);
  const ConfigNode* value = node_->find(key);
  const auto required = std::find(required_.begin(), required_.end(), key);
  if (required == required_.end()) return value;
  required_.erase(required);
  const bool is_map = node_->kind == Kind::map || node_->kind == Kind::null;  // otherwise that was the error
  if (value == nullptr && is_map) error("missing key " + quoted_name(key));
  return value;
}

void ParamReader::finish() {
  if (describing()) return;
  std::sort(known_.begin(), known_.end());
  // A key may be read several times, by a type and by its base.
  known_.erase(std::unique(known_.begin(), known_.end()), known_.end());
  std::size_t unknown = 0;
  for (const ConfigNode::Entry& entry : node_->entries) {
    if (std::binary_search(known_.begin(), known_.end(), entry.key)) continue;
    // One wrong indentation can make hundreds of keys unknown.
    if (++unknown > max_unknown_keys) return error_at(entry.place, "more unknown keys are not shown");
    error_at(entry.place, "unknown key " + quoted_name(entry.key) +
                              "; known keys: " + list_text(known_, known_.size()) + did_you_mean(entry.key, known_));
  }
}

// Names

void ParamReader::declare(const char* kind, const std::string& name) {
  if (describing() || name.empty()) return;
  const std::size_t count = ++declared_[kind][name];
  if (count == 1) return;
  SourcePlace place = node_->place;
  for (const std::string& listed_as : {std::string(kind), std::string()}) {
    std::size_t seen = 0;
    for (const NamedPlace& named : named_places_)
      if (named.kind == listed_as && named.name == name && ++seen == count) place = named.place;
    if (seen >= count) break;
    // The other one has a generated name, such as that of an instance.
    for (const NamedPlace& named : named_places_)
      if (seen == 1 && named.kind == listed_as && named.name == name) place = named.place;
  }
  error_at(place, "duplicate " + std::string(kind) + " " + quoted_name(name));
}

std::vector<std::string> ParamReader::declared(const char* kind) const {
  std::vector<std::string> names;
  for (const ParamReader* reader = this; reader != nullptr; reader = reader->parent_)
    if (const auto found = reader->declared_.find(kind); found != reader->declared_.end())
      for (const auto& [name, count] : found->second) names.push_back(name);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

void ParamReader::check_reference(const char* key, const char* kind, const std::string& name,
                                  const SourcePlace& place) {
  for (const ParamReader* reader = this; reader != nullptr; reader = reader->parent_)
    if (const auto found = reader->declared_.find(kind);
        found != reader->declared_.end() && found->second.contains(name))
      return;
  error_at(place, quoted_name(key) + " names no " + kind + " " + quoted_name(name) + "; known " + plural_of(kind) +
                      ": " + list_text(declared(kind)));
}

// Values

// Squares and cubes of larger numbers may overflow, and no physical quantity is larger.
constexpr double max_magnitude = 1e30;

bool ParamReader::take_number(const std::string& what, const ConfigNode& node, const Rule& rule, double& value) {
  double number = 0;
  const NumberText found =
      node.kind == Kind::scalar && !node.quoted ? parse_number(node.scalar, number) : NumberText::no_number;
  if (found == NumberText::no_number)
    error_at(node.place, what + " must be a number, got " + shown_as_no_number(node));
  else if (found == NumberText::not_finite)
    error_at(node.place, what + " must be finite, got " + shown(node));
  else if (!rule.allows(number))
    error_at(node.place, what + " must be " + rule.text() + ", got " + shortened(node.scalar));
  else if (std::abs(number) > max_magnitude)
    error_at(node.place, what + " must be between -1e30 and 1e30, got " + shortened(node.scalar));
  else {
    value = number;
    return true;
  }
  return false;
}

bool ParamReader::take_integer(const std::string& what, const ConfigNode& node, const Rule& rule, std::int64_t& value) {
  constexpr double exact_whole_numbers = 9007199254740992.0;  // 2^53
  std::int64_t whole = 0;
  double number = 0;
  const std::string_view text = node.scalar;
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), whole);
  const bool all_read = end == digits.data() + digits.size() && !(text.starts_with('+') && digits.starts_with('-'));
  NumberText found = NumberText::no_number;
  if (node.kind == Kind::scalar && !node.quoted) {
    found = parse_number(text, number);
    if (found == NumberText::number && (error != std::errc{} || !all_read)) {
      // Accept 1e3 as a whole number.
      if (number != std::trunc(number)) found = NumberText::no_number;
      if (found == NumberText::number && std::abs(number) > exact_whole_numbers) {
        error_at(node.place, what + " must be a whole number of at most 63 bits, got " + shown(node));
        return false;
      }
      if (found == NumberText::number) whole = static_cast<std::int64_t>(number);
    }
  }
  if (found == NumberText::no_number)
    error_at(node.place, what + " must be a whole number, got " + shown_as_no_number(node));
  else if (found == NumberText::not_finite)
    error_at(node.place, what + " must be finite, got " + shown(node));
  else if (!rule.allows(static_cast<double>(whole)))
    error_at(node.place, what + " must be " + rule.text() + ", got " + shortened(node.scalar));
  else {
    value = whole;
    return true;
  }
  return false;
}

bool ParamReader::take_text(const std::string& what, const ConfigNode& node, std::string& value) {
  if (node.kind != Kind::scalar) {
    error_at(node.place, what + " must be text, got " + shown(node));
    return false;
  }
  // A terminal would execute them wherever the text is printed.
  std::string line = node.scalar;
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  if (printable(line) != line) {
    error_at(node.place, what + " must have no control characters, got '" + shortened(printable(node.scalar)) + "'");
    return false;
  }
  value = node.scalar;
  return true;
}

bool ParamReader::take_vector(const char* key, const ConfigNode& node, const Rule& rule, Vector3d& value) {
  if (node.kind != Kind::list || node.items.size() != 3) {
    error_at(node.place, quoted_name(key) + " must be a list of 3 numbers, got " + shown(node));
    return false;
  }
  Vector3d vector = value;
  bool good = true;
  for (int i = 0; i < 3; ++i) {
    const std::string what = "item " + std::to_string(i + 1) + " of " + quoted_name(key);
    good = take_number(what, node.items[static_cast<std::size_t>(i)], rule, vector[i]) && good;
  }
  if (good) value = vector;
  return good;
}

bool ParamReader::take_texts(const char* key, const ConfigNode& node, std::vector<std::string>& value) {
  if (node.kind != Kind::list && node.kind != Kind::null) {
    error_at(node.place, quoted_name(key) + " must be a list of text, got " + shown(node));
    return false;
  }
  std::vector<std::string> texts(node.items.size());
  bool good = true;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string what = "item " + std::to_string(i + 1) + " of " + quoted_name(key);
    good = take_text(what, node.items[i], texts[i]) && good;
    named_places_.push_back({"", texts[i], node.items[i].place});
  }
  if (good) value = std::move(texts);
  return good;
}

void ParamReader::read(const char* key, bool& value, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::boolean, {}, value ? "true" : "false", meaning);
  const ConfigNode* node = take(key);
  if (node == nullptr) return;
  const bool plain = node->kind == Kind::scalar && !node->quoted;
  // Exactly the core schema of YAML 1.2, without the yes, no, on and off of YAML 1.1.
  if (plain && (node->scalar == "true" || node->scalar == "True" || node->scalar == "TRUE"))
    value = true;
  else if (plain && (node->scalar == "false" || node->scalar == "False" || node->scalar == "FALSE"))
    value = false;
  else
    error_at(node->place, quoted_name(key) + " must be true or false, got " + shown_as_no_number(*node));
}

void ParamReader::read(const char* key, int& value, const Rule& rule, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::integer, rule, std::to_string(value), meaning);
  const ConfigNode* node = take(key);
  if (node == nullptr) return;
  std::int64_t whole = 0;
  if (!take_integer(quoted_name(key), *node, rule, whole)) return;
  constexpr std::int64_t low = std::numeric_limits<int>::min();
  constexpr std::int64_t high = std::numeric_limits<int>::max();
  if (whole < low || whole > high) {
    const std::string limit = whole < low ? ">= " + std::to_string(low) : "<= " + std::to_string(high);
    return error_at(node->place, quoted_name(key) + " must be " + limit + ", got " + shortened(node->scalar));
  }
  value = static_cast<int>(whole);
}

void ParamReader::read(const char* key, std::int64_t& value, const Rule& rule, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::integer, rule, std::to_string(value), meaning);
  if (const ConfigNode* node = take(key)) take_integer(quoted_name(key), *node, rule, value);
}

void ParamReader::read(const char* key, double& value, const Rule& rule, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::number, rule, number_text(value), meaning);
  if (const ConfigNode* node = take(key)) take_number(quoted_name(key), *node, rule, value);
}

void ParamReader::read(const char* key, std::optional<double>& value, const Rule& rule, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::number, rule, value ? number_text(*value) : "~", meaning);
  const ConfigNode* node = take(key);
  if (node == nullptr) return;
  double number = 0;
  if (node->kind == Kind::null)
    value.reset();
  else if (take_number(quoted_name(key), *node, rule, number))
    value = number;
}

const ConfigNode* ParamReader::take_unless_word(const char* key, double& value, const Rule& rule,
                                                const NumberWord& word) {
  const ConfigNode* node = take(key);
  if (node == nullptr) return nullptr;
  if (node->kind == Kind::scalar && node->scalar == word.word) {
    value = word.value;
    return nullptr;
  }
  double number = 0;
  const NumberText found =
      node->kind == Kind::scalar && !node->quoted ? parse_number(node->scalar, number) : NumberText::no_number;
  const std::string word_text = "'" + std::string(word.word) + "'";
  if (found == NumberText::no_number) {
    error_at(node->place,
             quoted_name(key) + " must be a number or " + word_text + ", got " + shown_as_no_number(*node));
    return nullptr;
  }
  if (found != NumberText::number || rule.allows(number)) return node;
  std::string text =
      quoted_name(key) + " must be " + rule.text() + ", or " + word_text + ", got " + shortened(node->scalar);
  if (number == word.value) text += "; write '" + std::string(key) + ": " + word.word + "'";
  error_at(node->place, text);
  return nullptr;
}

void ParamReader::read_or_word(const char* key, double& value, const Rule& rule, const NumberWord& word,
                               const char* meaning) {
  if (describing()) return describe_or_word(key, ParamKind::number, rule, word, value, meaning);
  if (const ConfigNode* node = take_unless_word(key, value, rule, word))
    take_number(quoted_name(key), *node, rule, value);
}

void ParamReader::read_or_word(const char* key, std::int64_t& value, const Rule& rule, const NumberWord& word,
                               const char* meaning) {
  auto number = static_cast<double>(value);
  if (describing()) return describe_or_word(key, ParamKind::integer, rule, word, number, meaning);
  const double before = number;
  if (const ConfigNode* node = take_unless_word(key, number, rule, word))
    take_integer(quoted_name(key), *node, rule, value);
  else if (number != before)
    value = static_cast<std::int64_t>(number);
}

void ParamReader::read_or_word(const char* key, int& value, const Rule& rule, const NumberWord& word,
                               const char* meaning) {
  std::int64_t whole = value;
  read_or_word(key, whole, rule, word, meaning);
  constexpr std::int64_t high = std::numeric_limits<int>::max();
  if (whole > high)
    return error(key, quoted_name(key) + " must be <= " + std::to_string(high) + ", got " + std::to_string(whole));
  value = static_cast<int>(whole);
}

void ParamReader::read(const char* key, std::string& value, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::text, {}, yaml_of(value), meaning);
  if (const ConfigNode* node = take(key)) take_text(quoted_name(key), *node, value);
}

bool ParamReader::read_path(const char* key, std::string& value, PathUse use, const char* meaning) {
  if (describing()) {
    describe_value(key, ParamKind::path, {}, yaml_of(value), meaning);
    if (!table_->empty()) table_->back().path_use = use;
    return true;
  }
  const ConfigNode* node = take(key);
  if (node == nullptr) return true;
  return take_text(quoted_name(key), *node, value) && check_path(key, value, use, node->place);
}

bool ParamReader::check_path(const char* key, const std::string& value, PathUse use, const SourcePlace& place) {
  // Files named on the command line are the choice of the user, not of a world file that may come from elsewhere.
  if (value.empty() || use == PathUse::looked_up || place.origin == Origin::command_line) return true;
  if (place.origin == Origin::bus) {
    error_at(place, quoted_name(key) + " cannot be used in a request from the bus: it names a file");
    return false;
  }
  const auto& files = diagnostics_->files();
  if (files == nullptr) return true;
  const std::filesystem::path named_in(node_->place.file != nullptr ? *node_->place.file : "");
  const bool read = use == PathUse::read;
  if (read ? files->may_read(named_in.parent_path() / value) : files->may_make(value)) return true;
  error_at(place, quoted_name(key) + " " + (read ? FileAccess::reading_rule() : FileAccess::making_rule()) + ", got '" +
                      shortened(value) + "'");
  return false;
}

void ParamReader::read_paths(const char* key, std::vector<std::string>& value, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::paths, {}, yaml_list(value, yaml_of), meaning);
  const ConfigNode* node = take(key);
  if (node == nullptr || !take_texts(key, *node, value)) return;
  for (const ConfigNode& item : node->items)
    if (item.place.origin == Origin::bus)
      error_at(item.place, quoted_name(key) + " cannot be used in a request from the bus: it names a file");
}

void ParamReader::read(const char* key, Vector3d& value, const Rule& rule, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::vector, rule, yaml_list(value, number_text), meaning);
  if (const ConfigNode* node = take(key)) take_vector(key, *node, rule, value);
}

void ParamReader::read(const char* key, std::optional<Vector3d>& value, const Rule& rule, const char* meaning) {
  if (describing())
    return describe_value(key, ParamKind::vector, rule, value ? yaml_list(*value, number_text) : "~", meaning);
  const ConfigNode* node = take(key);
  if (node == nullptr) return;
  Vector3d vector = Vector3d::Zero();
  if (node->kind == Kind::null)
    value.reset();
  else if (take_vector(key, *node, rule, vector))
    value = vector;
}

void ParamReader::read(const char* key, std::vector<double>& value, const Rule& rule, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::numbers, rule, yaml_list(value, number_text), meaning);
  const ConfigNode* node = take(key);
  if (node == nullptr) return;
  if (node->kind != Kind::list && node->kind != Kind::null)
    return error_at(node->place, quoted_name(key) + " must be a list of numbers, got " + shown(*node));
  std::vector<double> numbers(node->items.size());
  bool good = true;
  // All items are read, so that each wrong one is reported.
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string what = "item " + std::to_string(i + 1) + " of " + quoted_name(key);
    good = take_number(what, node->items[i], rule, numbers[i]) && good;
  }
  if (good) value = std::move(numbers);
}

void ParamReader::read(const char* key, std::vector<std::string>& value, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::texts, {}, yaml_list(value, yaml_of), meaning);
  if (const ConfigNode* node = take(key)) take_texts(key, *node, value);
}

void ParamReader::read_deg(const char* key, double& value_rad, const Rule& rule, const char* meaning) {
  if (describing())
    return describe_value(key, ParamKind::number, rule, number_text(rounded_degrees(value_rad)), meaning);
  double angle_deg = 0;
  const ConfigNode* node = take(key);
  if (node != nullptr && take_number(quoted_name(key), *node, rule, angle_deg))
    value_rad = degrees_to_radians(angle_deg);
}

void ParamReader::read_deg(const char* key, Vector3d& value_rad, const char* meaning) {
  const auto degrees_text = [](double angle_rad) { return number_text(rounded_degrees(angle_rad)); };
  if (describing()) return describe_value(key, ParamKind::vector, {}, yaml_list(value_rad, degrees_text), meaning);
  Vector3d angles_deg = Vector3d::Zero();
  const ConfigNode* node = take(key);
  if (node == nullptr || !take_vector(key, *node, any_number(), angles_deg)) return;
  for (int i = 0; i < 3; ++i) value_rad[i] = degrees_to_radians(angles_deg[i]);
}

std::size_t ParamReader::take_choice(const char* key, const std::vector<std::string>& choices,
                                     const std::string& initial, const char* meaning) {
  const std::string rule = "one of: " + list_text(choices, choices.size());
  if (describing()) {
    describe_words(key, ParamKind::text, rule, yaml_of(initial), meaning, choices);
    return choices.size();
  }
  const ConfigNode* node = take(key);
  if (node == nullptr) return choices.size();
  const auto end = choices.end();
  const auto chosen = node->kind == Kind::scalar ? std::find(choices.begin(), end, node->scalar) : end;
  if (chosen == end)
    error_at(node->place, quoted_name(key) + " must be " + rule + "; got " + shown(*node) +
                              (node->kind == Kind::scalar ? did_you_mean(node->scalar, choices) : ""));
  return static_cast<std::size_t>(chosen - choices.begin());
}

void ParamReader::read_one_of(const char* key, std::string& value, const std::vector<std::string>& names,
                              const char* meaning) {
  const std::size_t chosen = take_choice(key, names, value, meaning);
  if (chosen < names.size()) value = names[chosen];
}

void ParamReader::read_reference(const char* key, std::string& value, const char* kind, const char* meaning) {
  if (describing())
    return describe_words(key, ParamKind::text, "name of " + with_article(kind), yaml_of(value), meaning);
  const ConfigNode* node = take(key);
  if (node == nullptr || !take_text(quoted_name(key), *node, value)) return;
  if (!value.empty()) check_reference(key, kind, value, node->place);
}

void ParamReader::read_references(const char* key, std::vector<std::string>& value, const char* kind,
                                  const char* meaning) {
  if (describing())
    return describe_words(key, ParamKind::texts, "names of " + plural_of(kind), yaml_list(value, yaml_of), meaning);
  const ConfigNode* node = take(key);
  if (node == nullptr || !take_texts(key, *node, value)) return;
  for (std::size_t i = 0; i < value.size(); ++i) check_reference(key, kind, value[i], node->items[i].place);
}

void ParamReader::read_raw(const char* key, ConfigNode& value, const char* meaning) {
  if (describing()) return describe_value(key, ParamKind::raw, {}, "{}", meaning);
  const ConfigNode* node = take(key);
  if (node == nullptr) return;
  if (node->kind != Kind::map && node->kind != Kind::null)
    return error_at(node->place, quoted_name(key) + " must be a map, got " + shown(*node));
  value = *node;
}

// Maps in maps

void ParamReader::read_nested(const char* key, const ConfigNode& node, const ReadInto& read_into) {
  if (node.kind != Kind::map && node.kind != Kind::null)
    return error_at(node.place, quoted_name(key) + " must be a map, got " + shown(node));
  ParamReader nested(node, who_.empty() ? key : who_ + ": " + key, *diagnostics_, this);
  read_into(nested);
  nested.finish();
}

std::string ParamReader::who_of_item(const ConfigNode& item, const char* kind, std::size_t index) const {
  const ConfigNode* name = item.find("name");
  const std::string own =
      std::string(kind) + " " +
      (name != nullptr && name->kind == Kind::scalar ? quoted_name(name->scalar) : std::to_string(index + 1));
  return who_.empty() ? own : who_ + ": " + own;
}

bool ParamReader::read_items(const char* key, const ConfigNode& node, const char* kind, const ReadInto& read_into) {
  if (node.kind != Kind::list && node.kind != Kind::null) {
    error_at(node.place, quoted_name(key) + " must be a list of maps, got " + shown(node));
    return false;
  }
  // All wrong items are reported in one go, not only the first.
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const ConfigNode& item = node.items[i];
    if (item.kind != Kind::map) {
      error_at(item.place,
               "item " + std::to_string(i + 1) + " of " + quoted_name(key) + " must be a map, got " + shown(item));
      continue;
    }
    if (const ConfigNode* name = item.find("name"); name != nullptr && name->kind == Kind::scalar)
      named_places_.push_back({kind, name->scalar, name->place});
    ParamReader nested(item, who_of_item(item, kind, i), *diagnostics_, this);
    read_into(nested);
    nested.finish();
  }
  return true;
}

}  // namespace sim
