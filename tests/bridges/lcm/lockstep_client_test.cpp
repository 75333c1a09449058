#include "bridges/lcm/lockstep_client.hpp"

#include <gtest/gtest.h>

#include "fake_simulator.hpp"

namespace bridges {
namespace {

using lcm_test::bytes_of;
using lcm_test::FakeSimulator;
using lcm_test::own_url;
using lcm_test::text_of;
using namespace std::chrono_literals;

TEST(LockstepClient, RunsInStepWithTheSimulator) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  std::vector<std::string> seen;
  client.subscribe("auv1.depth", [&](std::span<const std::byte> payload) {
    seen.push_back(text_of({payload.begin(), payload.end()}));
  });
  std::thread thread([&] {
    const auto request = simulator.await_request();
    EXPECT_EQ(request.command, "join");
    EXPECT_EQ(request.client, "pilot");
    EXPECT_EQ(request.value, 0.1);
    simulator.reply(request, true, "");
    for (int step = 1; step <= 20; ++step) {
      simulator.bus().publish("auv1.depth", bytes_of(std::to_string(step)), sim::Time(0));
      simulator.tick(step, {"other", "pilot"}, step == 20);
      EXPECT_EQ(simulator.await_ack().step, step);
      // The command was sent before the acknowledgement, so it is here now.
      if (step < 20) {
        const auto command = simulator.commands().take();
        ASSERT_TRUE(command) << step;
        EXPECT_EQ(text_of(command->payload), "command " + std::to_string(step));
      }
    }
  });
  client.join(0.1, 10s);
  shoal::sim_tick_t tick;
  int ticks = 0;
  while (client.next_tick(tick)) {
    EXPECT_EQ(tick.step, ++ticks);
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(ticks));
    client.publish("auv1.cmd", bytes_of("command " + std::to_string(tick.step)));
    client.acknowledge(tick);
  }
  thread.join();
  EXPECT_EQ(ticks, 19);
  EXPECT_EQ(tick.step, 20);
  EXPECT_EQ(client.end(), LockstepClient::End::last_tick);
}

TEST(LockstepClient, EndsWithTheRunThoughTheLastTickNamesNobody) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"});
    EXPECT_EQ(simulator.await_ack().step, 1);
    simulator.tick(1, {}, true);  // the run ends at the step that was just acknowledged
  });
  client.join(0.1, 10s);
  client.set_silence_limit(10s);
  shoal::sim_tick_t tick;
  ASSERT_TRUE(client.next_tick(tick));
  client.acknowledge(tick);
  EXPECT_FALSE(client.next_tick(tick));
  thread.join();
  EXPECT_EQ(client.end(), LockstepClient::End::last_tick);
}

TEST(LockstepClient, AsksAgainUntilItIsAnswered) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  std::thread thread([&] {
    const auto first = simulator.await_request();
    const auto second = simulator.await_request();
    EXPECT_EQ(first.id, second.id);
    simulator.reply(second, true, "");
  });
  EXPECT_NO_THROW(client.join(1, 10s));
  thread.join();
}

TEST(LockstepClient, SaysWhyTheSimulatorRefuses) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  std::thread thread([&] { simulator.reply(simulator.await_request(), false, "the period must be > 0"); });
  try {
    client.join(-1, 10s);
    ADD_FAILURE();
  } catch (const BusError& error) {
    EXPECT_STREQ(error.what(), "the simulator refuses 'pilot': the period must be > 0");
  }
  thread.join();
}

TEST(LockstepClient, SaysThatItWasStoppedWhileItWaited) {
  LockstepClient client(own_url(1), "pilot");
  client.stop();
  try {
    client.join(1, 10s);
    ADD_FAILURE();
  } catch (const BusError& error) {
    EXPECT_EQ(std::string(error.what()).find("'pilot' was stopped while it waited for a simulator on udpm:"), 0u);
  }
}

TEST(LockstepClient, HandlerMaySubscribeToItsOwnChannel) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  int first = 0;
  int later = 0;
  client.subscribe("auv1.note", [&, text = std::string(40, 'x')](std::span<const std::byte>) {
    // Many: whatever holds the handlers has to grow.
    for (int i = 0; i < 50; ++i) client.subscribe("auv1.note", [&](std::span<const std::byte>) { ++later; });
    if (text == std::string(40, 'x')) ++first;  // it is still there
  });
  simulator.bus().publish("auv1.note", bytes_of("one"), sim::Time(0));
  simulator.bus().publish("auv1.note", bytes_of("two"), sim::Time(0));
  simulator.tick(1, {"pilot"});
  shoal::sim_tick_t tick;
  ASSERT_TRUE(client.next_tick(tick));
  EXPECT_EQ(first, 2);
  EXPECT_EQ(later, 50);  // with the second message
}

TEST(LockstepClient, SaysThatNoSimulatorAnswers) {
  LockstepClient client(own_url(1), "pilot");
  EXPECT_THROW(client.join(1, 50ms), BusError);
}

TEST(LockstepClient, AcknowledgesARepeatedTickAgain) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  simulator.tick(1, {"pilot"});
  shoal::sim_tick_t tick;
  ASSERT_TRUE(client.next_tick(tick));
  client.acknowledge(tick);
  EXPECT_EQ(simulator.await_ack().step, 1);
  simulator.tick(1, {"pilot"});
  simulator.tick(2, {"other"});
  simulator.tick(3, {"pilot"});
  ASSERT_TRUE(client.next_tick(tick));
  EXPECT_EQ(tick.step, 3);
  EXPECT_EQ(simulator.await_ack().step, 1);
}

TEST(LockstepClient, InvalidPayloadsAreIgnored) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  simulator.bus().publish("sim.tick", bytes_of(""), sim::Time(0));
  simulator.bus().publish("sim.tick", bytes_of("garbage that is no tick"), sim::Time(0));
  sim::Bytes cut = shoal::encode(shoal::sim_tick_t{});
  cut.pop_back();
  simulator.bus().publish("sim.tick", cut, sim::Time(0));
  simulator.bus().publish("sim.control.reply", cut, sim::Time(0));
  simulator.tick(5, {"pilot"});
  shoal::sim_tick_t tick;
  ASSERT_TRUE(client.next_tick(tick));
  EXPECT_EQ(tick.step, 5);
}

TEST(LockstepClient, EndsWhenStoppedAndAfterSilence) {
  LockstepClient client(own_url(1), "pilot");
  shoal::sim_tick_t tick;
  client.set_silence_limit(20ms);
  EXPECT_FALSE(client.next_tick(tick));
  EXPECT_EQ(client.end(), LockstepClient::End::silence);
  client.set_silence_limit(0ms);
  std::thread thread([&] { client.stop(); });
  EXPECT_FALSE(client.next_tick(tick));
  EXPECT_EQ(client.end(), LockstepClient::End::stopped);
  thread.join();
}

}  // namespace
}  // namespace bridges
