// SPDX-License-Identifier: BSD-3-Clause
#include "sim/program/program_declaration.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "sim/config/common_keys.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"
#include "sim/program/program_args.hpp"

namespace sim {

namespace {

using Kind = ConfigNode::Kind;

constexpr std::size_t max_args = 256;
constexpr std::size_t max_channel_length = 63;  // of LCM
constexpr std::size_t max_columns = 16;

bool has_numbers(ArgType type) {
  return type != ArgType::text && type != ArgType::flag && type != ArgType::choice;
}

bool has_columns(ArgType type) {
  return type == ArgType::tuple || type == ArgType::tuples;
}

/// Returns whether a name can be a YAML key, a command line option and a program variable.
bool is_arg_name(const std::string& name) {
  const auto good = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return !name.empty() && name.size() <= 60 && std::islower(static_cast<unsigned char>(name.front())) != 0 &&
         name.back() != '_' && name.find("__") == std::string::npos && std::all_of(name.begin(), name.end(), good);
}

/// Reports keys that do not belong to the type, or are missing for it.
void check_keys_of_type(ParamReader& in, const ArgDeclaration& arg) {
  const std::string type = "'type: " + std::string(word_of(arg_type_words, arg.type)) + "'";
  for (const char* key : {"min", "max"})
    if (in.has(key) && !has_numbers(arg.type)) in.error(key, "'" + std::string(key) + "' does not apply to " + type);
  if (in.has("choices") && arg.type != ArgType::choice) in.error("choices", "'choices' does not apply to " + type);
  if (!in.has("choices") && arg.type == ArgType::choice) in.error(type + " needs 'choices'");
  if (in.has("choices") && arg.choices.empty()) in.error("choices", "'choices' must name a word");
  if (in.has("columns") && !has_columns(arg.type)) in.error("columns", "'columns' does not apply to " + type);
  if (!in.has("columns") && has_columns(arg.type)) in.error(type + " needs 'columns', such as [x, y]");
  if (in.has("columns") && (arg.columns.empty() || arg.columns.size() > max_columns))
    in.error("columns", "'columns' must have 1 to " + std::to_string(max_columns) + " names, got " +
                            std::to_string(arg.columns.size()));
  if (in.has("min_columns") &&
      (!has_columns(arg.type) || static_cast<std::size_t>(arg.min_columns) > arg.columns.size()))
    in.error("min_columns", "'min_columns' must be at most the number of 'columns'");
  if (in.has("min") && in.has("max") && arg.range.low > arg.range.high)
    in.error("max", "'max' must not be below 'min', got " + number_text(arg.range.high) + " below " +
                        number_text(arg.range.low));
}

ConfigNode scalar(const std::string& text) {
  return scalar_node(text, {});
}

ConfigNode text_node(const std::string& text) {
  ConfigNode node = scalar_node(text, {});
  node.quoted = true;
  return node;
}

ConfigNode list_node(const std::vector<std::string>& texts) {
  ConfigNode list;
  list.kind = Kind::list;
  for (const std::string& text : texts) list.items.push_back(scalar(text));
  return list;
}

ConfigNode node_of(const ArgDeclaration& arg) {
  ConfigNode map;
  map.kind = Kind::map;
  const auto add = [&map](const char* key, ConfigNode value) { map.entries.push_back({key, {}, std::move(value)}); };
  add("name", scalar(arg.name));
  add("type", scalar(std::string(word_of(arg_type_words, arg.type))));
  if (!arg.columns.empty()) add("columns", list_node(arg.columns));
  if (arg.min_columns > 0) add("min_columns", scalar(std::to_string(arg.min_columns)));
  if (!arg.choices.empty()) add("choices", list_node(arg.choices));
  if (std::isfinite(arg.range.low)) add("min", scalar(number_text(arg.range.low)));
  if (std::isfinite(arg.range.high)) add("max", scalar(number_text(arg.range.high)));
  if (arg.required) add("required", scalar("true"));
  if (arg.initial) add("default", *arg.initial);
  if (!arg.needs.empty()) add("needs", list_node(arg.needs));
  if (!arg.meaning.empty()) add("meaning", text_node(arg.meaning));
  return map;
}

/// Reads a list of lists of argument names.
void read_groups(ParamReader& in, const char* key, std::vector<std::vector<std::string>>& groups, const char* meaning) {
  // Check the default like a given value.
  ParamInfo info;
  info.key = key;
  info.type = "list of lists of text";
  info.initial = "[]";
  info.meaning = meaning;
  in.describe(std::move(info));
  const ConfigNode* list = in.child(key);
  if (list == nullptr) return;
  const auto is_group = [](const ConfigNode& item) {
    return item.kind == Kind::list && item.items.size() >= 2 &&
           std::all_of(item.items.begin(), item.items.end(),
                       [](const ConfigNode& name) { return name.kind == Kind::scalar; });
  };
  if (list->kind != Kind::list || !std::all_of(list->items.begin(), list->items.end(), is_group))
    return in.error(key, "'" + std::string(key) + "' must be a list of lists of arguments, such as [[route, circle]]");
  for (const ConfigNode& item : list->items) {
    std::vector<std::string>& group = groups.emplace_back();
    for (const ConfigNode& name : item.items) group.push_back(name.scalar);
  }
}

/// Reports patterns that cannot be names of channels.
void check_channels(ParamReader& in, const char* key, const std::optional<std::vector<std::string>>& channels) {
  if (!channels) return;
  for (const std::string& channel : *channels)
    if (channel.empty() || channel.size() > max_channel_length || printable(channel) != channel)
      in.error(key, "a channel must have 1 to 63 printable characters, got '" + shortened(printable(channel)) + "'");
}

/// Names in `needs` and in groups are those of arguments, and each argument is declared once.
void check_names(ParamReader& in, const ProgramDeclaration& declaration) {
  const auto check = [&](const char* key, const std::string& name, const std::string& by) {
    if (declaration.find(name) == nullptr)
      in.error(key, by + " names no argument '" + shortened(printable(name)) + "'");
  };
  std::set<std::string> seen;
  for (const ArgDeclaration& arg : declaration.args) {
    if (!seen.insert(arg.name).second) in.error("args", "duplicate argument '" + shortened(printable(arg.name)) + "'");
    for (const std::string& name : arg.needs) check("args", name, "'needs' of '" + arg.name + "'");
  }
  for (const auto& [key, groups] :
       {std::pair{"exactly_one", &declaration.exactly_one}, std::pair{"at_most_one", &declaration.at_most_one}})
    for (const auto& group : *groups)
      for (const std::string& name : group) check(key, name, "'" + std::string(key) + "'");
}

/// Returns the type of an argument for tables, such as `list of [x, y]`.
std::string type_text_of(const ArgDeclaration& arg) {
  std::string columns;
  for (std::size_t i = 0; i < arg.columns.size(); ++i)
    columns += (i == 0 ? "" : ", ") + arg.columns[i] + (i >= arg.needed_columns() ? "?" : "");
  switch (arg.type) {
    case ArgType::number:
    case ArgType::integer:
    case ArgType::text:
    case ArgType::flag:
      return std::string(word_of(arg_type_words, arg.type));
    case ArgType::choice:
      return "text";
    case ArgType::numbers:
      return "list of numbers";
    case ArgType::tuple:
      return "[" + columns + "]";
    case ArgType::tuples:
      return "list of [" + columns + "]";
  }
  return {};
}

}  // namespace

void ArgDeclaration::read(ParamReader& in) {
  in.require("name");
  in.read("name", name, "name of the argument, which ends in its unit; --name-with-dashes on the command line");
  if (in.has("name") && !is_arg_name(name))
    in.error("name", "'name' must begin with a small letter and have letters, digits and single '_', got '" +
                         shortened(printable(name)) + "'");
  in.require("type");
  in.read_choice("type", type, arg_type_words, "what the value is");
  // Allowed values.
  std::optional<double> min, max;
  in.read("min", min, any_number(), "the least number allowed");
  in.read("max", max, any_number(), "the largest number allowed");
  if (min) range.low = *min;
  if (max) range.high = *max;
  in.read("choices", choices, "words of a choice");
  in.read("columns", columns, "names of the numbers of a tuple, with their units unless the name has one");
  in.read("min_columns", min_columns, at_least(1), "the columns after these may be left out; unset: none may");
  // Use of the argument.
  in.read("required", required, "the argument must be given");
  in.read("needs", needs, "arguments that must be given with this one");
  in.read("meaning", meaning, "description in one line");
  ParamInfo info;
  info.key = "default";
  info.initial = "~";
  info.meaning = "value when it is not given";
  in.describe(std::move(info));
  if (in.describing()) return;
  check_keys_of_type(in, *this);
  const ConfigNode* node = in.child("default");
  if (node == nullptr) return;
  if (required) return in.error("default", "'default' cannot be combined with 'required: true'");
  initial = *node;
  ArgDeclaration as_default = *this;
  as_default.name = "default";
  std::vector<std::string> words;
  append_words(as_default, *node, in.who(), in.diagnostics(), words);
}

std::size_t ArgDeclaration::needed_columns() const {
  return min_columns > 0 ? static_cast<std::size_t>(min_columns) : columns.size();
}

void ProgramDeclaration::read(ParamReader& in) {
  read_version(in, "shoal_args", shoal_args);
  in.require("program");
  in.read("program", program, "file name of the program; the declaration is NAME.args.yaml");
  in.read("meaning", meaning, "description in one sentence");
  // An absent list means that the channels are unknown, an empty one that there are none: only the latter can be
  // checked.
  const auto read_channels = [&in](const char* key, std::optional<std::vector<std::string>>& channels, const char* of) {
    std::vector<std::string> list;
    in.read(key, list, of);
    if (in.has(key)) channels = std::move(list);
  };
  read_channels("publishes", publishes, "channels it publishes on; {name} stands for the argument 'name'");
  read_channels("subscribes", subscribes, "channels it receives, likewise");
  in.read_list("args", args, "argument", "its arguments");
  if (args.size() > max_args)
    in.error("args",
             "'args' must have at most " + std::to_string(max_args) + " arguments, got " + std::to_string(args.size()));
  read_groups(in, "exactly_one", exactly_one, "groups of arguments of which exactly one must be given");
  read_groups(in, "at_most_one", at_most_one, "groups of arguments of which at most one may be given");
  if (in.describing()) return;
  check_channels(in, "publishes", publishes);
  check_channels(in, "subscribes", subscribes);
  check_names(in, *this);
}

const ArgDeclaration* ProgramDeclaration::find(const std::string& name) const {
  const auto found =
      std::find_if(args.begin(), args.end(), [&](const ArgDeclaration& arg) { return arg.name == name; });
  return found == args.end() ? nullptr : &*found;
}

ProgramDeclaration read_declaration(const std::string& text, const std::string& file, Diagnostics& diagnostics) {
  ProgramDeclaration declaration;
  ConfigNode node = parse_config_text(text, file, diagnostics);
  if (!diagnostics.ok()) return declaration;
  if (node.place.file == nullptr) node.place = {intern_file_name(file), 0, 0};  // an empty file
  ParamReader in(node, "", diagnostics);
  declaration.read(in);
  in.finish();
  return declaration;
}

std::string to_yaml(const ProgramDeclaration& declaration) {
  std::string text = "shoal_args: " + std::to_string(declaration.shoal_args) + "\n";
  const auto add = [&text](const char* key, const ConfigNode& node) {
    text += std::string(key) + ": " + to_flow_yaml(node) + "\n";
  };
  add("program", scalar(declaration.program));
  if (!declaration.meaning.empty()) add("meaning", text_node(declaration.meaning));
  if (declaration.publishes) add("publishes", list_node(*declaration.publishes));
  if (declaration.subscribes) add("subscribes", list_node(*declaration.subscribes));
  text += declaration.args.empty() ? "" : "args:\n";
  for (const ArgDeclaration& arg : declaration.args) text += "  - " + to_flow_yaml(node_of(arg)) + "\n";
  const auto add_groups = [&](const char* key, const std::vector<std::vector<std::string>>& groups) {
    if (groups.empty()) return;
    ConfigNode list;
    list.kind = Kind::list;
    for (const auto& group : groups) list.items.push_back(list_node(group));
    add(key, list);
  };
  add_groups("exactly_one", declaration.exactly_one);
  add_groups("at_most_one", declaration.at_most_one);
  return text;
}

std::vector<ParamInfo> param_table_of(const ProgramDeclaration& declaration) {
  std::vector<ParamInfo> table;
  for (const ArgDeclaration& arg : declaration.args) {
    ParamInfo info;
    info.key = arg.name;
    info.type = type_text_of(arg);
    info.rule = arg.choices.empty() ? arg.range.text() : "one of: " + list_text(arg.choices, arg.choices.size());
    info.required = arg.required;
    info.meaning = arg.meaning;
    if (!arg.needs.empty())
      info.meaning += (info.meaning.empty() ? "with " : "; with ") + list_text(arg.needs, arg.needs.size());
    if (!arg.required)
      info.initial = arg.initial ? to_flow_yaml(*arg.initial) : arg.type == ArgType::flag ? "false" : "~";
    table.push_back(std::move(info));
  }
  return table;
}

}  // namespace sim
