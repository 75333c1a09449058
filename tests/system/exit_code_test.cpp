// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/lockstep_client/lockstep_client.hpp"
#include "bridges/log/event_log.hpp"
#include "tests/system/shoal_program.hpp"

// 0 ok, 1 a pass rule failed, 2 usage or configuration, 3 physics, 4 bus or file, 5 time-out, 129, 130 and 143
// signals.

namespace {

using namespace system_test;
using testing::HasSubstr;
using testing::StartsWith;

/// Events of a log that must be whole.
std::size_t events_in(const std::string& path) {
  bridges::EventLogReader log(path);
  std::size_t events = 0;
  while (log.next()) ++events;
  EXPECT_TRUE(log.problems().empty()) << log.problems()[0];
  return events;
}

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(ExitCode, Is2ForWrongUsage) {
  const std::string world = source("worlds/minimal.yaml");
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"fly"},
      {"run"},
      {"run", world, "--speed", "fast"},
      {"run", world, "--speed", "-1"},
      {"run", world, "--speed", "0.0001"},
      {"run", world, "--speed", "nan"},
      {"run", world, "--speed", "inf"},
      {"run", world, "--duration", "inf"},
      {"run", world, "--launch", "--bus", "none"},
      {"spy", "--duration", "nan"},
      {"bench", "--measure", "nan"},
      {"bench", "--warm-up", "inf"},
      {"bench", "moon"},
      {"bench", "--vehicles", "0"},
      {"bench", "--threads", "1,-1"},
      {"bench", "land", "--set", "physics.step_s=-1"},
      {"run", world, "--duration", "-1"},
      {"run", world, "--duration", "nan"},
      {"run", world, "--seed", "x"},
      {"run", world, "--bus", "can"},
      {"run", world, "--frobnicate"},
      {"run", world, "--set", "nonsense", "--bus", "none"},
      {"run", world, "--set", "run.durration_s=3", "--bus", "none"},
      {"describe", "lider"},
      {"list", "wheels"},
      {"log", "info"},
  };
  for (const auto& arguments : wrong) {
    const Ended ended = run_shoal(arguments);
    EXPECT_EQ(ended.exit_code, 2) << testing::PrintToString(arguments);
    EXPECT_NE(ended.errors, "") << testing::PrintToString(arguments);
  }
}

TEST(ExitCode, Is0ForHelpAndVersion) {
  for (const char* option : {"--help", "--version"}) {
    const Ended ended = run_shoal({option});
    EXPECT_EQ(ended.exit_code, 0);
    EXPECT_NE(ended.output, "");
    EXPECT_EQ(ended.errors, "");
  }
}

TEST(ExitCode, Is2ForABadWorld) {
  const std::string file = source("tests/bad_worlds/beams_out_of_range.yaml");
  for (const char* command : {"run", "check"}) {
    const Ended ended = run_shoal({command, file});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.errors, StartsWith(file + ":12:18: vehicle 'auv1': device 'front': 'beams' must be"));
    EXPECT_EQ(ended.output, "");
  }
  const Ended missing = run_shoal({"run", "no_such_world.yaml"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.errors, HasSubstr("no_such_world.yaml"));
  EXPECT_EQ(run_shoal({"run", source("worlds")}).exit_code, 2);
}

TEST(ExitCode, Is2ForGarbageOfAnySize) {
  const ScratchFolder folder;
  std::mt19937 random(1);
  std::string noise(10'000'000, ' ');
  for (char& c : noise) c = static_cast<char>(random());
  std::string letters = noise;
  for (char& c : letters) c = static_cast<char>(' ' + static_cast<unsigned char>(c) % 95);
  const auto repeated = [](const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  const std::vector<std::pair<std::string, std::string>> files = {
      {"noise", noise},
      {"letters", letters},
      {"brackets", std::string(10'000'000, '[')},
      {"nested_lists", std::string(100'000, '[') + std::string(100'000, ']')},
      {"nested_maps", repeated("{a: ", 100'000) + std::string(100'000, '}')},
      {"nested_items", repeated("- ", 100'000)},
      {"nested_keys", repeated("? ", 100'000)},
      {"long_line", "shoal: " + std::string(10'000'000, 'x')},
  };
  for (const auto& [name, text] : files) {
    write_file(folder.file(name), text);
    const Ended ended = run_shoal({"check", folder.file(name)});
    EXPECT_EQ(ended.exit_code, 2) << name;
    EXPECT_EQ(lines_in(ended.errors), 1u) << name << ": " << ended.errors.substr(0, 1000);
    EXPECT_LT(ended.errors.size(), 1000u) << name;
    EXPECT_THAT(ended.errors, StartsWith(folder.file(name) + ":"));
    std::filesystem::remove(folder.file(name));
  }
}

TEST(ExitCode, Is3ForAPhysicsFaultAndTheRecordIsWhole) {
  const ScratchFolder folder;
  // Free fall: 5 m/s are reached after 0.51 s.
  write_file(folder.file("fall.yaml"),
             "shoal: 1\nphysics: {max_speed_mps: 5}\nvehicles:\n  - name: stone\n    position_m: [0, 0, 100]\n"
             "    model: {shoal: 1, bodies: [{name: body, parts: [{shape: sphere, mass_kg: 1}]}]}\n");
  const Ended ended = run_shoal({"run", folder.file("fall.yaml"), "--bus", "none", "--record", folder.file("run.lcm"),
                                 "--results", folder.file("results")});
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_THAT(ended.errors, HasSubstr("stone"));
  EXPECT_GT(events_in(folder.file("run.lcm")), 5u);
  EXPECT_EQ(summary_value(folder.file("results"), "exit_code"), "3");
  EXPECT_EQ(summary_value(folder.file("results"), "ended"), "\"fault\"");
  // What to report is one command.
  const std::string record = " --record " + folder.file("run.lcm");
  EXPECT_THAT(ended.errors, HasSubstr("to report this: shoal bug " + folder.file("results") + record + "\n"));
  const Ended bug = run_shoal({"bug", folder.file("results"), "--record", folder.file("run.lcm")});
  EXPECT_EQ(bug.exit_code, 0) << bug.errors;
  EXPECT_THAT(bug.output, StartsWith(folder.file("results") + "/bug.tar.gz\n"));
  EXPECT_EQ(run_shoal({"bug", folder.file("nowhere")}).exit_code, 4);
  EXPECT_EQ(run_shoal({"bug"}).exit_code, 2);
  EXPECT_EQ(summary_value(folder.file("results"), "passed"), "false");
}

TEST(ExitCode, Is4ForABusThatCannotBeUsed) {
  if (Program({"unshare", "-rn", "true"}).wait() != 0) GTEST_SKIP() << "unshare -rn is not permitted here";
  Program program({"unshare", "-rn", built("shoal"), "run", source("worlds/minimal.yaml"), "--duration", "1",
                   "--lcm-url", own_url()});
  EXPECT_EQ(program.wait(), 4);
  EXPECT_THAT(program.errors(), HasSubstr("shoal doctor"));
  Program doctor({"unshare", "-rn", built("shoal"), "doctor"});
  EXPECT_EQ(doctor.wait(), 4);
  EXPECT_THAT(doctor.output(), HasSubstr("ip route add"));
}

TEST(ExitCode, Is4ForARecordThatCannotBeWritten) {
  const ScratchFolder folder;
  const std::vector<std::string> run = {
      "run", source("worlds/minimal.yaml"), "--duration", "20", "--bus", "none", "--speed", "max", "--record"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = run;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_shoal(arguments);
  };
  const Ended full = with({"/dev/full", "--overwrite", "--special-files"});
  EXPECT_EQ(full.exit_code, 4);
  EXPECT_THAT(full.errors, HasSubstr("/dev/full"));
  EXPECT_THAT(full.errors, HasSubstr("No space left on device"));

  write_file(folder.file("old.lcm"), "precious");
  const Ended there = with({folder.file("old.lcm")});
  EXPECT_EQ(there.exit_code, 4);
  EXPECT_THAT(there.errors, HasSubstr(folder.file("old.lcm")));
  EXPECT_EQ(text_of_file(folder.file("old.lcm")), "precious");

  EXPECT_EQ(with({folder.file("no/such/folder.lcm")}).exit_code, 4);
}

TEST(ExitCode, Is4ForOutputThatCannotBeWritten) {
  const std::string shoal = built("shoal");
  for (const std::string& command : {std::string("list messages"), "check " + source("worlds/minimal.yaml")}) {
    Program program({"sh", "-c", shoal + " " + command + " > /dev/full"});
    EXPECT_EQ(program.wait(), 4) << command;
    EXPECT_THAT(program.errors(), HasSubstr("cannot write to stdout: No space left on device"));
  }
}

TEST(ExitCode, Is2ForASeedThatIsNone) {
  for (const char* seed : {"-1", "9223372036854775808", "x", "1.5"}) {
    const Ended ended = run_shoal({"run", source("worlds/minimal.yaml"), "--seed", seed});
    EXPECT_EQ(ended.exit_code, 2) << seed;
    EXPECT_THAT(ended.errors, HasSubstr("must be a whole number from 0 to 9223372036854775807")) << seed;
  }
  const Ended max = run_shoal({"run", source("worlds/minimal.yaml"), "--seed", "9223372036854775807", "--bus", "none",
                               "--duration", "0.1", "--speed", "max"});
  EXPECT_EQ(max.exit_code, 0) << max.errors;
}

TEST(ExitCode, Is5ForAClientThatNeverAcknowledges) {
  const ScratchFolder folder;
  Program shoal({built("shoal"), "run", source("worlds/minimal.yaml"), "--duration", "10", "--await", "sleeper",
                 "--set", "lockstep.timeout_s=0.5", "--lcm-url", own_url(), "--record", folder.file("run.lcm")});
  bridges::LockstepClient client(own_url(), "sleeper");
  client.join(0.1, timeout);
  EXPECT_EQ(shoal.wait(), 5);
  EXPECT_THAT(shoal.errors(), HasSubstr("no acknowledgement from 'sleeper'"));
  EXPECT_GT(events_in(folder.file("run.lcm")), 0u);
}

TEST(ExitCode, Is5ForAClientThatNeverJoins) {
  const Ended ended = run_shoal({"run", source("worlds/minimal.yaml"), "--await", "nobody", "--set",
                                 "lockstep.join_timeout_s=1.5", "--lcm-url", own_url()});
  EXPECT_EQ(ended.exit_code, 5);
  EXPECT_THAT(ended.errors, HasSubstr("waiting for 'nobody' to join the lockstep"));
  EXPECT_THAT(ended.errors, HasSubstr("client 'nobody' has not joined"));
}

TEST(ExitCode, Is128PlusTheSignal) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const ScratchFolder folder;
    write_file(folder.file("world.yaml"),
               endless_world("    overrides: {devices.modem.serial: {path: " + folder.file("port") +
                             "}}\n"
                             "processes: [{name: idler, command: [sleep, '1000']}]\n"));
    bridges::LcmListener listener(own_url());
    listener.listen("sim.clock");
    Program shoal({built("shoal"), "run", folder.file("world.yaml"), "--launch", "--lcm-url", own_url(), "--record",
                   folder.file("run.lcm"), "--allow-path", folder.file("")});
    ASSERT_TRUE(listener.next(timeout));
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("port")));
    const auto children = shoal.await_children(1);
    ASSERT_EQ(children.size(), 1u);
    EXPECT_TRUE(is_running(children[0]));

    shoal.send_signal(signal);
    EXPECT_EQ(shoal.wait(), 128 + signal) << shoal.errors();
    EXPECT_FALSE(is_running(children[0]));
    EXPECT_FALSE(std::filesystem::is_symlink(folder.file("port")));
    EXPECT_GT(events_in(folder.file("run.lcm")), 0u);
  }
}

}  // namespace
