// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/completion.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include "tools/command_line/help.hpp"
#include "tools/command_line/parse.hpp"

namespace command_line {

namespace {

/// Completion of the value of an argument.
struct Value {
  enum class Kind { none, files, folders, words, words_or_files };
  Kind kind = Kind::none;
  std::string words;    ///< separated by spaces
  std::string command;  ///< prints further words
};

bool contains(const std::string& name, std::initializer_list<const char*> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const char* part) { return name.find(part) != std::string::npos; });
}

/// Returns the words of a rule such as `a, b or c`; empty for another rule, such as `from 1 to 5`.
std::string words_of_rule(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  if (colon == std::string::npos) return "";
  std::string rule = type.substr(colon + 1), words;
  if (const std::size_t last = rule.find(" or "); last != std::string::npos) rule.replace(last, 4, ", ");
  std::istringstream in(rule);
  for (std::string word; std::getline(in, word, ',');) {
    word.erase(0, word.find_first_not_of(' '));
    if (word.empty() || word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") != std::string::npos)
      return "";
    words += (words.empty() ? "" : " ") + word;
  }
  return words;
}

Value value_of(const CLI::Option& option, const WordCommands& word_commands) {
  if (option.get_items_expected_max() == 0) return {};
  const std::string name = option.get_positional() ? option.get_name(true) : value_name(option);
  if (const auto found = word_commands.find(name); found != word_commands.end())
    return {Value::Kind::words_or_files, "", found->second};
  if (std::string words = words_of_rule(option); !words.empty()) return {Value::Kind::words, std::move(words), ""};
  if (contains(name, {"DIR", "FOLDER"})) return {Value::Kind::folders, "", ""};
  if (contains(name, {"FILE", "LOG", "OUTPUT", "PATH", ".yaml", "MOTION", "SNAPSHOT", "TAKE", "STUDY"}))
    return {Value::Kind::files, "", ""};
  return {};
}

/// Calls `take` with the names of an option as they are typed: -h, --help.
template <class Take>
void for_each_name(const CLI::Option& option, const Take& take) {
  for (const std::string& name : option.get_snames()) take("-" + name);
  for (const std::string& name : option.get_lnames()) take("--" + name);
}

/// The name of a command's function, or of its case: `shoal motion play`.
std::string function_name(const CLI::App& command) {
  std::string name = "_" + command_path(command);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return name;
}

/// Returns the text within single quotes of a shell.
std::string in_quotes(const std::string& text) {
  std::string quoted_text = "'";
  for (const char c : text) quoted_text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted_text + "'";
}

/// The statement of bash that completes a value.
std::string bash_value(const Value& value) {
  switch (value.kind) {
    case Value::Kind::files:
      return "_files=1";
    case Value::Kind::folders:
      return "_folders=1";
    case Value::Kind::words:
      return "_words=" + in_quotes(value.words);
    case Value::Kind::words_or_files:
      return "_words=$(" + value.command + " 2>/dev/null) _files=1";
    case Value::Kind::none:
      break;
  }
  return ":";
}

/// Appends the cases of a command and those below it: where it is named, what its options take, what it offers.
struct BashCases {
  std::string commands, values, offers;

  void add(const CLI::App& command, const WordCommands& word_commands) {
    const std::string path = command_path(command);
    std::string words, positional = ":";
    for (const CLI::App* below : commands_of(command)) {
      words += below->get_name() + " ";
      commands += (commands.empty() ? "" : " | ") + in_quotes(command_path(*below));
    }
    for (const CLI::Option* option : command.get_options(nullptr)) {
      const Value value = value_of(*option, word_commands);
      if (option->get_positional()) {
        if (value.kind != Value::Kind::none) positional = bash_value(value);
        continue;
      }
      for_each_name(*option, [&](const std::string& name) {
        words += name + " ";
        if (option->get_items_expected_max() > 0)
          values += "    " + in_quotes(path + " " + name) + ") " + bash_value(value) + " ;;\n";
      });
    }
    // bash splits the list at blanks, so the last one must go.
    if (!words.empty()) words.pop_back();
    offers += "      " + in_quotes(path) + ") " + positional + "; _words+=\" \"" + in_quotes(words) + " ;;\n";
    for (const CLI::App* below : commands_of(command)) add(*below, word_commands);
  }
};

/// Returns a text for a specification of zsh's _arguments, in which brackets and colons are special.
std::string zsh_text(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') safe += '\\';
    safe += c;
  }
  return safe;
}

std::string zsh_value(const std::string& name, const Value& value) {
  const std::string begin = ":" + zsh_text(name) + ":";
  switch (value.kind) {
    case Value::Kind::files:
      return begin + "_files";
    case Value::Kind::folders:
      return begin + "_files -/";
    case Value::Kind::words:
      return begin + "(" + value.words + ")";
    case Value::Kind::words_or_files:
      return begin + "{ _files; compadd -- ${(f)\"$(" + value.command + " 2>/dev/null)\"} }";
    case Value::Kind::none:
      break;
  }
  return begin + " ";
}

/// Returns the functions of a command and those below it.
std::string zsh_functions(const CLI::App& command, const WordCommands& word_commands) {
  std::string specs, functions, list, cases;
  for (const CLI::Option* option : command.get_options(nullptr)) {
    const Value value = value_of(*option, word_commands);
    if (option->get_positional()) {
      specs += " \\\n    " + in_quotes("*" + zsh_value(option->get_name(true), value));
      continue;
    }
    const bool takes = option->get_items_expected_max() > 0;
    for_each_name(*option, [&](const std::string& name) {
      specs += " \\\n    " +
               in_quotes((option->get_items_expected_max() > 1 ? "*" : "") + name +
                         (takes && name.starts_with("--") ? "=" : "") + "[" + zsh_text(option->get_description()) +
                         "]" + (takes ? zsh_value(value_name(*option), value) : ""));
    });
  }
  for (const CLI::App* below : commands_of(command)) {
    functions += zsh_functions(*below, word_commands);
    list += "\n      " + in_quotes(zsh_text(below->get_name()) + ":" + below->get_description());
    cases += "        " + below->get_name() + ") " + function_name(*below) + " ;;\n";
  }
  if (list.empty()) return functions + function_name(command) + "() {\n  _arguments" + specs + "\n}\n\n";
  return functions + function_name(command) + "() {\n  local state line\n  local -a commands=(" + list +
         "\n  )\n  _arguments -C" + specs +
         " \\\n    '1: :->command' '*:: :->arguments'\n  case $state in\n    command) _describe command commands ;;\n"
         "    arguments)\n      case $line[1] in\n" +
         cases + "      esac ;;\n  esac\n}\n\n";
}

}  // namespace

std::string bash_completion(const CLI::App& app, const WordCommands& word_commands) {
  BashCases cases;
  cases.add(app, word_commands);
  const std::string& name = app.get_name();
  const std::string function = function_name(app);
  return "# Completion of " + name + " for bash.\n" + function +
         "() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} path=" +
         name +
         " i _words= _files= _folders=\n"
         "  # bash splits --option=value into three words.\n"
         "  [ \"$word\" != = ] || word=\n"
         "  [ \"$previous\" != = ] || previous=${COMP_WORDS[COMP_CWORD-2]}\n"
         "  [ \"${COMP_WORDS[COMP_CWORD]}\" != = ] || previous=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    case \"$path ${COMP_WORDS[i]}\" in\n"
         "      " +
         cases.commands +
         ") path+=\" ${COMP_WORDS[i]}\" ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"$path $previous\" in\n" +
         cases.values +
         "    *)\n"
         "    case \"$path\" in\n" +
         cases.offers +
         "    esac ;;\n"
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$_words\" -- \"$word\"))\n"
         "  [ -z \"$_files\" ] || mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- \"$word\")\n"
         "  [ -z \"$_folders\" ] || mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- \"$word\")\n"
         "}\n"
         "complete -o filenames -F " +
         function + " " + name + "\n";
}

std::string zsh_completion(const CLI::App& app, const WordCommands& word_commands) {
  return "#compdef " + app.get_name() + "\n# Completion of " + app.get_name() + " for zsh.\n" +
         zsh_functions(app, word_commands) + function_name(app) + " \"$@\"\n";
}

}  // namespace command_line
