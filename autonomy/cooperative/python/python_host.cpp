// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/python/python_host.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "autonomy/cooperative/estimator/estimator.hpp"
#include "autonomy/cooperative/python/host_files.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"

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

/// Wall time for an answer, by the environment.
double limit_of_environment() {
  constexpr double default_s = 60, min_s = 0.01, max_s = 1e6;
  const char* const text = std::getenv("SHOAL_PYTHON_LIMIT_S");
  if (text == nullptr) return default_s;
  const double limit_s = sim::read_number(text).value_or(0);
  if (!(limit_s >= min_s && limit_s <= max_s))
    throw std::invalid_argument("SHOAL_PYTHON_LIMIT_S must be a number from 0.01 to 1e6, got '" +
                                sim::shortened(sim::printable(text)) + "'");
  return limit_s;
}

/// Whether a descriptor is ready for these events within a time; an end of the other side counts as ready.
bool is_ready(int descriptor, short events, double limit_s) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd waited{descriptor, events, 0};
    const int ready = poll(&waited, 1, static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000)));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return true;  // the read or write has the error
    if (ready == 0 && left <= 0) return false;
  }
}

}  // namespace

PythonHost::PythonHost(const std::string& file, const std::string& class_name)
    : what_("python:" + file + "." + class_name), limit_s_(limit_of_environment()) {
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
  fcntl(requests[1].number(), F_SETFL, O_NONBLOCK);  // the child may take no requests
  to_child_ = std::move(requests[1]);
  from_child_ = std::move(answers[0]);
  // Only the child keeps the other ends, so that its end is seen.
  for (bridges::FileDescriptor* end : {&requests[0], &answers[1]})
    const bridges::FileDescriptor closed = std::move(*end);
  try {
    has_on_bearing_ =
        request({{"do", "load"}, {"id", 0}, {"path", file + ".py"}, {"class", class_name}}).value("on_bearing", false);
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
  // The child closes its output when it ends, unless the class never returns.
  constexpr double timeout_s = 2;
  char rest[4096];
  while (!is_stuck_ && is_ready(from_child_.number(), POLLIN, std::min(timeout_s, limit_s_)) &&
         read(from_child_.number(), rest, sizeof rest) > 0) {
  }
  if (child_ <= 0) return;
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

double PythonHost::cpu_s() const {
  clockid_t clock{};
  timespec used{};
  if (clock_getcpuclockid(child_, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

void PythonHost::wait_for(const bridges::FileDescriptor& descriptor, short events, const nlohmann::json& request) {
  if (!is_stuck_ && is_ready(descriptor.number(), events, limit_s_)) return;
  is_stuck_ = true;
  throw EstimatorFailure(what_ + ": no answer within " + fmt::format("{:g}", limit_s_) + " s to " +
                         request["do"].get<std::string>() +
                         "() or a call before it; SHOAL_PYTHON_LIMIT_S is the limit in seconds");
}

void PythonHost::send(const nlohmann::json& request) {
  const std::string line = request.dump() + "\n";
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t written = write(to_child_.number(), line.data() + done, line.size() - done);
    if (written < 0 && errno == EINTR) continue;
    // The pipe is full while the child computes; the time limit holds for writing, too.
    if (written < 0 && errno == EAGAIN) {
      wait_for(to_child_, POLLOUT, request);
      continue;
    }
    if (written < 0) throw EstimatorFailure(what_ + ": its interpreter has ended");
    done += static_cast<std::size_t>(written);
  }
}

nlohmann::json PythonHost::request(const nlohmann::json& request) {
  send(request);
  // One line of JSON for each request; the text after it belongs to the next answer.
  std::size_t end;
  while ((end = unread_.find('\n')) == std::string::npos) {
    wait_for(from_child_, POLLIN, request);
    char buffer[4096];
    const ssize_t got = read(from_child_.number(), buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw EstimatorFailure(what_ + ": its interpreter has ended");
    unread_.append(buffer, static_cast<std::size_t>(got));
  }
  const nlohmann::json answer = nlohmann::json::parse(unread_.substr(0, end), nullptr, false);
  unread_.erase(0, end + 1);
  if (!answer.is_object()) throw EstimatorFailure(what_ + ": its interpreter gives no answers: it must be Python 3");
  if (answer.contains("error")) {
    const std::string error = what_ + ": " + answer.value("error", "unknown");
    if (answer.value("cannot_work", false)) throw std::invalid_argument(error);
    throw EstimatorFailure(error);
  }
  return answer;
}

}  // namespace navigation
