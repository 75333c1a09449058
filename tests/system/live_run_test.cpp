// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>

#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/lockstep_client/lockstep_client.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/utime_t.hpp"
#include "tests/system/shoal_program.hpp"

// What programs outside can do to a run that continues: control it, join it, die, send nonsense.

namespace {

using namespace system_test;
using testing::HasSubstr;

constexpr std::int64_t step_us = 10'000;

/// A run of the endless world, and a program that talks to it.
class LiveRun : public testing::Test {
 protected:
  LiveRun() : listener_(own_url()) {
    listener_.listen("sim.clock");
    listener_.listen("sim.control.reply");
  }

  void start(const std::string& more = "", const std::vector<std::string>& options = {}) {
    write_file(folder_.file("world.yaml"), endless_world(more));
    std::vector<std::string> arguments = {built("shoal"), "run", folder_.file("world.yaml"), "--lcm-url", own_url()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    shoal_ = std::make_unique<Program>(arguments);
    await_clock([](std::int64_t) { return true; });
  }

  /// Sends a request until it is answered: the first may come before the simulator listens.
  shoal::sim_control_reply_t request(const std::string& command, double value = 0) {
    shoal::sim_control_request_t request{};
    request.id = ++last_id_;
    request.client = "test";
    request.command = command;
    request.value = value;
    EXPECT_TRUE(listener_.publish("sim.control", shoal::encode(request)));
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (std::chrono::steady_clock::now() < deadline) {
      const auto message = listener_.next(100ms);
      if (!message || message->channel != "sim.control.reply") continue;
      const auto reply = shoal::decode<shoal::sim_control_reply_t>(message->payload, shoal::Finite::any);
      if (reply.id == request.id) return reply;
    }
    ADD_FAILURE() << "no reply to " << command;
    return {};
  }

  /// The first time on sim.clock that fulfils the condition.
  template <typename Condition>
  std::int64_t await_clock(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (std::chrono::steady_clock::now() < deadline && shoal_->running()) {
      const auto message = listener_.next(100ms);
      if (!message || message->channel != "sim.clock") continue;
      const auto clock = shoal::decode<shoal::utime_t>(message->payload, shoal::Finite::any);
      if (condition(clock.utime)) return clock.utime;
    }
    ADD_FAILURE() << "the clock does not show it: " << shoal_->errors();
    return -1;
  }

  /// Lets the run continue for some steps after now.
  void await_steps(int steps) {
    const std::int64_t end = request("resume").utime + steps * step_us;
    await_clock([&](std::int64_t utime) { return utime >= end; });
  }

  void quit(int exit_code = 0) {
    EXPECT_TRUE(request("quit").ok);
    EXPECT_EQ(shoal_->wait(), exit_code) << shoal_->errors();
  }

  ScratchFolder folder_;
  bridges::LcmListener listener_;
  std::unique_ptr<Program> shoal_;
  std::int32_t last_id_ = 0;
};

TEST_F(LiveRun, IsPausedSteppedAndResumed) {
  start();
  const auto paused = request("pause");
  EXPECT_TRUE(paused.ok);
  EXPECT_EQ(paused.client, "test");
  EXPECT_EQ(request("step", 5).utime, paused.utime);  // it stands still
  const std::int64_t later = paused.utime + 5 * step_us;
  await_clock([&](std::int64_t utime) { return utime >= later; });
  EXPECT_EQ(request("pause").utime, later);  // five steps, no more
  EXPECT_TRUE(request("resume").ok);
  await_clock([&](std::int64_t utime) { return utime > later + 3 * step_us; });
  quit();
}

TEST_F(LiveRun, StartsPausedWhenAsked) {
  start("", {"--paused"});
  const std::int64_t begin = request("pause").utime;
  EXPECT_EQ(begin % 1'000'000, 0);  // the epoch
  request("resume");
  await_clock([&](std::int64_t utime) { return utime > begin; });
  quit();
}

TEST_F(LiveRun, ChangesItsSpeed) {
  start();
  EXPECT_TRUE(request("speed", 0).ok);  // as fast as possible
  // At speed 1 it would take twice as long as await_clock() waits.
  const std::int64_t end = request("speed", 100).utime + 2 * std::chrono::microseconds(timeout).count();
  await_clock([&](std::int64_t utime) { return utime >= end; });
  quit();
}

TEST_F(LiveRun, RefusesWhatItDoesNotUnderstand) {
  start();
  const auto unknown = request("fly");
  EXPECT_FALSE(unknown.ok);
  EXPECT_EQ(unknown.text,
            "unknown command 'fly'; known commands: alive, bus, describe, do, follow, join, leave, pause, quit, "
            "remove, restore, "
            "resume, rewind, scene, snapshot, spawn, speed, step, until, where");
  EXPECT_FALSE(request("speed", -1).ok);
  EXPECT_FALSE(request("step", 0).ok);
  EXPECT_FALSE(request("step", 1e300).ok);
  EXPECT_FALSE(request("join", 0.015).ok);  // not a multiple of the step
  EXPECT_FALSE(request("join", -1).ok);
  EXPECT_FALSE(request("leave").ok);
  await_steps(3);
  quit();
}

TEST_F(LiveRun, WaitsForAClientThatJoinsLate) {
  start();
  bridges::LockstepClient client(own_url(), "late");
  client.join(0.05, timeout);
  shoal::sim_tick_t tick{};
  ASSERT_TRUE(client.next_tick(tick));
  // The world waits: the clock stands while the tick is not acknowledged.
  EXPECT_EQ(request("pause").utime, tick.utime);
  request("resume");
  client.acknowledge(tick);
  for (int i = 0; i < 3; ++i) {
    const std::int64_t before = tick.step;
    ASSERT_TRUE(client.next_tick(tick));
    EXPECT_EQ(tick.step, before + 5);
    ASSERT_EQ(tick.client.size(), 1u);
    EXPECT_EQ(tick.client[0].name, "late");
    client.acknowledge(tick);
  }
  shoal::sim_control_request_t leave{};
  leave.client = "late";
  leave.command = "leave";
  listener_.publish("sim.control", shoal::encode(leave));
  await_steps(20);
  quit();
}

TEST_F(LiveRun, ASecondSimulatorLeavesTheBusToTheFirst) {
  start();
  const std::string minimal = source("worlds/minimal.yaml");
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--await", "pilot"}}) {
    std::vector<std::string> arguments = {"run", minimal, "--lcm-url", own_url(), "--duration", "0.1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ended second = run_shoal(arguments);
    EXPECT_EQ(second.exit_code, 4);
    // It answers, or its clock is received before it answers.
    EXPECT_THAT(second.errors, HasSubstr("another simulator"));
    EXPECT_THAT(second.errors, HasSubstr(" on " + own_url()));
    EXPECT_THAT(second.errors, HasSubstr("--lcm-shared"));
  }
  request("pause");  // then it publishes nothing, but answers
  EXPECT_EQ(run_shoal({"run", minimal, "--lcm-url", own_url(), "--duration", "0.1"}).exit_code, 4);
  EXPECT_EQ(run_shoal({"run", minimal, "--lcm-url", own_url(), "--duration", "0.1", "--lcm-shared"}).exit_code, 0);
  EXPECT_EQ(run_shoal({"run", minimal, "--bus", "none", "--duration", "0.1"}).exit_code, 0);
  await_steps(5);  // the first continues
  quit();
}

TEST_F(LiveRun, AnotherSimulatorIsFoundOnTheBusOfAVehicle) {
  start();
  write_file(folder_.file("separate.yaml"), endless_world("buses: [{name: own, lcm_url: '" + own_url() + "'}]\n"));
  const Ended second = run_shoal({"run", folder_.file("separate.yaml"), "--lcm-url", own_url(1), "--duration", "0.1"});
  EXPECT_EQ(second.exit_code, 4);
  // What tells first depends on the machine: the answer of the other one, or its clock.
  EXPECT_THAT(second.errors, testing::AllOf(HasSubstr("another simulator"), HasSubstr(" on " + own_url())));
  quit();
}

TEST_F(LiveRun, ContinuesWithoutAProcessThatDiedAndFails) {
  start("processes: [{name: pilot, command: [sh, -c, exit 3]}]\n", {"--launch"});
  EXPECT_TRUE(
      await([&] { return shoal_->errors().find("the run continues without it, and fails") != std::string::npos; }));
  EXPECT_THAT(shoal_->errors(), HasSubstr("process 'pilot' exited with code 3"));
  await_steps(3);
  quit(1);
  EXPECT_THAT(shoal_->output(), HasSubstr("FAILED: process 'pilot' must not fail; it exited with code 3"));
}

TEST_F(LiveRun, ContinuesWithoutAProcessWhoseEndDoesNotMatter) {
  start("processes: [{name: pilot, command: [sh, -c, exit 3], on_exit: ignore}]\n", {"--launch"});
  EXPECT_TRUE(await([&] { return shoal_->errors().find("process 'pilot' exited with code 3") != std::string::npos; }));
  quit();
}

TEST_F(LiveRun, EndsWithAProcessThatItShouldEndWith) {
  start("processes: [{name: pilot, command: [sh, -c, sleep 0.2], on_exit: end}]\n", {"--launch"});
  EXPECT_EQ(shoal_->wait(), 1);
  EXPECT_THAT(shoal_->errors(),
              HasSubstr("process 'pilot' exited with code 0; the run ends with it, as the world requires"));
}

TEST_F(LiveRun, NamesAProcessThatCannotBeStarted) {
  write_file(folder_.file("world.yaml"), endless_world("processes: [{name: pilot, command: [no-such-pilot]}]\n"));
  const Ended ended = run_shoal({"run", folder_.file("world.yaml"), "--launch", "--lcm-url", own_url()});
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_THAT(ended.errors, HasSubstr("process 'pilot': cannot start 'no-such-pilot': No such file or directory"));
}

TEST_F(LiveRun, StartsNoProcessUnlessAsked) {
  start("processes: [{name: pilot, command: [touch, " + folder_.file("started") + "]}]\n");
  await_steps(20);
  EXPECT_TRUE(shoal_->children().empty());
  EXPECT_EQ(text_of_file(folder_.file("started")), "");
  quit();
}

/// Payloads that no decoder should trust, made from a good one: it starts with its type's fingerprint.
std::vector<sim::Bytes> hostile_payloads(const sim::Bytes& good) {
  std::vector<sim::Bytes> all;
  all.push_back({});
  all.push_back(sim::Bytes(1));
  all.push_back(sim::Bytes(7, std::byte{0xff}));
  all.push_back(sim::Bytes(8, std::byte{0xff}));
  all.push_back(sim::Bytes(good.size()));                     // no fingerprint
  all.push_back(sim::Bytes(good.begin(), good.begin() + 8));  // nothing behind it
  all.push_back(sim::Bytes(good.begin(), good.end() - 1));    // cut
  sim::Bytes lengths(good.begin(), good.begin() + 8);         // all lengths huge or negative
  lengths.resize(2000, std::byte{0xff});
  all.push_back(lengths);
  std::fill(lengths.begin() + 8, lengths.end(), std::byte{0x7f});
  all.push_back(lengths);
  std::mt19937 random(1);
  sim::Bytes noise(60'000);
  for (std::byte& byte : noise) byte = static_cast<std::byte>(random());
  all.push_back(noise);
  std::copy(good.begin(), good.begin() + 8, noise.begin());
  all.push_back(noise);
  return all;
}

TEST_F(LiveRun, SurvivesHostileMessagesAndCountsThem) {
  const std::string results = folder_.file("results");
  start("", {"--results", results});
  shoal::twist_command_t twist{};
  twist.forward_mps = std::numeric_limits<double>::quiet_NaN();
  std::int64_t sent = 0;
  const auto send = [&](const std::string& channel, const sim::Bytes& payload) {
    EXPECT_TRUE(listener_.publish(channel, payload));
    ++sent;
  };
  send("rover1.drive.cmd", shoal::encode(twist));
  const std::pair<std::string, sim::Bytes> channels[] = {
      {"rover1.drive.cmd", shoal::encode(shoal::twist_command_t{})},
      {"rover1.modem.cmd", {}},
      {"sim.control", shoal::encode(shoal::sim_control_request_t{})},
      {"sim.ack", shoal::encode(shoal::sim_ack_t{})},
  };
  for (const auto& [channel, good] : channels) {
    for (const sim::Bytes& payload : hostile_payloads(good.empty() ? sim::Bytes(40, std::byte{1}) : good))
      send(channel, payload);
    request("resume");  // no more at once than buffers hold
  }
  await_steps(10);
  quit();
  EXPECT_EQ(summary_value(results, "bad_messages"), std::to_string(sent)) << shoal_->errors();
  EXPECT_EQ(summary_value(results, "ended"), "\"quit\"");
}

/// Its rule fails after any time: that it does not count shows in the exit code.
class UnjudgedRun : public LiveRun {
 protected:
  void start_it() {
    start(
        "metrics: [{name: distance, type: distance, vehicle: rover1}]\n"
        "pass: [distance.travelled_m > 1000000]\n",
        {"--duration", "1000", "--results", folder_.file("results"), "--no-plots"});
  }
  void expect_not_judged(const std::string& how) {
    EXPECT_THAT(shoal_->output(),
                testing::ContainsRegex("\n  ended by " + how + " at [0-9.]+ of 1000 s: not judged\n"));
    EXPECT_THAT(shoal_->output(), testing::Not(HasSubstr("FAILED")));
    const std::string results = folder_.file("results");
    EXPECT_EQ(summary_value(results, "passed"), "null");
    EXPECT_EQ(summary_value(results, "judged"), "false");
    EXPECT_THAT(summary_value(results, "not_judged"), HasSubstr("ended by " + how + " at "));
  }
};

TEST_F(UnjudgedRun, WasEndedByQuit) {
  start_it();
  await_steps(10);
  EXPECT_TRUE(request("quit").ok);
  EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
  expect_not_judged("quit");
}

TEST_F(UnjudgedRun, WasEndedByASignal) {
  start_it();
  await_steps(10);
  shoal_->send_signal(SIGINT);
  EXPECT_EQ(shoal_->wait(), 130) << shoal_->errors();
  expect_not_judged("SIGINT");
}

TEST_F(LiveRun, ThatIsEndedByHandHasFailedWhenAProgramDid) {
  const std::string results = folder_.file("results");
  start(
      "metrics: [{name: distance, type: distance, vehicle: rover1}]\npass: [distance.travelled_m < 1000]\n"
      "processes: [{name: pilot, command: [sh, -c, exit 3]}]\n",
      {"--launch", "--duration", "1000", "--results", results, "--no-plots"});
  EXPECT_TRUE(await([&] { return shoal_->errors().find("exited with code 3") != std::string::npos; }, timeout));
  EXPECT_TRUE(request("quit").ok);
  EXPECT_EQ(shoal_->wait(), 1) << shoal_->errors();
  EXPECT_THAT(shoal_->output(), HasSubstr("FAILED: process 'pilot' must not fail"));
  EXPECT_EQ(summary_value(results, "passed"), "false");
}

}  // namespace
