// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/help.hpp"

#include <algorithm>
#include <set>
#include <sstream>

#include "sim/base/text_layout.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/parse.hpp"

namespace command_line {

namespace {

/// Returns the range of a value, from the names of its checks.  CLI11 appends them to the name of the type.
std::string rule_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  return colon == std::string::npos ? "" : type.substr(colon + 1);
}

std::string names_of(const CLI::Option& option) {
  std::string text;
  for (const std::string& name : option.get_snames()) text += (text.empty() ? "-" : ", -") + name;
  // Further long names are those of earlier versions.
  if (const auto& names = option.get_lnames(); !names.empty()) text += (text.empty() ? "--" : ", --") + names.front();
  if (option.get_items_expected_max() > 0) text += " " + value_name(option);
  return text;
}

/// Returns the description of an option, its range, its default, and the options that it requires.
std::string meaning_of(const CLI::Option& option) {
  std::vector<std::string> facts;
  const std::string rule = rule_of(option);
  const std::string& meaning = option.get_description();
  if (!rule.empty()) facts.push_back(rule);
  if (!option.get_default_str().empty()) facts.push_back("default " + option.get_default_str());
  if (option.get_items_expected_max() > 1 && !option.get_positional()) facts.push_back("repeatable");
  if (option.get_required() && !option.get_positional()) facts.push_back("required");
  const auto add_names = [&facts](const char* how, const std::set<CLI::Option*>& others) {
    std::vector<std::string> names;  // sorted, because the set is in the order of addresses
    for (const CLI::Option* other : others) names.push_back(option_name(*other));
    std::sort(names.begin(), names.end());
    if (!names.empty()) facts.push_back(how + alternatives(names));
  };
  add_names("with ", option.get_needs());
  add_names("not with ", option.get_excludes());
  std::string text;
  for (const std::string& fact : facts) text += (text.empty() ? "" : "; ") + fact;
  if (text.empty()) return meaning;
  return meaning.empty() ? text : meaning + " (" + text + ")";
}

std::string usage_of(const CLI::App& command, std::size_t columns) {
  const std::string begin = "Usage: " + command_path(command);
  std::string text = begin;
  const auto all = command.get_options(nullptr);
  if (std::any_of(all.begin(), all.end(), [](const CLI::Option* each) { return each->nonpositional(); }))
    text += " [OPTIONS]";
  for (const CLI::Option* option : all) {
    if (!option->get_positional()) continue;
    const std::string name = option->get_name(true) + (option->get_items_expected_max() > 1 ? "..." : "");
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  const bool places =
      std::any_of(all.begin(), all.end(), [](const CLI::Option* each) { return each->get_positional(); });
  if (!commands_of(command).empty()) text += places ? ", or " + command_path(command) + " COMMAND" : " COMMAND";
  return sim::wrapped(text, columns, std::min<std::size_t>(begin.size() + 1, 20)) + "\n";
}

using Rows = std::vector<std::pair<std::string, std::string>>;

std::string section(const std::string& title, const Rows& rows, std::size_t columns) {
  return rows.empty() ? "" : "\n" + title + ":\n" + sim::two_columns(rows, columns);
}

/// Splits a command into pieces that stay on one line: words, quoted texts, options with their values, the remark.
std::vector<std::string> pieces_of(const std::string& example) {
  std::vector<std::string> pieces;
  std::string piece;
  char quote = 0;
  // Join a value to its option.
  const auto finish = [&] {
    const bool is_value =
        !pieces.empty() && pieces.back().starts_with("--") && pieces.back().find(' ') == std::string::npos;
    if (!piece.empty() && is_value && !piece.starts_with("-"))
      pieces.back() += ' ' + piece;
    else if (!piece.empty())
      pieces.push_back(piece);
    piece.clear();
  };
  // Split at spaces outside of quotes; the remark is the last piece.
  for (std::size_t i = 0; i < example.size(); ++i) {
    const char c = example[i];
    if (quote == 0 && c == '#') {
      finish();
      pieces.push_back(' ' + example.substr(i));
      return pieces;
    }
    if (c == '\'' || c == '"') quote = quote == 0 ? c : quote == c ? '\0' : quote;
    if (c == ' ' && quote == 0)
      finish();
    else
      piece += c;
  }
  finish();
  return pieces;
}

/// Returns a command that can be typed: a long one continues after a backslash.
std::string example_text(const std::string& example, std::size_t columns) {
  std::string text;
  std::size_t used = 1;
  const auto add = [&](const std::string& piece) {
    const std::size_t width = sim::column_count(piece);
    if (!text.empty() && used + 1 + width > columns - 2) {
      text += " \\\n     ";
      used = 5;
    }
    text += (text.empty() ? "  " : " ") + piece;
    used += 1 + width;
  };
  for (const std::string& piece : pieces_of(example)) {
    // A value that does not fit beside its option is placed below it.
    const std::size_t space = piece.starts_with("--") ? piece.find(' ') : std::string::npos;
    if (space != std::string::npos && 6 + sim::column_count(piece) > columns - 2) {
      add(piece.substr(0, space));
      add(piece.substr(space + 1));
    } else {
      add(piece);
    }
  }
  return text + "\n";
}

/// Returns the footer: paragraphs are filled, lines that start with two spaces are examples or, with a number, exit
/// codes.
std::string end_text(const std::string& footer, std::size_t columns) {
  std::string text;
  Rows codes;
  std::istringstream in(footer);
  const auto flush_codes = [&] {
    text += codes.empty() ? "" : sim::two_columns(codes, columns);
    codes.clear();
  };
  for (std::string line; std::getline(in, line);) {
    const bool code = line.size() > 2 && line.starts_with("  ") && std::isdigit(static_cast<unsigned char>(line[2]));
    if (code) {
      const std::size_t end = line.find(' ', 2);
      codes.emplace_back(line.substr(2, end - 2), end == std::string::npos ? "" : line.substr(end + 1));
      continue;
    }
    flush_codes();
    text += line.starts_with("  ") ? example_text(line.substr(2), columns) : sim::wrapped(line, columns) + "\n";
  }
  flush_codes();
  return text;
}

}  // namespace

void set_help_end(CLI::App& command, const HelpEnd& end) {
  std::string text;
  if (!end.examples.empty()) text += end.examples.size() > 1 ? "Examples:\n" : "Example:\n";
  for (const std::string& example : end.examples) text += "  " + example + "\n";
  if (!end.exit_codes.empty()) text += (text.empty() ? "" : "\n") + std::string("Exit codes:\n");
  for (const auto& [code, meaning] : end.exit_codes) text += "  " + std::to_string(code) + " " + meaning + "\n";
  for (const std::string& note : end.notes) text += (text.empty() ? "" : "\n") + note + "\n";
  command.footer(text);
}

std::string help_text(const CLI::App& command, std::size_t columns) {
  std::string text = usage_of(command, columns) + "\n" + sim::wrapped(command.get_description(), columns) + "\n";
  Rows arguments, options, commands;
  for (const CLI::Option* option : command.get_options(nullptr))
    if (option->get_positional())
      arguments.emplace_back(option->get_name(true), meaning_of(*option));
    else
      // --help comes first, whatever the order in which the options were added.
      options.emplace(option == command.get_help_ptr() ? options.begin() : options.end(), names_of(*option),
                      meaning_of(*option));
  std::string group;
  const auto finish = [&] {
    text += section(group == command.get_group() ? "Commands" : "Commands to " + group, commands, columns);
    commands.clear();
  };
  for (const CLI::App* each : commands_of(command)) {
    if (each->get_group() != group) finish();
    group = each->get_group();
    commands.emplace_back(each->get_name(), each->get_description());
  }
  finish();
  text += section("Arguments", arguments, columns) + section("Options", options, columns);
  const std::string footer = command.get_footer();
  return footer.empty() ? text : text + "\n" + end_text(footer, columns);
}

std::string option_name(const CLI::Option& option) {
  return option.get_name(option.get_positional());
}

std::string value_name(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::string name = type.substr(0, type.find(':'));
  if (name == "FLOAT") return "NUMBER";
  if (name == "INT" || name == "UINT") return "N";
  return name.empty() ? "VALUE" : name;
}

}  // namespace command_line
