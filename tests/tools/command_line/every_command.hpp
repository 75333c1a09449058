// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>

#include <functional>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

// Finds the commands and options of programs in what they print, and tries each with mistakes.

namespace every_command {

using Words = std::vector<std::string>;

/// What a program did that was tried.
struct Tried {
  int exit_code = 0;
  std::string output, errors;
};
/// Calls a program with arguments.
using Try = std::function<Tried(const std::string& program, const Words& arguments)>;

struct Command {
  std::string program;
  Words words;  ///< `log`, `info`
  std::string help;
  std::string path() const {
    std::string text = program;
    for (const std::string& word : words) text += " " + word;
    return text;
  }
};

inline Words lines_of(const std::string& text) {
  Words lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Returns the lines of a section of a help that name something, such as its commands or options.
inline Words names_in(const std::string& help, const std::string& section) {
  Words names;
  bool inside = false;
  for (const std::string& line : lines_of(help)) {
    if (!line.empty() && line[0] != ' ') inside = line.starts_with(section) && line.back() == ':';
    if (inside && line.size() > 2 && line.starts_with("  ") && line[2] != ' ') names.push_back(line.substr(2));
  }
  return names;
}

inline std::string first_word(const std::string& text) {
  return text.substr(0, text.find(' '));
}

/// Returns every command of these programs, found by way of the helps.
inline std::vector<Command> all_commands(const Try& tried, const Words& programs) {
  std::vector<Command> commands;
  const std::function<void(const std::string&, const Words&)> add = [&](const std::string& program,
                                                                        const Words& words) {
    Words arguments = words;
    arguments.push_back("--help");
    const Tried help = tried(program, arguments);
    EXPECT_EQ(help.exit_code, 0) << program;
    EXPECT_EQ(help.errors, "");
    commands.push_back({program, words, help.output});
    for (const std::string& name : names_in(help.output, "Commands")) {
      Words more = words;
      more.push_back(first_word(name));
      add(program, more);
    }
  };
  for (const std::string& program : programs) add(program, {});
  return commands;
}

/// One option of a help: `--duration` and `S`, or `--quiet` and nothing.
struct OptionLine {
  std::string name, value;
};

inline std::vector<OptionLine> options_of(const Command& command) {
  static const std::regex pattern("(?:-\\w, )?(--[\\w-]+)(?: ([^ ]+))?(?:  .*)?");
  std::vector<OptionLine> options;
  for (const std::string& line : names_in(command.help, "Options")) {
    std::smatch match;
    EXPECT_TRUE(std::regex_match(line, match, pattern)) << command.path() << ": " << line;
    if (!match.empty() && match[1] != "--help" && match[1] != "--version") options.push_back({match[1], match[2]});
  }
  return options;
}

/// Tries each option without its value, or with one that it does not take.  Returns the number of options.
inline int expect_that_options_say_what_is_wrong(const Try& tried, const std::vector<Command>& commands) {
  static const std::regex inside("FLOAT|\\bU?INT\\b|CLI::|Error|Could not convert|required but|not expected|TEXT");
  int options = 0;
  for (const Command& command : commands)
    for (const OptionLine& option : options_of(command)) {
      ++options;
      std::vector<std::pair<Words, std::string>> wrong;
      if (option.value.empty()) {
        wrong.push_back({{option.name + "=maybe"}, option.name + " takes no value, got 'maybe'"});
      } else {
        wrong.push_back({{option.name}, option.name + " needs a value: " + option.name + " " + option.value});
        wrong.push_back({{option.name, "--help-me"}, option.name + " needs a value"});
      }
      for (const auto& [more, error] : wrong) {
        Words arguments = command.words;
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Tried ended = tried(command.program, arguments);
        EXPECT_EQ(ended.exit_code, 2) << command.path() << ' ' << option.name;
        EXPECT_THAT(ended.errors, testing::StartsWith(command.path() + ": " + error));
        EXPECT_THAT(ended.errors, testing::EndsWith("\nSee `" + command.path() + " --help`.\n"));
        std::smatch found;
        EXPECT_FALSE(std::regex_search(ended.errors, found, inside)) << ended.errors;
      }
    }
  return options;
}

/// Tries each option whose help names a range with what is outside of every range.  Returns the number of options.
inline int expect_that_ranges_are_kept(const Try& tried, const std::vector<Command>& commands) {
  static const std::regex range("\\((?:each )?from ");
  int options = 0;
  for (const Command& command : commands) {
    // Each option with its meaning on one line.
    const std::string text = std::regex_replace(command.help, std::regex("\n {8,}"), " ");
    for (const std::string& line : names_in(text, "Options")) {
      if (!std::regex_search(line, range)) continue;
      ++options;
      for (const char* value : {"abc", "nan", "1e99", ""}) {
        Words arguments = command.words;
        arguments.push_back(first_word(line) + "=" + value);
        const Tried ended = tried(command.program, arguments);
        EXPECT_EQ(ended.exit_code, 2) << command.path() << ' ' << line;
        // What is required and missing may be said first.
        EXPECT_THAT(ended.errors, testing::AnyOf(testing::HasSubstr("must be"), testing::HasSubstr("is required")))
            << line;
        EXPECT_EQ(lines_of(ended.errors).size(), 2u) << ended.errors;
      }
    }
  }
  return options;
}

}  // namespace every_command
