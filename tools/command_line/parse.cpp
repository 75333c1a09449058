// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/parse.hpp"

#include <unistd.h>

// The whole of CLI11 once: it defines the virtual functions of two classes in headers that <CLI/App.hpp>, which all
// other sources include, does not need; they are two seconds of compilation in each object.
#include <CLI/CLI.hpp>
#include <iostream>

#include "sim/base/text_layout.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/help.hpp"

namespace command_line {

namespace {

/// Replaces messages of CLI11.  After read_arguments() only errors of option values and combinations are left.
std::string in_our_words(const CLI::ParseError& error) {
  const std::string text = error.what();
  const auto replaced = [&text](const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    return at == std::string::npos ? text : text.substr(0, at) + by + text.substr(at + what.size());
  };
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    return replaced(" excludes ", " cannot be combined with ");
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr) return replaced(" requires ", " needs ");
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    const std::string begin = "Could not convert: ";
    const std::size_t equals = text.find(" = ");
    if (text.starts_with(begin) && equals != std::string::npos)
      return text.substr(begin.size(), equals - begin.size()) + ": must be a number, got '" + text.substr(equals + 3) +
             "'";
  }
  return text;
}

}  // namespace

int wrong_usage(const std::string& command, const std::string& what) {
  std::cerr << command << ": " << what << "\nSee `" << command << " --help`.\n";
  return exit_usage;
}

std::optional<int> parse(CLI::App& app, int argc, const char* const* argv) {
  Arguments arguments = read_arguments(app, std::vector<std::string>(argv + std::min(argc, 1), argv + argc));
  // The callback of a command may remove it from the tree of the app.
  const std::string path = command_path(*arguments.command);
  if (arguments.help) {
    std::cout << help_text(*arguments.command, static_cast<std::size_t>(sim::text_columns(STDOUT_FILENO)));
    return 0;
  }
  if (!arguments.wrong.empty()) return wrong_usage(path, arguments.wrong);
  try {
    app.parse(std::move(arguments.for_cli11));
    return std::nullopt;
  } catch (const CLI::CallForVersion& version) {
    std::cout << version.what() << '\n';
    return 0;
  } catch (const UsageError& error) {
    return wrong_usage(path, error.what());
  } catch (const CLI::ParseError& error) {
    return wrong_usage(path, in_our_words(error));
  }
}

}  // namespace command_line
