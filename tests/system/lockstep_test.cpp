// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <future>
#include <map>

#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/log/event_log.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "shoal/sim_resend_t.hpp"
#include "shoal/sim_tick_t.hpp"
#include "tests/system/lossy_relay.hpp"
#include "tests/system/shoal_program.hpp"

// Clients in lockstep, in processes of their own: what they do to a run, and what a run does when they fail.

namespace {

using namespace system_test;
using testing::HasSubstr;

/// Two rovers for some seconds.
std::string two_rovers(const std::string& duration_s, const std::string& more = "") {
  std::string text = "shoal: 1\nname: two_rovers\nrun: {duration_s: " + duration_s +
                     ", speed: max}\nstate_rate_hz: 20\nobjects:\n  - {name: ground, fixed: true, parts: [{shape: "
                     "plane}]}\nvehicles:\n";
  for (const char* name : {"rover1", "rover2"})
    text += "  - {name: " + std::string(name) + ", file: " + source("vehicles/rover.yaml") + ", position_m: [0, " +
            (name[5] == '1' ? "0" : "5") + ", 0.2]}\n";
  return text + more;
}

using Arguments = std::vector<std::string>;

/// A mission of three clients, whose commands depend on every byte that they get, also from each other.
struct Mission {
  std::string sim_url = own_url(0), client_url = own_url(0);
  std::string duration_s = "2";
  Arguments run;  ///< more for `shoal run`
  std::map<std::string, Arguments> clients = {
      {"a", {"--vehicle", "rover1", "--period", "0.05", "--receive", "rover1.odometry", "b.note", "sim.clock"}},
      {"b", {"--vehicle", "rover2", "--period", "0.1", "--receive", "rover2.odometry", "a.note", "rover1.odometry"}},
      {"c", {"--period", "0.2", "--receive", "a.note", "b.note", "sim.state"}},
  };

  /// The run hash, and what each client printed up to its number of ticks.
  std::string fly() const {
    const ScratchFolder folder;
    write_file(folder.file("world.yaml"), two_rovers(duration_s));
    Arguments arguments = {built("shoal"), "run", folder.file("world.yaml"), "--lcm-url", sim_url};
    for (const auto& [name, unused] : clients) arguments.insert(arguments.end(), {"--await", name});
    arguments.insert(arguments.end(), run.begin(), run.end());
    std::vector<std::unique_ptr<Program>> pilots;
    for (const auto& [name, options] : clients) {
      Arguments pilot = {built("lockstep_pilot"), "--name", name, "--lcm-url", client_url};
      pilot.insert(pilot.end(), options.begin(), options.end());
      pilots.push_back(std::make_unique<Program>(pilot));
    }
    Program shoal(arguments);
    const int exit_code = shoal.wait();
    std::string result = exit_code == 0 ? run_hash_in({0, shoal.output(), shoal.errors()})
                                        : "exit code " + std::to_string(exit_code) + ": " + shoal.errors();
    for (const auto& pilot : pilots) {
      const int code = pilot->wait();
      const std::string output = pilot->output();
      result += "\n" + std::to_string(code) + " " + output.substr(0, output.find(" requested")) + pilot->errors();
    }
    return result;
  }
};

/// The result of a mission that nothing disturbs.
const std::string& undisturbed() {
  static const std::string result = Mission{}.fly();
  return result;
}

Mission slowed(Mission mission, const std::string& up_to_ms, const std::string& seed = "1") {
  for (auto& [name, options] : mission.clients)
    options.insert(options.begin(), {"--slow-ms", up_to_ms, "--seed", seed});
  return mission;
}

TEST(LockstepMission, HasClientsThatMatter) {
  EXPECT_THAT(undisturbed(), HasSubstr("ticks 41"));
  Mission without;
  without.clients.erase("b");
  const std::string hash = without.fly().substr(0, 16);
  EXPECT_THAT(hash, testing::MatchesRegex("[0-9a-f]{16}"));
  EXPECT_THAT(undisturbed().substr(0, 16), testing::MatchesRegex("[0-9a-f]{16}"));
  EXPECT_NE(hash, undisturbed().substr(0, 16));
}

TEST(LockstepMission, IsTheSameAtAnySpeedWithSlowClientsAndAnyNumberOfThreads) {
  Mission mission;
  mission.run = {"--speed", "10", "--threads", "2"};
  EXPECT_EQ(mission.fly(), undisturbed());
  mission.run = {"--speed", "max", "--threads", "8"};
  EXPECT_EQ(slowed(mission, "5").fly(), undisturbed());
  mission.run = {"--speed", "1", "--threads", "1"};
  EXPECT_EQ(slowed(mission, "20", "2").fly(), undisturbed());
}

TEST(LockstepMission, IsTheSameAHundredTimes) {
  Mission mission;
  mission.duration_s = "0.5";
  const std::string expected = mission.fly();
  EXPECT_THAT(expected, HasSubstr("ticks 11"));
  constexpr int at_once = 4;
  for (int round = 0; round < 100 / at_once; ++round) {
    std::vector<std::future<std::string>> results;
    for (int i = 0; i < at_once; ++i) {
      mission.sim_url = mission.client_url = own_url(i);
      mission.run = {"--threads", std::to_string(1 << (round + i) % 4)};
      const Mission flown = (round + i) % 2 == 0 ? slowed(mission, "2", std::to_string(round * at_once + i)) : mission;
      results.push_back(std::async(std::launch::async, [flown] { return flown.fly(); }));
    }
    for (auto& result : results) ASSERT_EQ(result.get(), expected) << "round " << round;
  }
}

TEST(LockstepMission, IsTheSameOverANetworkThatLosesAThird) {
  LossyRelay relay(own_url(0), own_url(1), 0.3, 7);
  Mission mission;
  mission.client_url = own_url(1);
  EXPECT_EQ(mission.fly(), undisturbed());
  EXPECT_GT(relay.lost(), 100);
  EXPECT_GT(relay.repeated(), 30);
  EXPECT_GT(relay.swapped(), 30);
}

/// The channels of a record with their numbers of messages.
std::map<std::string, int> channels_in(const std::string& record) {
  std::map<std::string, int> counts;
  bridges::EventLogReader reader(record);
  while (const auto event = reader.next()) ++counts[event->channel];
  return counts;
}

TEST(LockstepMission, IsRecordedWithAllThatItsClientsPublishAlsoOverANetworkThatLosesAThird) {
  const ScratchFolder folder;
  Mission mission;
  mission.clients["d"] = {"--period", "0.1"};  // no one receives d.note
  mission.run = {"--record", folder.file("a.lcm")};
  const std::string result = mission.fly();
  EXPECT_THAT(result, testing::Not(HasSubstr("exit code")));
  const auto counts = channels_in(folder.file("a.lcm"));
  EXPECT_EQ(counts.at("a.note"), 41);  // every 0.05 s from 0 to 2 s
  EXPECT_EQ(counts.at("d.note"), 21);
  // The same again, with losses.
  Mission with_losses = mission;
  with_losses.run = {"--record", folder.file("b.lcm")};
  with_losses.client_url = own_url(1);
  const LossyRelay relay(own_url(0), own_url(1), 0.3, 7);
  EXPECT_EQ(with_losses.fly(), result);
  EXPECT_EQ(text_of_file(folder.file("b.lcm")), text_of_file(folder.file("a.lcm")));
}

TEST(LockstepMission, ContinuesAtOnceWithoutAClientThatLeavesOverANetworkThatLosesAThird) {
  LossyRelay relay(own_url(0), own_url(1), 0.3, 7);
  Mission mission;
  mission.client_url = own_url(1);
  for (auto& [name, options] : mission.clients) options.insert(options.begin(), {"--timeout", "1000"});
  mission.clients["c"].insert(mission.clients["c"].begin(), {"--leave-at", "3"});
  EXPECT_THAT(mission.fly(), HasSubstr("ticks 3"));  // it would wait for 1000 s
}

/// A run of two rovers that starts `pilot` by itself.
class Policy : public testing::Test {
 protected:
  Policy() {
    listener_.listen("sim.control.reply");
    listener_.listen("sim.tick");
  }
  /// `options`: of lockstep_pilot, in YAML.
  void start(const std::string& options, const std::string& world = "") {
    write_file(folder_.file("world.yaml"),
               two_rovers(duration_s_, "processes: [{name: pilot, client: pilot, command: [" + built("lockstep_pilot") +
                                           ", --name, pilot, --vehicle, rover1, --lcm-url, '{lcm_url}', " + options +
                                           "]" + on_exit_ + "}]\n" + world));
    shoal_ = std::make_unique<Program>(Arguments{built("shoal"), "run", folder_.file("world.yaml"), "--launch",
                                                 "--lcm-url", own_url(), "--results", folder_.file("results")});
  }
  void await_error(const std::string& text) {
    EXPECT_TRUE(await([&] { return shoal_->errors().find(text) != std::string::npos; }, timeout)) << shoal_->errors();
  }
  /// Sends a request once, as sent again it might be executed twice, and returns its reply.
  shoal::sim_control_reply_t request(const std::string& command, const std::string& text = "",
                                     const std::string& client = "test", double value = 0) {
    if (answering_ != shoal_.get()) await_answers();
    const std::int32_t id = send(command, text, client, value);
    if (const auto reply = reply_to(id, client, timeout)) return *reply;
    ADD_FAILURE() << "no reply to " << command << ": " << shoal_->errors();
    return {};
  }
  std::string summary() const { return text_of_file(folder_.file("results") + "/summary.json"); }

  ScratchFolder folder_;
  bridges::LcmListener listener_{own_url()};
  std::unique_ptr<Program> shoal_;
  std::string duration_s_ = "2";
  std::string on_exit_;  ///< of the process, in YAML

 private:
  /// A program that starts receives nothing yet; "where" may be asked many times.
  void await_answers() {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (std::chrono::steady_clock::now() < deadline) {
      const std::int32_t question = send("where", "", "test", 0);
      if (!reply_to(question, "test", 200ms)) continue;
      answering_ = shoal_.get();
      return;
    }
  }
  std::int32_t send(const std::string& command, const std::string& text, const std::string& client, double value) {
    shoal::sim_control_request_t request{};
    request.id = ++id_;
    request.client = client;
    request.command = command;
    request.text = text;
    request.value = value;
    listener_.publish("sim.control", shoal::encode(request));
    return id_;
  }
  std::optional<shoal::sim_control_reply_t> reply_to(std::int32_t id, const std::string& client,
                                                     std::chrono::milliseconds limit) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (std::chrono::steady_clock::now() < deadline) {
      const auto message = listener_.next(50ms);
      if (!message || message->channel != "sim.control.reply") continue;
      const auto reply = shoal::decode<shoal::sim_control_reply_t>(message->payload, shoal::Finite::any);
      if (reply.id == id && reply.client == client) return reply;
    }
    return std::nullopt;
  }

  const Program* answering_ = nullptr;  ///< the program that has answered
  std::int32_t id_ = 0;
};

TEST_F(Policy, EndByDefaultEndsTheRunWithASilentClient) {
  start("--stop-at, '5'", "lockstep: {timeout_s: 0.5}\n");
  EXPECT_EQ(shoal_->wait(), 5);
  EXPECT_THAT(shoal_->errors(), HasSubstr("lockstep: no acknowledgement from 'pilot' for step 40 within 0.5 s"));
  EXPECT_THAT(summary(), HasSubstr("\"timeouts\": 1"));
}

TEST_F(Policy, ContinueGoesOnWithoutASilentClient) {
  start("--stop-at, '5', --on-timeout, continue, --timeout, '0.5'");
  EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
  EXPECT_THAT(shoal_->errors(), HasSubstr("the world continues without it"));
  EXPECT_THAT(summary(), HasSubstr("\"ended\": \"no acknowledgement from 'pilot' for step 40 within 0.5 s\""));
}

TEST_F(Policy, ContinueGoesOnWithoutAKilledClientAtOnce) {
  start("--die-at, '5', --on-timeout, continue, --timeout, '1000'");
  EXPECT_EQ(shoal_->wait(), 1) << shoal_->errors();
  EXPECT_THAT(shoal_->output(), HasSubstr("FAILED: process 'pilot' must not fail; it was killed by signal 9"));
  EXPECT_THAT(summary(), HasSubstr("\"sim_time_s\": 2.0"));
  EXPECT_THAT(shoal_->errors(), HasSubstr("the process of client 'pilot' ended before it answered step 40"));
}

TEST_F(Policy, AClientThatEndsBeforeItsLastTickWithoutLeavingHasFailedWhateverItsExitCode) {
  start("--quit-at, '5'", "lockstep: {timeout_s: 1000}\n");
  EXPECT_EQ(shoal_->wait(), 1) << shoal_->errors();
  const char* how = "exited with code 0 before the last tick of client 'pilot', which did not leave";
  EXPECT_THAT(shoal_->errors(), HasSubstr(std::string("process 'pilot' ") + how));
  EXPECT_THAT(shoal_->output(), HasSubstr(std::string("FAILED: process 'pilot' must not fail; it ") + how));
  EXPECT_THAT(summary(), HasSubstr("\"failed\": true"));
}

TEST_F(Policy, AClientThatLeavesHasNotFailed) {
  start("--leave-at, '5'", "lockstep: {timeout_s: 1000}\n");
  EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
  EXPECT_THAT(shoal_->errors(),
              testing::ContainsRegex("lockstep: client 'pilot' left at 0\\.(4[0-9]|50) s on the world's bus"))
      << "between its last answer and its next tick";
  EXPECT_THAT(summary(), testing::Not(HasSubstr("\"failed\": true")));
  EXPECT_THAT(summary(), HasSubstr("\"ended\": \"left\""));
}

TEST_F(Policy, AClientThatLeavesForAReasonHasFailedAtThatTime) {
  start("--leave-at, '5', --reason, no echo", "lockstep: {timeout_s: 1000}\n");
  EXPECT_EQ(shoal_->wait(), 1) << shoal_->errors();
  // Between its last answer and its next tick.
  const char* at = "0\\.(39999|4[0-9]|50?)";
  EXPECT_THAT(shoal_->output(), testing::ContainsRegex("FAILED: process 'pilot' must not fail; it left: no echo at " +
                                                       std::string(at) + " s"));
  EXPECT_THAT(summary(), testing::ContainsRegex("\"how\": \"left: no echo\",\\s*\"sim_time_s\": " + std::string(at)));
  EXPECT_THAT(summary(), testing::ContainsRegex("\"ended\": \"left: no echo\",\\s*\"ended_s\": " + std::string(at)));
}

TEST_F(Policy, AFailureDoesNotCountWhereTheWorldSaysIgnore) {
  on_exit_ = ", on_exit: ignore";
  start("--die-at, '5', --on-timeout, continue, --timeout, '1000'");
  EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
  EXPECT_THAT(summary(), HasSubstr("was killed by signal 9"));
  EXPECT_THAT(summary(), HasSubstr("\"failed\": false"));
  EXPECT_THAT(summary(), HasSubstr("\"rules\": []"));
}

TEST_F(Policy, AnotherSimulatorOnTheBusDoesNotEndTheClients) {
  duration_s_ = "forever";
  start("--period, '0.01', --slow-ms, '2'");
  const auto await_ticks = [&](int count) {
    for (int ticks = 0; ticks < count;) {
      const auto message = listener_.next(timeout);
      if (!message) return false;
      if (message->channel != "sim.tick") continue;
      const auto tick = shoal::decode<shoal::sim_tick_t>(message->payload, shoal::Finite::any);
      if (tick.count == 1 && tick.client[0].name == "pilot") ++ticks;
    }
    return true;
  };
  ASSERT_TRUE(await_ticks(1));
  const Ended second = run_shoal({"run", source("worlds/minimal.yaml"), "--lcm-url", own_url(), "--lcm-shared",
                                  "--duration", "0.1", "--speed", "max"});
  EXPECT_EQ(second.exit_code, 0) << second.errors;
  // What waits here came before the other run ended, so many more come after it.
  EXPECT_TRUE(await_ticks(1000));
  EXPECT_EQ(shoal_->await_children(1).size(), 1u);
  EXPECT_TRUE(request("quit").ok);
  EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
  EXPECT_THAT(shoal_->errors(),
              HasSubstr("another simulator was started with --lcm-shared on the world's bus of this run"));
  EXPECT_THAT(text_of_file(folder_.file("results") + "/pilot.log"), HasSubstr(" end 1"));
}

TEST_F(Policy, AKilledClientFailsARunThatIsJudgedThoughTheWorldContinues) {
  start("--die-at, '5', --on-timeout, continue, --timeout, '1000'",
        "metrics: [{name: distance, type: distance, vehicle: rover2}]\npass: [distance.travelled_m < 1e6]\n");
  EXPECT_EQ(shoal_->wait(), 1) << shoal_->errors();
  EXPECT_THAT(shoal_->output(), HasSubstr("FAILED: process 'pilot' must not fail; it was killed by signal 9"));
  EXPECT_THAT(summary(), HasSubstr("\"passed\": false"));
  EXPECT_THAT(summary(), HasSubstr("\"ended\": \"duration\""));
}

TEST_F(Policy, EndThatWasAgreedEndsTheRunWithAKilledClientAtOnce) {
  start("--die-at, '5'", "lockstep: {on_timeout: end, timeout_s: 1000}\n");
  EXPECT_EQ(shoal_->wait(), 5);
  EXPECT_THAT(shoal_->errors(), HasSubstr("; its `on_timeout` applies"));
}

TEST_F(Policy, KilledClientThatAgreedNothingIsGoneAndTheRunContinues) {
  start("--die-at, '5'", "lockstep: {timeout_s: 1000}\n");
  EXPECT_EQ(shoal_->wait(), 1) << shoal_->errors();
  EXPECT_THAT(summary(), HasSubstr("\"ended\": \"its process ended\""));
}

TEST_F(Policy, PauseHoldsTheWorldUntilSomeOneResumesIt) {
  start("--stop-at, '5', --on-timeout, pause, --timeout, '0.1'");
  await_error("the world pauses");
  const auto before = request("alive").utime;
  EXPECT_EQ(request("alive").utime, before);  // it stands
  EXPECT_TRUE(request("resume").ok);
  EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
  EXPECT_THAT(shoal_->errors(), HasSubstr("the world continues without it"));
}

TEST_F(Policy, PauseEndsWhenAStalledClientAnswers) {
  duration_s_ = "forever";
  start("--period, '0.01', --stop-at, '5', --on-timeout, pause, --timeout, '0.5'");
  await_error("the world pauses");
  const std::vector<pid_t> children = shoal_->await_children(1);
  ASSERT_EQ(children.size(), 1u);
  kill(children[0], SIGCONT);
  await_error("lockstep: the world continues\n");
  EXPECT_TRUE(request("quit").ok);
  EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
  EXPECT_THAT(summary(), HasSubstr("\"ended\": \"with the run\""));
}

// UberSim halts forever when one client does not answer, and another copy of the client cannot take its place.
TEST_F(Policy, WaitWaitsForAKilledClientUntilAnotherTakesItsPlace) {
  start("--die-at, '5', --on-timeout, wait, --timeout, '1000'");  // its end is noticed at once
  await_error("the world waits");
  Program second({built("lockstep_pilot"), "--name", "pilot", "--vehicle", "rover1", "--lcm-url", own_url()});
  EXPECT_EQ(shoal_->wait(), 1) << shoal_->errors();  // its own program failed
  EXPECT_EQ(second.wait(), 0) << second.errors();
  EXPECT_THAT(second.output(), HasSubstr("ticks 17 "));  // 21 for the whole run, of which 4 were answered by the first
}

TEST_F(Policy, WaitGivesTheNameOfAStalledClientToAnother) {
  start("--stop-at, '5', --on-timeout, wait, --timeout, '0.1'");
  await_error("the world waits");
  Program second({built("lockstep_pilot"), "--name", "pilot", "--vehicle", "rover1", "--lcm-url", own_url()});
  EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
  EXPECT_EQ(second.wait(), 0) << second.errors();
}

TEST_F(Policy, ASecondClientOfANameIsRefusedWhileTheFirstAnswers) {
  duration_s_ = "forever";
  start("--period, '0.01', --slow-ms, '20'");
  while (const auto message = listener_.next(timeout))
    if (message->channel == "sim.tick") break;
  Program second({built("lockstep_pilot"), "--name", "pilot", "--vehicle", "rover1", "--lcm-url", own_url()});
  EXPECT_EQ(second.wait(), 4);
  EXPECT_THAT(second.errors(), HasSubstr("another client named 'pilot' takes part and is responding"));
  EXPECT_TRUE(request("quit").ok);
  EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
}

TEST_F(Policy, AClientThatAnswersTooLateIsNotifiedAndMayJoinAgain) {
  duration_s_ = "forever";
  start("--period, '0.01', --stop-at, '5', --on-timeout, continue, --timeout, '0.5'");
  await_error("the world continues without it");
  const std::vector<pid_t> children = shoal_->await_children(1);
  ASSERT_EQ(children.size(), 1u);
  kill(children[0], SIGCONT);
  await_error("process 'pilot' exited with code 1");
  EXPECT_THAT(text_of_file(folder_.file("results") + "/pilot.log"), HasSubstr("join again"));
  EXPECT_TRUE(request("quit").ok);
  EXPECT_EQ(shoal_->wait(), 1);
}

/// Two clients that go back with their world.
class Rewound : public Policy {
 protected:
  /// What is there at 2 s when the world went back to 0.5 s from the given step: the run hash, and what the clients
  /// handled since.
  std::string from_step(int step) {
    write_file(folder_.file("world.yaml"), two_rovers("2"));
    Program a({built("lockstep_pilot"), "--name", "a", "--vehicle", "rover1", "--period", "0.05", "--go-back",
               "--lcm-url", own_url(), "--receive", "rover1.odometry", "b.note"});
    Program b({built("lockstep_pilot"), "--name", "b", "--vehicle", "rover2", "--period", "0.1", "--go-back",
               "--lcm-url", own_url(), "--receive", "rover2.odometry", "a.note"});
    shoal_ = std::make_unique<Program>(Arguments{built("shoal"), "run", folder_.file("world.yaml"), "--paused",
                                                 "--lcm-url", own_url(), "--await", "a", "--await", "b"});
    EXPECT_TRUE(request("until", "", "test", step * 0.01).ok);
    const std::string there = "step " + std::to_string(step) + ", ";
    EXPECT_TRUE(await([&] { return request("where").text.find(there) == 0; }, timeout));
    EXPECT_THAT(request("rewind", "", "test", step * 0.01 - 0.5).text, HasSubstr("step 50, 0.5 s, branch 1, paused"))
        << shoal_->errors();
    EXPECT_TRUE(request("resume").ok);
    EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
    std::string result = run_hash_in({0, shoal_->output(), shoal_->errors()});
    for (Program* pilot : {&a, &b}) {
      EXPECT_EQ(pilot->wait(), 0) << pilot->errors();
      result += " " + pilot->output().substr(0, pilot->output().find(" ticks"));
    }
    return result;
  }
};

TEST_F(Rewound, ClientsDoTheSameOnTheNewBranchWhereverTheWorldCameFrom) {
  const std::string result = from_step(120);
  EXPECT_THAT(result, testing::MatchesRegex("[0-9a-f]{16} hash [0-9a-f]{16} hash [0-9a-f]{16}"));
  EXPECT_EQ(from_step(173), result);  // where b is not asked
}

// Nonsense and floods from everyone, while a client flies its mission.
TEST_F(Policy, WrongAcknowledgementsAndFloodsChangeNothing) {
  start("--period, '0.01', --slow-ms, '1'");
  const std::string undisturbed_run = [&] {
    EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
    return summary_value(folder_.file("results"), "run_hash");
  }();
  start("--period, '0.01', --slow-ms, '10'");  // a second at least, in which a busy machine lets the flood begin
  shoal::sim_ack_t ack{};
  shoal::sim_resend_t question{};
  shoal::sim_control_request_t join{};
  std::int64_t sent = 0;
  while (shoal_->running()) {
    for (int i = 0; i < 20; ++i, ++sent) {
      ack.client = question.client = i % 2 == 0 ? "pilot" : "stranger" + std::to_string(i);
      ack.step = i * 10;
      ack.session = question.session = i % 3;
      ack.sequence = question.sequence = sent;
      listener_.publish("sim.ack", shoal::encode(ack));
      listener_.publish("sim.resend", shoal::encode(question));
      join.client = i % 2 == 0 ? "pilot" : "";
      join.command = "join";
      join.value = 0.01;
      join.text = i % 4 == 0 ? "{session: 5}" : "{session: five";
      listener_.publish("sim.control", shoal::encode(join));
    }
    while (listener_.next(1ms)) {
    }
  }
  EXPECT_EQ(shoal_->wait(), 0) << shoal_->errors();
  EXPECT_EQ(summary_value(folder_.file("results"), "run_hash"), undisturbed_run);
  EXPECT_GT(std::stol(summary_value(folder_.file("results"), "bad_messages")), 100);
}

}  // namespace
