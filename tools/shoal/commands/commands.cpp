// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/commands/commands.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "sim/config/file_access.hpp"
#include "sim/program/find_program.hpp"

extern char** environ;

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

namespace {

namespace fs = std::filesystem;

/// Whether a library is there and not older than the program that loads it: CMake links it after the program.
bool is_current(const fs::path& library) {
  std::error_code none, error;
  const auto of_library = fs::last_write_time(library, none);
  const auto of_program = fs::last_write_time("/proc/self/exe", error);
  return !none && !error && of_library >= of_program;
}

/// Runs a program with our standard error as its output; returns whether it succeeded.  Ctrl-C ends both.
bool run_program(const std::vector<std::string>& arguments) {
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  pid_t pid = 0;
  const int error = posix_spawn(&pid, pointers[0], &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 1;
  while (error == 0 && waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
  return error == 0 && status == 0;
}

void build(const std::string& name, const fs::path& folder, const fs::path& library) {
  const std::string by_hand = "`cmake --build " + folder.string() + " --target shoal_" + name + "`";
  // One process builds at a time, and the others find the library then.
  const bridges::FileDescriptor lock(open((folder / ".command_libraries").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666));
  if (lock.number() < 0)
    throw std::runtime_error("the commands of '" + name + "' are not built, and " + folder.string() +
                             " cannot be written: " + std::strerror(errno) + "; its owner builds them by " + by_hand);
  flock(lock.number(), LOCK_EX);
  if (is_current(library)) return;
  if (!run_program({sim::shipped_folder() + "/tools/build_progress", "--title", name, folder, "shoal_" + name}))
    throw std::runtime_error("the commands of '" + name + "' could not be built; " + by_hand + " says more");
  // Up to date, although nothing was linked again.
  std::error_code ignored;
  fs::last_write_time(library, fs::file_time_type::clock::now(), ignored);
}

}  // namespace

void load_library(const std::string& name) {
  const fs::path folder = fs::path(sim::program_folder()).parent_path();
  const fs::path library = folder / "lib/shoal" / (name + ".so");
  std::error_code error;
  if (fs::exists(folder / "CMakeCache.txt", error) && !is_current(library)) build(name, folder, library);
  if (dlopen(library.c_str(), RTLD_NOW) == nullptr)
    throw std::runtime_error(std::string("the commands of '") + name + "' cannot be loaded: " + dlerror());
}

}  // namespace tools
