// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/declared_options.hpp"

#include <algorithm>
#include <cctype>
#include <iostream>
#include <limits>
#include <vector>

#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/plugin.hpp"
#include "sim/program/program_args.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/parse.hpp"

namespace command_line {
namespace {

using sim::ArgDeclaration;
using sim::ArgType;

ArgDeclaration declared(const std::string& key, ArgType type, const std::string& meaning) {
  ArgDeclaration arg;
  arg.name = key;
  arg.type = type;
  arg.meaning = meaning;
  return arg;
}

void set_initial(ArgDeclaration& arg, const std::string& text) {
  arg.initial = sim::scalar_node(text, {});
}

/// Returns `[X,Y]` for the columns x and y.
std::string form_of(const std::vector<std::string>& columns) {
  std::string form;
  for (std::string column : columns) {
    column = column.substr(0, column.find('_'));
    std::transform(column.begin(), column.end(), column.begin(), [](unsigned char c) { return std::toupper(c); });
    form += (form.empty() ? "" : ",") + column;
  }
  return "[" + form + "]";
}

/// Replaces the source place of errors by the name of the option.
void set_place(sim::ConfigNode& node, const sim::SourcePlace& place) {
  node.place = place;
  for (sim::ConfigNode& item : node.items) set_place(item, place);
  for (sim::ConfigNode::Entry& entry : node.entries) set_place(entry.value, place);
}

std::vector<std::vector<double>> parse_lists(const ArgDeclaration& arg, const std::string& text) {
  const std::string option = sim::option_of(arg.name);
  sim::Diagnostics diagnostics;
  sim::ConfigNode node = sim::parse_config_text(text, option, diagnostics);
  set_place(node, {sim::intern_file_name(option), 0, 0});
  std::vector<std::vector<double>> lists;
  if (diagnostics.ok()) lists = sim::read_tuples(arg, node, "", diagnostics);
  if (!diagnostics.ok()) throw UsageError(diagnostics.lines().front());
  return lists;
}

}  // namespace

DeclaredOptions::Added& DeclaredOptions::Added::required_in_worlds() {
  ArgDeclaration& arg = options_.declaration_.args[index_];
  arg.required = true;
  arg.initial.reset();
  option_->default_str("");
  return *this;
}

DeclaredOptions::Added& DeclaredOptions::Added::required() {
  option_->required();
  return required_in_worlds();
}

DeclaredOptions::Added& DeclaredOptions::Added::by_default(const std::vector<double>& numbers) {
  sim::ConfigNode list;
  list.kind = sim::ConfigNode::Kind::list;
  for (const double number : numbers) list.items.push_back(sim::scalar_node(sim::number_text(number), {}));
  option_->default_str(sim::to_flow_yaml(list));
  options_.declaration_.args[index_].initial = std::move(list);
  return *this;
}

DeclaredOptions::Added& DeclaredOptions::Added::needs(std::vector<std::string> keys) {
  options_.declaration_.args[index_].needs = std::move(keys);
  return *this;
}

DeclaredOptions::DeclaredOptions(CLI::App& app) : app_(app) {
  declaration_.program = app.get_name();
  declaration_.meaning = app.get_description();
  app.set_help_flag("-h,--help", "print this help");
  app.add_flag("--describe", describe_, "print the declaration of these options, NAME.args.yaml");
}

template <class Value>
CLI::Option* DeclaredOptions::bind(const std::string& key, Value& value, const std::string& meaning) {
  return app_.add_option(sim::option_of(key), value, meaning);
}

DeclaredOptions::Added DeclaredOptions::add(ArgDeclaration arg, CLI::Option* option) {
  declaration_.args.push_back(std::move(arg));
  return {*this, declaration_.args.size() - 1, option};
}

DeclaredOptions::Added DeclaredOptions::number(const std::string& key, double& value, double low, double high,
                                               const std::string& meaning) {
  ArgDeclaration arg = declared(key, ArgType::number, meaning);
  arg.range = sim::between(low, high);
  set_initial(arg, sim::number_text(value));
  return add(std::move(arg), bind(key, value, meaning)->capture_default_str()->check(number_from(low, high)));
}

DeclaredOptions::Added DeclaredOptions::number(const std::string& key, std::optional<double>& value, double low,
                                               double high, const std::string& meaning) {
  ArgDeclaration arg = declared(key, ArgType::number, meaning);
  arg.range = sim::between(low, high);
  return add(std::move(arg), bind(key, value, meaning)->type_name("NUMBER")->check(number_from(low, high)));
}

DeclaredOptions::Added DeclaredOptions::integer(const std::string& key, int& value, int low, int high,
                                                const std::string& meaning) {
  ArgDeclaration arg = declared(key, ArgType::integer, meaning);
  arg.range = sim::between(low, high);
  set_initial(arg, std::to_string(value));
  return add(std::move(arg), bind(key, value, meaning)->capture_default_str()->check(whole_from(low, high)));
}

DeclaredOptions::Added DeclaredOptions::integer(const std::string& key, std::optional<int>& value, int low, int high,
                                                const std::string& meaning) {
  ArgDeclaration arg = declared(key, ArgType::integer, meaning);
  arg.range = sim::between(low, high);
  return add(std::move(arg), bind(key, value, meaning)->type_name("N")->check(whole_from(low, high)));
}

DeclaredOptions::Added DeclaredOptions::seed(const std::string& key, std::uint64_t& value, const std::string& meaning) {
  ArgDeclaration arg = declared(key, ArgType::integer, meaning);
  arg.range = sim::at_least(0);
  set_initial(arg, std::to_string(value));
  return add(std::move(arg),
             bind(key, value, meaning)->type_name("N")->capture_default_str()->check(command_line::seed()));
}

DeclaredOptions::Added DeclaredOptions::text(const std::string& key, const char* shown, std::string& value,
                                             const std::string& meaning) {
  ArgDeclaration arg = declared(key, ArgType::text, meaning);
  if (!value.empty()) set_initial(arg, value);
  return add(std::move(arg), bind(key, value, meaning)->type_name(shown)->capture_default_str()->check(not_empty()));
}

DeclaredOptions::Added DeclaredOptions::flag(const std::string& key, bool& value, const std::string& meaning) {
  return add(declared(key, ArgType::flag, meaning), app_.add_flag(sim::option_of(key), value, meaning));
}

DeclaredOptions::Added DeclaredOptions::choice(const std::string& key, std::string& value,
                                               const std::vector<std::string>& words, const std::string& meaning) {
  ArgDeclaration arg = declared(key, ArgType::choice, meaning);
  arg.choices = words;
  set_initial(arg, value);
  return add(std::move(arg), bind(key, value, meaning)->type_name("WORD")->capture_default_str()->check(one_of(words)));
}

DeclaredOptions::Added DeclaredOptions::choice(const std::string& key, int& value,
                                               const std::vector<std::string>& words, const std::string& meaning) {
  ArgDeclaration arg = declared(key, ArgType::choice, meaning);
  arg.choices = words;
  set_initial(arg, std::to_string(value));
  return add(std::move(arg), bind(key, value, meaning)->type_name("N")->capture_default_str()->check(one_of(words)));
}

CLI::Option* DeclaredOptions::bind_list(const ArgDeclaration& arg, const std::string& form, TakeLists take) {
  const auto read = [arg, take = std::move(take)](const std::string& text) { take(parse_lists(arg, text)); };
  return app_.add_option_function<std::string>(sim::option_of(arg.name), read, arg.meaning)->type_name(form);
}

DeclaredOptions::Added DeclaredOptions::tuple(const std::string& key, const std::vector<std::string>& columns,
                                              const sim::Rule& range, TakeList take, const std::string& meaning) {
  ArgDeclaration arg = declared(key, ArgType::tuple, meaning);
  arg.range = range;
  arg.columns = columns;
  CLI::Option* option =
      bind_list(arg, form_of(columns), [take = std::move(take)](const auto& lists) { take(lists.front()); });
  return add(std::move(arg), option);
}

DeclaredOptions::Added DeclaredOptions::tuples(const std::string& key, const std::vector<std::string>& columns,
                                               std::size_t min_columns, const sim::Rule& range, TakeLists take,
                                               const std::string& meaning) {
  ArgDeclaration arg = declared(key, ArgType::tuples, meaning);
  arg.range = range;
  arg.columns = columns;
  if (min_columns < columns.size()) arg.min_columns = static_cast<int>(min_columns);
  CLI::Option* option = bind_list(arg, "[" + form_of(columns) + ",...]", std::move(take));
  return add(std::move(arg), option);
}

CLI::Option* DeclaredOptions::option_of(const std::string& key) const {
  return app_.get_option(sim::option_of(key));
}

void DeclaredOptions::connect_options() {
  for (const ArgDeclaration& arg : declaration_.args)
    for (const std::string& needed : arg.needs) option_of(arg.name)->needs(option_of(needed));
  for (const auto* groups : {&declaration_.exactly_one, &declaration_.at_most_one})
    for (const auto& group : *groups)
      for (std::size_t i = 0; i < group.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) option_of(group[i])->excludes(option_of(group[j]));
}

void DeclaredOptions::check_groups() const {
  for (const auto& group : declaration_.exactly_one) {
    if (std::any_of(group.begin(), group.end(), [&](const auto& key) { return option_of(key)->count() > 0; })) continue;
    std::vector<std::string> options;
    for (const std::string& key : group) options.push_back(sim::option_of(key));
    throw UsageError("needs " + alternatives(options));
  }
}

std::optional<int> DeclaredOptions::parse(int argc, const char* const* argv) {
  // Alone and first: required options must not stand in its way, for builds call it.
  if (argc == 2 && std::string(argv[1]) == "--describe") {
    std::cout << to_yaml(declaration_) << std::flush;
    return std::cout ? 0 : 4;
  }
  connect_options();
  if (const auto exit_code = command_line::parse(app_, argc, argv)) return exit_code;
  try {
    if (describe_) throw UsageError("--describe takes no other options");
    check_groups();
  } catch (const UsageError& error) {
    return wrong_usage(app_.get_name(), error.what());
  }
  return std::nullopt;
}

namespace {

void split_names(const std::string& option, const std::string& text, std::vector<std::string>& names) {
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end == begin) throw CLI::ValidationError(option, "must be names, comma separated, got " + quoted(text));
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

}  // namespace

CLI::Option* add_name_list(CLI::App& command, const std::string& option, std::vector<std::string>& names,
                           const std::string& meaning) {
  return command
      .add_option_function<std::vector<std::string>>(
          option,
          [option, &names](const std::vector<std::string>& texts) {
            names.clear();
            for (const std::string& text : texts) split_names(option, text, names);
          },
          meaning)
      ->type_name("NAMES")
      ->type_size(1)
      ->allow_extra_args(false);
}

void load_plugin(const std::string& file) {
  sim::Diagnostics diagnostics;
  const sim::SourcePlace place{sim::intern_file_name("--plugin " + file), 0, 0};
  const std::string found = sim::find_plugin(file, "");
  sim::load_plugin(found.empty() ? file : found, place, "", diagnostics);
  diagnostics.throw_if_any();
}

void add_plugin_option(CLI::App& command) {
  const auto load_all = [](const std::vector<std::string>& files) {
    for (const std::string& file : files) load_plugin(file);
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--plugin", load_all, "plugin library with additional devices, metrics, actions or algorithms")
      ->type_name("FILE")
      ->type_size(1)
      ->allow_extra_args(false);
}

}  // namespace command_line
