// SPDX-License-Identifier: BSD-3-Clause
#include "shoal/client.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <thread>

#include "shoal/helm_command_t.hpp"
#include "shoal/pressure_t.hpp"
#include "shoal/utime_t.hpp"
#include "tests/bridges/lockstep/fake_simulator.hpp"

namespace {

using lcm_test::bytes_of;
using lcm_test::FakeSimulator;
using lcm_test::own_url;
using namespace std::chrono_literals;

shoal::pressure_t at_depth(double depth_m) {
  shoal::pressure_t message{};
  message.depth_m = depth_m;
  return message;
}

shoal::utime_t clock_at(std::int64_t utime) {
  shoal::utime_t clock{};
  clock.utime = utime;
  return clock;
}

TEST(Client, RunsInStepWithTheSimulator) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  double depth_m = 0;
  client.subscribe<shoal::pressure_t>("auv1.pressure", [&](const shoal::pressure_t& p) { depth_m = p.depth_m; });
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    for (int step = 1; step <= 10; ++step) {
      simulator.send("auv1.pressure", at_depth(step));
      simulator.tick(step, {"pilot"}, step == 10);
      EXPECT_EQ(simulator.await_ack().step, step);
      if (step == 10) break;
      // What was published before the acknowledgement is here now.
      const auto command = simulator.commands().take();
      ASSERT_TRUE(command) << step;
      const auto helm = shoal::decode<shoal::helm_command_t>(command->payload, shoal::Finite::any);
      EXPECT_EQ(helm.depth_m, step);
    }
  });
  client.join(0.1, 60s);
  int ticks = 0;
  while (const auto utime = client.next_tick()) {
    EXPECT_EQ(*utime, 1000 + 10 * ++ticks);
    shoal::helm_command_t helm{};
    helm.depth_m = depth_m;
    client.publish("auv1.cmd", helm);
  }
  thread.join();
  EXPECT_EQ(ticks, 9);
  EXPECT_EQ(client.end(), shoal::Client::End::last_tick);
  EXPECT_EQ(client.counts().received, 10u);
  EXPECT_EQ(client.counts().published, 9u);
  EXPECT_EQ(client.counts().bad, 0u);
}

TEST(Client, JoinsAgainWhileATickIsOpen) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  client.set_silence_limit(60s);
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"});
    auto request = simulator.await_request();
    while (request.value == 0.1) request = simulator.await_request();  // of the first, sent again
    simulator.reply(request, true, "");
    EXPECT_EQ(simulator.await_ack().sequence, 1);
    const auto command = simulator.commands().take();
    EXPECT_TRUE(command);
    simulator.tick(2, {"pilot"});
    EXPECT_EQ(simulator.await_ack().sequence, 2);
    simulator.tick(3, {"pilot"}, true);
  });
  client.join(0.1, 60s);
  EXPECT_TRUE(client.next_tick());
  client.publish("auv1.cmd", shoal::helm_command_t{});
  client.join(0.2, 60s);
  EXPECT_TRUE(client.next_tick());
  EXPECT_FALSE(client.next_tick());
  EXPECT_EQ(client.end(), shoal::Client::End::last_tick);
  thread.join();
}

TEST(Client, GivesNothingAtOnceWhenAskedAgainAfterTheEnd) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  client.set_silence_limit(60s);
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"}, true);
    simulator.await_ack();
  });
  client.join(0.1, 60s);
  EXPECT_FALSE(client.next_tick());
  thread.join();
  const auto before = std::chrono::steady_clock::now();
  EXPECT_FALSE(client.next_tick());
  EXPECT_FALSE(client.wait_until(1'000'000));
  EXPECT_LT(std::chrono::steady_clock::now() - before, 30s);
  EXPECT_EQ(client.end(), shoal::Client::End::last_tick);
}

/// What a client that waits longer than its patience says on standard error.
std::string said_by(const std::function<void(shoal::Client&)>& work) {
  shoal::Client client("pilot", own_url(1));
  client.set_wait_warning(1ms);
  client.set_silence_limit(200ms);
  testing::internal::CaptureStderr();
  work(client);
  return testing::internal::GetCapturedStderr();
}

TEST(Client, SaysWhatItWaitsForWhenThatTakesLong) {
  using testing::StartsWith;
  const std::string at = ", at " + own_url(1);
  EXPECT_THAT(said_by([](shoal::Client& client) { EXPECT_THROW(client.join(0.1, 300ms), shoal::ClientError); }),
              StartsWith("'pilot' waits for a simulator to answer its join on 'sim.control.reply'" + at));
  EXPECT_THAT(said_by([](shoal::Client& client) {
                client.follow(0.1);
                EXPECT_FALSE(client.next_tick());
              }),
              StartsWith("'pilot' waits for the time on 'sim.clock', which a simulator publishes during its run" + at));
  EXPECT_EQ(said_by([](shoal::Client& client) {
              client.set_wait_warning(0ms);
              client.follow(0.1);
              EXPECT_FALSE(client.next_tick());
            }),
            "");
}

TEST(Client, SaysThatItWaitsForItsFirstTick) {
  FakeSimulator simulator;
  std::thread thread([&] { simulator.reply(simulator.await_request(), true, ""); });
  const std::string shown = said_by([](shoal::Client& client) {
    client.set_wait_warning(60s);
    client.join(0.1, 60s);
    client.set_wait_warning(1ms);
    EXPECT_FALSE(client.next_tick());
    EXPECT_EQ(client.end(), shoal::Client::End::silence);
  });
  thread.join();
  EXPECT_NE(shown.find("'pilot' waits for its first tick on 'sim.tick'"), std::string::npos) << shown;
}

TEST(Client, WaitsForATime) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    for (int step = 1; step <= 6; ++step) {
      simulator.tick(step, {"pilot"}, step == 6);
      EXPECT_EQ(simulator.await_ack().step, step);
    }
  });
  client.join(0.1, 60s);
  EXPECT_EQ(client.wait_until(1031), 1040);  // ticks come at 1010, 1020 and so on
  EXPECT_EQ(client.wait_until(1000), 1050);  // in the past: the next one
  EXPECT_EQ(client.wait_until(1'000'000), std::nullopt);
  thread.join();
}

/// Lets 'pilot' join, gives it one tick, and returns its first other request.
auto request_after_first_tick(FakeSimulator& simulator) {
  simulator.reply(simulator.await_request(), true, "");
  simulator.tick(1, {"pilot"});
  auto request = simulator.await_request();
  while (request.command == "join") request = simulator.await_request();
  return request;
}

TEST(Client, LeavesWhenItEndsBeforeTheRun) {
  FakeSimulator simulator;
  std::thread thread([&] {
    const auto request = request_after_first_tick(simulator);
    EXPECT_EQ(request.command, "leave");
    EXPECT_EQ(request.client, "pilot");
  });
  {
    shoal::Client client("pilot", own_url(1));
    client.join(0.1, 60s);
    ASSERT_TRUE(client.next_tick());
  }
  thread.join();
}

TEST(Client, SaysWhyItLeaves) {
  FakeSimulator simulator;
  std::thread thread([&] {
    const auto request = request_after_first_tick(simulator);
    EXPECT_THAT(request.text, testing::HasSubstr("reason: \"no map\""));
  });
  {
    shoal::Client client("pilot", own_url(1));
    client.join(0.1, 60s);
    ASSERT_TRUE(client.next_tick());
    client.set_reason_to_leave("no map");
  }
  thread.join();
}

TEST(Client, FollowsTheClockWithoutHoldingTheWorld) {
  FakeSimulator simulator;
  shoal::Client client("watcher", own_url(1));
  client.follow(1e-3);
  for (const int at : {10'300, 10'700, 11'200, 11'900, 14'500}) simulator.send("sim.clock", clock_at(at));
  simulator.bus().publish("sim.clock", bytes_of("no clock"), sim::Time(0));
  std::thread thread([&] {
    const auto request = simulator.await_request();
    EXPECT_EQ(request.command, "follow");
    simulator.reply(request, true, "");
    simulator.tick(7, {}, true);  // of another run: it does not list the watcher
    simulator.send("sim.clock", clock_at(14'900));
    simulator.send("sim.clock", clock_at(15'100));
    simulator.tick(8, {"watcher"}, true);
  });
  std::vector<std::int64_t> ticks;
  while (const auto utime = client.next_tick()) ticks.push_back(*utime);
  thread.join();
  EXPECT_EQ(ticks, (std::vector<std::int64_t>{10'300, 11'200, 14'500, 15'100}));  // once in each millisecond
  EXPECT_EQ(client.end(), shoal::Client::End::last_tick);
}

TEST(Client, FollowsTheClockOfANewRun) {
  FakeSimulator simulator;
  shoal::Client client("watcher", own_url(1));
  client.follow(1);
  for (const int seconds : {100, 101, 3, 4}) simulator.send("sim.clock", clock_at(seconds * 1'000'000));
  for (const int seconds : {100, 101, 3, 4}) EXPECT_EQ(client.next_tick(), seconds * 1'000'000);
}

TEST(Client, BadPayloadsAreCountedAndToldOnce) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  int handled = 0;
  client.subscribe<shoal::pressure_t>("auv1.pressure", [&](const shoal::pressure_t&) { ++handled; });
  client.subscribe<shoal::pressure_t>(
      "auv1.strict", [&](const shoal::pressure_t&) { ++handled; }, shoal::Finite::required);
  sim::Bytes cut = shoal::encode(at_depth(1));
  cut.pop_back();
  for (int i = 0; i < 3; ++i) simulator.bus().publish("auv1.pressure", cut, sim::Time(0));
  simulator.send("auv1.pressure", clock_at(1));  // another type
  simulator.send("auv1.pressure", at_depth(std::numeric_limits<double>::quiet_NaN()));
  simulator.send("auv1.strict", at_depth(std::numeric_limits<double>::quiet_NaN()));
  client.follow(1);
  simulator.send("sim.clock", clock_at(1));
  testing::internal::CaptureStderr();
  EXPECT_TRUE(client.next_tick());
  const std::string reported = testing::internal::GetCapturedStderr();
  EXPECT_EQ(handled, 1);
  EXPECT_EQ(client.counts().bad, 5u);
  EXPECT_EQ(client.counts().received, 6u);
  EXPECT_EQ(std::count(reported.begin(), reported.end(), '\n'), 2) << reported;  // one line for each channel
}

TEST(Client, HandlersMayRefuseAMessage) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  client.subscribe<shoal::pressure_t>("auv1.pressure",
                                      [](const shoal::pressure_t&) { throw shoal::MessageError("too deep"); });
  client.subscribe_bytes("auv1.raw", [](std::span<const std::byte>) { throw std::runtime_error("my own trouble"); });
  simulator.send("auv1.pressure", at_depth(1));
  simulator.bus().publish("auv1.raw", bytes_of("x"), sim::Time(0));
  client.follow(1);
  simulator.send("sim.clock", clock_at(1));
  testing::internal::CaptureStderr();
  EXPECT_THROW(client.next_tick(), std::runtime_error);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "auv1.pressure: too deep (ignored; further ones are only counted)\n");
  EXPECT_TRUE(client.next_tick());
}

TEST(Client, ErrorsAreItsOwn) {
  EXPECT_THROW(shoal::Client("pilot", "no url"), shoal::ClientError);
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  EXPECT_THROW(client.next_tick(), std::logic_error);
  EXPECT_THROW(client.join(1, 50ms), shoal::ClientError);
  EXPECT_THROW(client.follow(0), shoal::ClientError);
  EXPECT_THROW(client.follow(std::numeric_limits<double>::quiet_NaN()), shoal::ClientError);
  EXPECT_THROW(client.publish(std::string(64, 'x'), at_depth(1)), shoal::ClientError);
}

TEST(Client, SaysWhyTheSimulatorRefuses) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  std::thread thread([&] { simulator.reply(simulator.await_request(), false, "the period must be > 0"); });
  try {
    client.join(-1, 60s);
    ADD_FAILURE();
  } catch (const shoal::ClientError& error) {
    EXPECT_STREQ(error.what(), "the simulator rejects 'pilot': the period must be > 0");
  }
  thread.join();
}

TEST(Client, EndsWhenStoppedAndAfterSilence) {
  shoal::Client client("pilot", own_url(1));
  client.follow(1);
  client.set_silence_limit(20ms);
  EXPECT_FALSE(client.next_tick());
  EXPECT_EQ(client.end(), shoal::Client::End::silence);
  client.set_silence_limit(0ms);
  std::thread thread([&] { client.stop(); });
  EXPECT_FALSE(client.next_tick());
  EXPECT_EQ(client.end(), shoal::Client::End::stopped);
  thread.join();
}

}  // namespace
