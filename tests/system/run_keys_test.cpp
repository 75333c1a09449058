// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/system/on_terminal.hpp"

// `shoal run` on a terminal, with real keys.

namespace {

using namespace system_test;
using testing::HasSubstr;

std::vector<std::string> endless_run(const ScratchFolder& folder, std::vector<std::string> more = {}) {
  write_file(folder.file("world.yaml"), endless_world());
  std::vector<std::string> run{built("shoal"), "run",         folder.file("world.yaml"), "--bus", "none",
                               "--paused",     "--snapshots", folder.file("snaps")};
  run.insert(run.end(), more.begin(), more.end());
  return run;
}

TEST(Keys, StepGoBackBranchAndQuit) {
  const ScratchFolder folder;
  OnTerminal shoal(endless_run(folder, {"--speed", "max"}));
  ASSERT_TRUE(shoal.shows("keys: space pause, n step, N 10 steps"));
  EXPECT_TRUE(shoal.is_raw());
  shoal.press("nN.");
  shoal.press("s");
  shoal.shows("branch0_step");
  shoal.press("u15\r");
  shoal.shows("run until (seconds");
  shoal.shows("runs until 15 s");
  shoal.shows("15.00 s");
  shoal.shows("paused");
  shoal.press("r");
  shoal.shows("step 500, 5 s, branch 1, paused");
  shoal.press("u1\r");
  shoal.shows("'until' needs a time after now (5 s)");
  shoal.press("r");
  shoal.shows("step 0, 0 s, branch 2, paused");
  shoal.press("u99\033");
  shoal.shows("not");
  shoal.press("?");
  shoal.shows("q quit, ? this");
  shoal.press("q");
  EXPECT_EQ(shoal.wait(), 0);
  EXPECT_FALSE(shoal.is_raw());
}

TEST(Keys, FunctionKeysDoNothing) {
  const ScratchFolder folder;
  OnTerminal shoal(endless_run(folder, {"--speed", "max"}));
  shoal.press("u40\r");
  shoal.shows("runs until 40 s");
  shoal.shows("40.00 s");
  shoal.shows("paused");
  shoal.press("\033OR\033[15~\033[1;2R");  // F3, F5 and Shift-F3, which end like R or hold a 1
  shoal.press("r");
  shoal.shows("step 3000, 30 s, branch 1, paused");
  shoal.press("q");
  EXPECT_EQ(shoal.wait(), 0);
}

TEST(Keys, ChangeTheSpeed) {
  const ScratchFolder folder;
  OnTerminal shoal(endless_run(folder, {"--speed", "1"}));
  shoal.press("+");
  shoal.shows("continues 2 x real time");
  shoal.press("-");
  shoal.shows("continues 1 x real time");
  shoal.press("m");
  shoal.shows("continues as fast as possible");
  shoal.press(" ");
  shoal.shows("; goes as fast as possible");
  shoal.press("1");
  shoal.shows("; goes 1 x real time");
  shoal.press(" ");
  shoal.shows(", paused; continues 1 x real time");
  shoal.press("q");
  EXPECT_EQ(shoal.wait(), 0);
}

TEST(Keys, TheTerminalIsAsBeforeAfterASignal) {
  for (const int signal : {SIGTERM, SIGQUIT, SIGINT}) {
    const ScratchFolder folder;
    OnTerminal shoal(endless_run(folder));
    ASSERT_TRUE(shoal.shows("keys: "));
    ASSERT_TRUE(await([&] { return shoal.is_raw(); }));
    kill(shoal.pid(), signal);
    EXPECT_EQ(shoal.wait(), 128 + signal);
    EXPECT_FALSE(shoal.is_raw()) << signal;
  }
}

TEST(Keys, CtrlZGivesTheTerminalBackAndGoingOnTakesItAgain) {
  const ScratchFolder folder;
  OnTerminal shoal(endless_run(folder));
  ASSERT_TRUE(shoal.shows("keys: "));
  shoal.press("\032");
  ASSERT_TRUE(shoal.is_stopped());
  EXPECT_FALSE(shoal.is_raw());
  kill(shoal.pid(), SIGCONT);
  EXPECT_TRUE(await([&] { return shoal.is_raw(); }));
  shoal.press("q");
  EXPECT_EQ(shoal.wait(), 0);
}

TEST(Keys, AJobInTheBackgroundIsNotStopped) {
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"), endless_world());
  // An interactive shell gives its jobs process groups of their own.
  OnTerminal shell({"sh", "-m", "-c",
                    built("shoal") + " run " + folder.file("world.yaml") +
                        " --bus none --duration 2 --speed max && echo all is over & wait"});
  EXPECT_TRUE(shell.shows("all is over"));
  EXPECT_EQ(shell.wait(), 0);
}

TEST(Keys, AJobThatReachesTheForegroundTakesTheTerminal) {
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"), endless_world());
  // Such a shell gives a job that runs on its terminal, and no signal.
  OnTerminal shell({"bash", "--norc", "-m", "-c",
                    built("shoal") + " run " + folder.file("world.yaml") + " --bus none --paused & read -r line; fg"});
  ASSERT_TRUE(shell.shows("keys: "));
  EXPECT_FALSE(shell.is_raw());
  shell.press("now\r");
  EXPECT_TRUE(await([&] { return shell.is_raw(); }, timeout));
  shell.press("N");
  shell.shows("0.10 s");
  shell.press("q");
  EXPECT_EQ(shell.wait(), 0);
  EXPECT_FALSE(shell.is_raw());
}

TEST(Keys, CanBeTurnedOff) {
  const ScratchFolder folder;
  OnTerminal shoal(endless_run(folder, {"--no-keys"}));
  ASSERT_TRUE(shoal.shows("paused"));
  EXPECT_FALSE(shoal.is_raw());
  shoal.press("q\003");
  EXPECT_EQ(shoal.wait(), 128 + SIGINT);
}

}  // namespace
