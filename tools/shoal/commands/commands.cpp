// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/commands/commands.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "sim/program/find_program.hpp"
#include "tools/shoal/commands/command_library.hpp"

namespace tools {

namespace {

struct Command {
  CommandGroup group;
  const char* name;
  const char* library;  ///< empty: the command is part of the program
  const char* description;
};

/// By name, those of the program first.
constexpr Command commands[] = {
#define SHOAL_COMMAND_ROW(library, group, name, description, add) {CommandGroup::group, name, library, description},
#include "tools/shoal/commands/command_table.inc"
#undef SHOAL_COMMAND_ROW
};

/// Headings of the help, in its order.
constexpr std::pair<CommandGroup, const char*> headings[] = {{CommandGroup::run, "run worlds"},
                                                             {CommandGroup::look, "look at runs"},
                                                             {CommandGroup::measure, "measure"},
                                                             {CommandGroup::make, "make files"},
                                                             {CommandGroup::connect, "work with a running simulator"}};

/// Commands that people know from other programs, and what does the same.
constexpr std::pair<const char*, const char*> calls_elsewhere[] = {
    {"play", "`shoal view LOG`, or `shoal replay --play LOG` for programs on a bus"},
    {"playback", "`shoal view LOG`, or `shoal replay --play LOG` for programs on a bus"},
    {"plot", "`shoal report DIR`, or `shoal.plots` in Python"},
    {"record", "`shoal run WORLD --record LOG`, or `shoal motion record` for a motion"},
    {"bag", "`shoal run WORLD --record LOG`, and `shoal log`"},
    {"version", "`shoal --version`"},
    {"start", "`shoal run WORLD`"},
    {"launch", "`shoal run WORLD --launch`"},
    {"sim", "`shoal run WORLD`"},
    {"topic", "`shoal spy`"},
    {"echo", "`shoal spy CHANNEL`"},
    {"msg", "`shoal describe TYPE`"},
    {"validate", "`shoal check FILE`"},
    {"lint", "`shoal check FILE`"},
    {"init", "`shoal new world NAME`"},
    {"create", "`shoal new world NAME`"},
    {"convert", "`shoal import`, `shoal log` or `shoal mesh`"},
    {"video", "`shoal film LOG`"},
    {"screenshot", "`shoal snap WORLD`"},
    {"benchmark", "`shoal study benchmark`, or `shoal bench` for the speed of this machine"},
};

/// Those that were registered since the last add_registered().
std::vector<AddCommand>& registered() {
  static std::vector<AddCommand> all;
  return all;
}

void add_registered(CLI::App& app, int& exit_code) {
  for (const AddCommand add : std::exchange(registered(), {})) add(app, exit_code);
}

}  // namespace

bool register_command(AddCommand add) {
  registered().push_back(add);
  return true;
}

std::string outside_command(const std::string& name) {
  const auto is_named = [&](const Command& command) { return command.name == name; };
  if (name.empty() || name.find('/') != std::string::npos || std::ranges::any_of(commands, is_named)) return {};
  for (const std::string& folder : sim::program_folders()) {
    const std::string path = folder + "/shoal-" + name;
    std::error_code none;
    if (std::filesystem::is_regular_file(path, none) && access(path.c_str(), X_OK) == 0) return path;
  }
  return {};
}

std::string meant_call(const std::string& name) {
  for (const auto& [known, call] : calls_elsewhere)
    if (name == known) return call;
  return {};
}

void list_commands(CLI::App& app) {
  for (const auto& [group, heading] : headings)
    for (const Command& command : commands)
      if (command.group == group) app.add_subcommand(command.name, command.description)->group(heading);
}

void complete_command(CLI::App& app, int& exit_code, const std::string& name) {
  for (const Command& command : commands)
    if (command.name == name && *command.library != '\0') load_library(command.library);
  add_registered(app, exit_code);
}

void complete_commands(CLI::App& app, int& exit_code) {
  for (const Command& command : commands) complete_command(app, exit_code, command.name);
}

}  // namespace tools
