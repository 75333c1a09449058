// SPDX-License-Identifier: BSD-3-Clause
#include "sim/program/program_args.hpp"

#include <algorithm>

#include "sim/config/message_text.hpp"

namespace sim {

namespace {

/// Unknown arguments that are reported.
constexpr std::size_t max_unknown = 20;

using Kind = ConfigNode::Kind;

// Maximum length of a word on a Linux command line (MAX_ARG_STRLEN, 32 pages with the terminating zero).
constexpr std::size_t max_word = 131071;

std::string json_of(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ",") + number_text(number);
  return "[" + text + "]";
}

std::string json_of(const std::vector<std::vector<double>>& lists) {
  std::string text;
  for (const auto& numbers : lists) text += (text.empty() ? "" : ",") + json_of(numbers);
  return "[" + text + "]";
}

/// Reads one list of numbers.  `name`: its name in errors.
bool read_numbers(const ArgDeclaration& arg, const std::string& name, const ConfigNode& value, const std::string& who,
                  Diagnostics& diagnostics, std::vector<double>& numbers) {
  const std::size_t before = diagnostics.lines().size();
  const std::size_t min = arg.needed_columns(), count = arg.columns.size();
  const std::string how_many = std::to_string(min) + (min == count ? "" : " to " + std::to_string(count)) +
                               (count == 1 ? " number" : " numbers");
  if (value.kind != Kind::list) {
    diagnostics.error(
        value.place, who,
        "'" + name + "' must be a list of " + (count == 0 ? "numbers" : how_many) + ", got " + shown(value));
    return false;
  }
  if (count > 0 && (value.items.size() < min || value.items.size() > count)) {
    diagnostics.error(value.place, who,
                      "'" + name + "' must be " + how_many + ", got " + std::to_string(value.items.size()));
    return false;
  }
  const ConfigNode map = map_node(name, value);
  ParamReader in(map, who, diagnostics);
  in.read(name.c_str(), numbers, arg.range, "");
  return diagnostics.lines().size() == before;
}

const ConfigNode* value_of(const ProgramDeclaration& declaration, const ConfigNode& args, const std::string& name) {
  if (const ConfigNode* value = args.find(name)) return value;
  const ArgDeclaration* arg = declaration.find(name);
  return arg != nullptr && arg->initial ? &*arg->initial : nullptr;
}

/// Whether a missing argument is there under a misspelled name, which has been reported.
bool is_misspelled(const ProgramDeclaration& declaration, const ConfigNode& args, const std::string& name) {
  std::size_t unknown = 0;
  for (const ConfigNode::Entry& entry : args.entries) {
    if (declaration.find(entry.key) != nullptr) continue;
    if (++unknown > max_unknown) return false;
    if (!did_you_mean(entry.key, {name}).empty()) return true;
  }
  return false;
}

void check_unknown(const ProgramDeclaration& declaration, const ConfigNode& args, const std::string& who,
                   Diagnostics& diagnostics) {
  std::vector<std::string> known;
  for (const ArgDeclaration& arg : declaration.args) known.push_back(arg.name);
  std::size_t unknown = 0;
  for (const ConfigNode::Entry& entry : args.entries) {
    if (declaration.find(entry.key) != nullptr) continue;
    if (++unknown > max_unknown) return diagnostics.error(entry.place, who, "more unknown arguments are not shown");
    const std::string meant = did_you_mean(entry.key, known);
    diagnostics.error(entry.place, who,
                      "unknown argument '" + shortened(printable(entry.key)) + "'" +
                          (meant.empty() ? "; known arguments: " + list_text(known, known.size()) : meant));
  }
}

/// Checks required arguments and groups of arguments.
void check_together(const ProgramDeclaration& declaration, const ConfigNode& args, const SourcePlace& place,
                    const std::string& who, Diagnostics& diagnostics) {
  for (const ArgDeclaration& arg : declaration.args) {
    const ConfigNode* value = args.find(arg.name);
    if (arg.required && value == nullptr && !is_misspelled(declaration, args, arg.name))
      diagnostics.error(place, who, "missing argument '" + arg.name + "'");
    if (value == nullptr) continue;
    for (const std::string& needed : arg.needs)
      if (args.find(needed) == nullptr)
        diagnostics.error(value->place, who, "'" + arg.name + "' needs the argument '" + needed + "'");
  }
  const auto check_groups = [&](const std::vector<std::vector<std::string>>& groups, bool one_needed) {
    for (const auto& group : groups) {
      std::vector<std::string> given;
      const ConfigNode* last = nullptr;
      for (const std::string& name : group)
        if (const ConfigNode* value = args.find(name)) {
          given.push_back("'" + name + "'");
          last = value;
        }
      if (given.size() > 1)
        diagnostics.error(
            last->place, who,
            "of " + list_text(group, group.size()) + " only one may be given, got " + list_text(given, given.size()));
      if (given.empty() && one_needed)
        diagnostics.error(place, who, "missing argument: one of " + list_text(group, group.size()));
    }
  };
  check_groups(declaration.exactly_one, true);
  check_groups(declaration.at_most_one, false);
}

}  // namespace

std::string option_of(const std::string& arg_name) {
  std::string option = "--" + arg_name;
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

std::vector<std::vector<double>> read_tuples(const ArgDeclaration& arg, const ConfigNode& value, const std::string& who,
                                             Diagnostics& diagnostics) {
  std::vector<std::vector<double>> tuples;
  if (arg.type != ArgType::tuples) {
    if (std::vector<double> numbers; read_numbers(arg, arg.name, value, who, diagnostics, numbers))
      tuples.push_back(std::move(numbers));
    return tuples;
  }
  if (value.kind != Kind::list) {
    diagnostics.error(value.place, who,
                      "'" + arg.name + "' must be a list of [" + list_text(arg.columns, arg.columns.size()) +
                          "], got " + shown(value));
    return tuples;
  }
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    std::vector<double> numbers;
    const std::string name = arg.name + "[" + std::to_string(i + 1) + "]";
    if (read_numbers(arg, name, value.items[i], who, diagnostics, numbers)) tuples.push_back(std::move(numbers));
  }
  return tuples;
}

void append_words(const ArgDeclaration& arg, const ConfigNode& value, const std::string& who, Diagnostics& diagnostics,
                  std::vector<std::string>& words) {
  const std::size_t errors = diagnostics.lines().size();
  const char* const key = arg.name.c_str();
  const ConfigNode map = map_node(arg.name, value);
  ParamReader in(map, who, diagnostics);
  std::string text;
  switch (arg.type) {
    case ArgType::number: {
      double number = 0;
      in.read(key, number, arg.range, "");
      text = number_text(number);
      break;
    }
    case ArgType::integer: {
      std::int64_t number = 0;
      in.read(key, number, arg.range, "");
      text = std::to_string(number);
      break;
    }
    case ArgType::text:
      in.read(key, text, "");
      break;
    case ArgType::flag: {
      bool flag = false;
      in.read(key, flag, "");
      if (flag) words.push_back(option_of(arg.name));
      return;
    }
    case ArgType::choice:
      in.read_one_of(key, text, arg.choices, "");
      break;
    case ArgType::numbers:
    case ArgType::tuple: {
      const auto lists = read_tuples(arg, value, who, diagnostics);
      if (!lists.empty()) text = json_of(lists.front());
      break;
    }
    case ArgType::tuples:
      text = json_of(read_tuples(arg, value, who, diagnostics));
      break;
  }
  if (diagnostics.lines().size() != errors) return;
  // `--name=value` in one word: a negative number or a text that begins with '-' as a separate word would be taken
  // for an option.
  std::string word = option_of(arg.name) + "=" + text;
  if (word.size() > max_word)
    return diagnostics.error(value.place, who,
                             "'" + arg.name + "' must have at most " + std::to_string(max_word) +
                                 " bytes on the command line, got " + std::to_string(word.size()));
  words.push_back(std::move(word));
}

std::vector<std::string> command_line_of(const ProgramDeclaration& declaration, const ConfigNode& args,
                                         const SourcePlace& place, const std::string& who, Diagnostics& diagnostics) {
  std::vector<std::string> words;
  check_unknown(declaration, args, who, diagnostics);
  for (const ConfigNode::Entry& entry : args.entries)
    if (const ArgDeclaration* arg = declaration.find(entry.key))
      append_words(*arg, entry.value, who, diagnostics, words);
  check_together(declaration, args, place, who, diagnostics);
  return words;
}

std::string text_of_arg(const ProgramDeclaration& declaration, const ConfigNode& args, const std::string& name) {
  const ConfigNode* value = value_of(declaration, args, name);
  return value != nullptr && value->kind == Kind::scalar ? value->scalar : std::string();
}

std::string channel_of(const ProgramDeclaration& declaration, const ConfigNode& args, const std::string& pattern) {
  std::string channel = pattern;
  for (std::size_t open = channel.find('{'); open != std::string::npos; open = channel.find('{', open)) {
    const std::size_t close = channel.find('}', open);
    if (close == std::string::npos) break;
    const std::string text = text_of_arg(declaration, args, channel.substr(open + 1, close - open - 1));
    if (text.empty()) return {};
    channel.replace(open, close + 1 - open, text);
    // An inserted text may contain braces, which are not placeholders.
    open += text.size();
  }
  return channel;
}

}  // namespace sim
