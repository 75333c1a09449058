// SPDX-License-Identifier: BSD-3-Clause
#include "tools/navigation/python/python_host.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/navigation/python/host_files.hpp"

extern char** environ;

namespace navigation {

namespace {

/// A pipe whose ends close in programs started later.
std::array<bridges::FileDescriptor, 2> new_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::invalid_argument(std::string("no pipe to Python: ") + std::strerror(errno));
  return {bridges::FileDescriptor(ends[0]), bridges::FileDescriptor(ends[1])};
}

}  // namespace

PythonHost::PythonHost(const std::string& file, const std::string& class_name)
    : what_("python:" + file + "." + class_name) {
  std::signal(SIGPIPE, SIG_IGN);  // a child that ended is an error of the write
  auto requests = new_pipe(), answers = new_pipe();
  const HostFile& host = host_files().front();
  std::string code(reinterpret_cast<const char*>(host.begin), reinterpret_cast<const char*>(host.end));
  const char* interpreter = std::getenv("SHOAL_PYTHON");
  if (interpreter == nullptr) interpreter = "/usr/bin/python3";
  char* const arguments[] = {const_cast<char*>(interpreter), const_cast<char*>("-c"), code.data(), nullptr};
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, requests[0].number(), 0);
  posix_spawn_file_actions_adddup2(&files, answers[1].number(), 1);
  const int error = posix_spawnp(&child_, interpreter, &files, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0)
    throw std::invalid_argument(what_ + ": '" + interpreter + "' does not start: " + std::strerror(error));
  to_child_ = std::move(requests[1]);
  from_child_ = std::move(answers[0]);
  // Only the child keeps the other ends, so that its end is seen.
  for (bridges::FileDescriptor* end : {&requests[0], &answers[1]})
    const bridges::FileDescriptor closed = std::move(*end);
  try {
    has_saw_ = request({{"do", "load"}, {"id", 0}, {"path", file + ".py"}, {"class", class_name}}).value("saw", false);
  } catch (...) {
    end();
    throw;
  }
}

PythonHost::~PythonHost() {
  end();
}

void PythonHost::end() {
  { const bridges::FileDescriptor closed = std::move(to_child_); }  // the end of its input
  waitpid(child_, nullptr, 0);
}

void PythonHost::send(const nlohmann::json& request) {
  const std::string line = request.dump() + "\n";
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t written = write(to_child_.number(), line.data() + done, line.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw std::invalid_argument(what_ + ": its interpreter has ended");
    done += static_cast<std::size_t>(written);
  }
}

nlohmann::json PythonHost::request(const nlohmann::json& request) {
  send(request);
  std::size_t end;
  while ((end = unread_.find('\n')) == std::string::npos) {
    char buffer[4096];
    const ssize_t got = read(from_child_.number(), buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw std::invalid_argument(what_ + ": its interpreter has ended");
    unread_.append(buffer, static_cast<std::size_t>(got));
  }
  const nlohmann::json answer = nlohmann::json::parse(unread_.substr(0, end), nullptr, false);
  unread_.erase(0, end + 1);
  if (!answer.is_object())
    throw std::invalid_argument(what_ + ": its interpreter gives no answers: it must be Python 3");
  if (answer.contains("error")) throw std::invalid_argument(what_ + ": " + answer.value("error", "unknown"));
  return answer;
}

}  // namespace navigation
