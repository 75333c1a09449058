// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/mesh/child_work.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spdlog/fmt/fmt.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <system_error>
#include <utility>

#include "bridges/base/forked_work.hpp"

namespace tools {

namespace {

using Clock = std::chrono::steady_clock;

void set_limit(__rlimit_resource resource, std::size_t value) {
  const rlimit limit{value, value};
  setrlimit(resource, &limit);
}

int be_child(const std::function<std::string()>& work, const ChildLimits& limits, int to) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int fatal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) signal(fatal, SIG_DFL);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  set_limit(RLIMIT_CORE, 0);
#ifndef __SANITIZE_ADDRESS__
  set_limit(RLIMIT_AS, limits.memory_bytes);
#endif
  return bridges::write_all(to, work()) ? 0 : 1;
}

}  // namespace

std::string do_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.time_s));
  // Assimp may crash, loop or take all memory on a broken file. A child process keeps that from the command, and from
  // its users.
  bridges::ForkedWork done;
  try {
    done = bridges::run_forked([&](int to) { return be_child(work, limits, to); }, deadline);
  } catch (const std::system_error&) {
    throw ChildError("could not be started");
  }
  if (!done.output) throw ChildError(fmt::format("took longer than {:g} s", limits.time_s));
  if (done.status != 0) throw ChildError("failed on this file");
  return *std::move(done.output);
}

}  // namespace tools
