// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/commands/command_library.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "sim/config/file_access.hpp"

extern char** environ;

namespace tools {

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
