// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/child_program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>

extern char** environ;

namespace bridges {

namespace {

std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));  // exec does not write
  pointers.push_back(nullptr);
  return pointers;
}

bool open_as(int target, const char* path, int flags) {
  const int file = open(path, flags, 0644);
  return file >= 0 && (file == target || (dup2(file, target) >= 0 && close(file) == 0));
}

/// Resets the signal handlers and the mask, which would be inherited from the parent.
void take_usual_signals() {
  struct sigaction usual {};
  usual.sa_handler = SIG_DFL;
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) sigaction(signal, &usual, nullptr);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// Runs in the child, where nothing may be allocated, because other threads may have held locks.  Returns on failure.
void become(const ChildProgram& program, char* const* arguments, char* const* environment, pid_t parent) {
  take_usual_signals();  // first: the parent's handler would only note a SIGTERM that comes before the program runs
  if (program.stays) {
    if (setsid() < 0) return;
    close_range(STDERR_FILENO + 1, ~0u, CLOSE_RANGE_CLOEXEC);  // Linux 5.11; ours close at exec anyway
  } else {
    if (setpgid(0, 0) != 0 || prctl(PR_SET_PDEATHSIG, SIGTERM) != 0) return;
    if (getppid() != parent) _exit(128 + SIGTERM);  // it ended before it could be monitored
  }
  if (program.input >= 0 ? dup2(program.input, STDIN_FILENO) < 0 : !open_as(STDIN_FILENO, "/dev/null", O_RDONLY))
    return;
  // A stranger's folder may have a link or a FIFO in place of the log.
  if (!program.log.empty()) {
    if (!open_as(STDOUT_FILENO, program.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_NONBLOCK)) return;
    if (dup2(STDOUT_FILENO, STDERR_FILENO) < 0) return;
  }
  execvpe(program.path.c_str(), arguments, environment);
}

}  // namespace

bool is_program(const std::string& name) {
  const auto is_executable = [](const std::string& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
  };
  if (name.find('/') != std::string::npos) return is_executable(name);
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/bin:/usr/bin");  // without PATH as exec does
  for (std::string folder; std::getline(folders, folder, ':');)
    // An empty entry of PATH is the working folder (POSIX).
    if (is_executable((folder.empty() ? "." : folder) + "/" + name)) return true;
  return false;
}

std::vector<std::string> own_environment() {
  std::vector<std::string> environment;
  for (char** at = environ; *at != nullptr; ++at) environment.emplace_back(*at);
  return environment;
}

int start_child(const ChildProgram& program, pid_t& pid) {
  const std::vector<char*> arguments = pointers_to(program.arguments);
  const std::vector<char*> environment = pointers_to(program.environment);
  int ends[2];  // pipe for the error of a failed start; closed by a successful one
  if (pipe2(ends, O_CLOEXEC) != 0) return errno;
  // Child: execute the program, or send the error.
  const pid_t parent = getpid();
  pid = fork();
  if (pid == 0) {
    become(program, arguments.data(), environment.data(), parent);
    const int error = errno;
    const ssize_t reported = write(ends[1], &error, sizeof error);
    _exit(reported < 0 ? 126 : 127);
  }
  // Parent: wait for the error or the end of the pipe.
  const int fork_error = errno;
  close(ends[1]);
  int error = 0;
  if (pid < 0) {
    error = fork_error;
  } else {
    ssize_t size = 0;
    while ((size = read(ends[0], &error, sizeof error)) < 0 && errno == EINTR) {
    }
    if (size <= 0) error = 0;
    if (error != 0)
      while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
      }
  }
  close(ends[0]);
  return error;
}

std::string shell_word(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

}  // namespace bridges
