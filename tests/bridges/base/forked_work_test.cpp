// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/forked_work.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using bridges::ForkedWork;
using bridges::run_forked;

TEST(ForkedWork, ReturnsOutputAndExitCode) {
  const std::string text(200'000, 'x');  // more than a pipe holds
  const ForkedWork done = run_forked([&](int to) { return bridges::write_all(to, text) ? 3 : 1; });
  EXPECT_EQ(done.output, text);
  ASSERT_TRUE(WIFEXITED(done.status));
  EXPECT_EQ(WEXITSTATUS(done.status), 3);
}

TEST(ForkedWork, ACrashEndsTheChildOnly) {
  const ForkedWork done = run_forked([](int) { return kill(getpid(), SIGKILL); });
  EXPECT_EQ(done.output, "");
  ASSERT_TRUE(WIFSIGNALED(done.status));
  EXPECT_EQ(WTERMSIG(done.status), SIGKILL);
}

TEST(ForkedWork, IsKilledAtItsDeadline) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(20);
  const ForkedWork done = run_forked(
      [](int) {
        for (;;) pause();
        return 0;
      },
      deadline);
  EXPECT_FALSE(done.output);
  EXPECT_TRUE(WIFSIGNALED(done.status));
}

}  // namespace
