// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/process_group.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using lcm_test::await;
using lcm_test::ScratchFolder;

sim::ProcessConfig shell(const std::string& script, const std::string& name = "worker") {
  sim::ProcessConfig config;
  config.name = name;
  config.command = {"sh", "-c", script};
  return config;
}

std::vector<experiment::ProcessGroup::Exit> await_exit(experiment::ProcessGroup& group) {
  std::vector<experiment::ProcessGroup::Exit> exits;
  await([&] { return !(exits = group.reap()).empty(); });
  return exits;
}

std::string text_of_file(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The first line of a file that a program writes, once it is whole.
std::string await_line(const std::string& path) {
  std::string text;
  await([&] { return (text = text_of_file(path)).ends_with('\n'); });
  return text.substr(0, text.find('\n'));
}

/// Neither gone nor waiting for whoever adopted it to notice.
bool is_running(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
  std::string status;
  std::getline(in, status);  // which does not throw when the process goes meanwhile
  const std::size_t name_end = status.rfind(") ");
  return name_end != std::string::npos && status[name_end + 2] != 'Z';
}

TEST(ProcessGroup, ReportsHowAProgramEnded) {
  experiment::ProcessGroup group;
  sim::ProcessConfig config = shell("exit 3", "pilot");
  config.client = "auv1";
  config.on_exit = sim::OnExit::end_run;
  group.start(config, "memq://", "");
  const auto exits = await_exit(group);
  ASSERT_EQ(exits.size(), 1u);
  EXPECT_EQ(exits[0].name, "pilot");
  EXPECT_EQ(exits[0].how, "exited with code 3");
  EXPECT_EQ(exits[0].client, "auv1");
  EXPECT_TRUE(exits[0].ends_run);
  EXPECT_TRUE(exits[0].failed);
  EXPECT_TRUE(group.empty());
}

TEST(ProcessGroup, ReportsWhatKilledAProgram) {
  experiment::ProcessGroup group;
  group.start(shell("kill -9 $$"), "memq://", "");
  const auto exits = await_exit(group);
  ASSERT_EQ(exits.size(), 1u);
  EXPECT_EQ(exits[0].how, "was killed by signal 9 (Killed)");
  EXPECT_TRUE(exits[0].failed);
}

TEST(ProcessGroup, EndingWellIsNoFailure) {
  experiment::ProcessGroup group;
  group.start(shell("exit 0"), "memq://", "");
  const auto exits = await_exit(group);
  ASSERT_EQ(exits.size(), 1u);
  EXPECT_FALSE(exits[0].failed);
  EXPECT_FALSE(exits[0].ends_run);
}

TEST(ProcessGroup, NamesAProgramThatCannotBeStarted) {
  experiment::ProcessGroup group;
  sim::ProcessConfig config;
  config.name = "pilot";
  config.command = {"no-such-program"};
  try {
    group.start(config, "memq://", "");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "process 'pilot': cannot start 'no-such-program': No such file or directory");
  }
  EXPECT_TRUE(group.empty());
}

TEST(ProcessGroup, HandsOverTheLcmUrlAndKeepsALog) {
  const ScratchFolder folder;
  experiment::ProcessGroup group;
  sim::ProcessConfig config = shell("echo \"$LCM_DEFAULT_URL $1\"; echo oops >&2; cat", "pilot");
  config.command.insert(config.command.end(), {"sh", "--url={lcm_url}"});
  group.start(config, "udpm://239.255.76.67:7000?ttl=0", folder.file(""));
  await_exit(group);  // cat ends: nothing comes from stdin
  EXPECT_EQ(text_of_file(folder.file("pilot.log")),
            "udpm://239.255.76.67:7000?ttl=0 --url=udpm://239.255.76.67:7000?ttl=0\noops\n");
}

TEST(ProcessGroup, GivesProgramsTheUsualSignals) {
  // shoal itself ignores SIGPIPE; `yes` must not inherit that, or it would warn.
  const ScratchFolder folder;
  const auto before = signal(SIGPIPE, SIG_IGN);
  experiment::ProcessGroup group;
  group.start(shell("yes | head -n 1"), "memq://", folder.file(""));
  await_exit(group);
  signal(SIGPIPE, before);
  EXPECT_EQ(text_of_file(folder.file("worker.log")), "y\n");
}

TEST(ProcessGroup, EndsChildrenOfChildren) {
  const ScratchFolder folder;
  experiment::ProcessGroup group;
  group.start(shell("sleep 1000 & echo $! > " + folder.file("child") + "; wait"), "memq://", "");
  const pid_t child = std::stoi(await_line(folder.file("child")));
  EXPECT_TRUE(is_running(child));
  group.stop();
  EXPECT_TRUE(await([&] { return !is_running(child); }));
  EXPECT_TRUE(group.empty());
}

TEST(ProcessGroup, EndsChildrenThatAProgramLeftBehind) {
  const ScratchFolder folder;
  experiment::ProcessGroup group;
  group.start(shell("sleep 1000 & echo $! > " + folder.file("child")), "memq://", "");
  const pid_t child = std::stoi(await_line(folder.file("child")));
  await_exit(group);
  EXPECT_TRUE(await([&] { return !is_running(child); }));
}

/// A child that ignores SIGTERM and then writes its number to a file, and what its parent does after.
std::string deaf_child(const std::string& file, const std::string& then) {
  return "sh -c \"trap '' TERM; echo \\$\\$ > " + file + "; exec sleep 1000\" & " + then;
}

TEST(ProcessGroup, KillsChildrenThatDoNotListen) {
  const ScratchFolder folder;
  experiment::ProcessGroup group;
  group.start(shell(deaf_child(folder.file("child"), "sleep 1001")), "memq://", "");
  const pid_t child = std::stoi(await_line(folder.file("child")));
  const auto begin = std::chrono::steady_clock::now();
  group.stop();
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));  // it was asked first
  EXPECT_TRUE(await([&] { return !is_running(child); }));
  EXPECT_TRUE(group.empty());
}

TEST(ProcessGroup, KillsDeafChildrenOfAProgramThatIsLongGone) {
  const ScratchFolder folder;
  experiment::ProcessGroup group;
  const std::string file = folder.file("child");
  // The parent goes when the child has said its number: from then on it is deaf.
  group.start(shell(deaf_child(file, "until [ -s " + file + " ]; do sleep 0.01; done")), "memq://", "");
  const pid_t child = std::stoi(await_line(file));
  await_exit(group);
  EXPECT_TRUE(is_running(child));
  EXPECT_FALSE(group.empty());
  group.stop();
  EXPECT_TRUE(await([&] { return !is_running(child); }));
}

TEST(ProcessGroup, KillsWhatDoesNotListen) {
  const ScratchFolder folder;
  pid_t pid = 0;
  const auto begin = std::chrono::steady_clock::now();
  {
    experiment::ProcessGroup group;
    group.start(shell("trap '' TERM; echo $$ > " + folder.file("pid") + "; while true; do sleep 0.1; done"), "memq://",
                "");
    pid = std::stoi(await_line(folder.file("pid")));
  }
  EXPECT_FALSE(is_running(pid));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));  // it was asked first
}

}  // namespace
