// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/lockstep_client.hpp"

#include <gtest/gtest.h>

#include "tests/bridges/lockstep/fake_simulator.hpp"

namespace bridges {
namespace {

using lcm_test::bytes_of;
using lcm_test::FakeSimulator;
using lcm_test::own_url;
using lcm_test::text_of;
using namespace std::chrono_literals;

void join(FakeSimulator& simulator, LockstepClient& client) {
  std::thread thread([&] { simulator.reply(simulator.await_request(), true, ""); });
  client.join(0.1, 60s);
  thread.join();
}

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
      simulator.publish("auv1.depth", bytes_of(std::to_string(step)));
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
  client.join(0.1, 60s);
  shoal::sim_tick_t tick{};
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

TEST(LockstepClient, IsNotNotifiedOfWhatAnotherClientOfItsNameIs) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  std::thread thread([&] {
    const auto request = simulator.await_request();
    shoal::sim_control_reply_t of_another{};
    of_another.id = request.id;
    of_another.client = "pilot";
    of_another.session = 1234;
    of_another.text = "there is one already";
    simulator.send("sim.control.reply", of_another);
    simulator.reply(request, true, "");
    simulator.tick(0, {"pilot"});
    EXPECT_EQ(simulator.await_ack().step, 0);
    simulator.send("sim.control.reply", of_another);
    of_another.session = 0;
    simulator.send("sim.control.reply", of_another);
    simulator.tick(1, {"pilot"}, true);
    EXPECT_EQ(simulator.await_ack().step, 1);
  });
  client.join(0.1, 60s);
  client.set_silence_limit(60s);
  shoal::sim_tick_t tick{};
  ASSERT_TRUE(client.next_tick(tick));
  client.acknowledge(tick);
  EXPECT_FALSE(client.next_tick(tick));
  thread.join();
  EXPECT_EQ(client.end(), LockstepClient::End::last_tick);
}

TEST(LockstepClient, RequestsWithANumberThatNoOneElseHas) {
  FakeSimulator simulator;
  std::vector<std::int32_t> ids;
  for (int i = 0; i < 3; ++i) {
    LockstepClient client(own_url(1), "pilot");
    std::thread thread([&] {
      const auto request = simulator.await_request();
      ids.push_back(request.id);
      simulator.reply(request, true, "");
    });
    client.join(0.1, 60s);
    thread.join();
  }
  // In one process, so the number of the process does not make them differ.  They are drawn out of a thousand millions.
  EXPECT_NE(ids.at(0), ids.at(1));
  EXPECT_NE(ids.at(1), ids.at(2));
}

TEST(LockstepClient, SaysThatItLivesBeforeItsFirstTick) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    shoal::sim_tick_t question{};
    question.step = -1;
    shoal::sim_due_t& due = question.client.emplace_back();
    due.name = "pilot";
    due.session = simulator.session("pilot");
    question.count = 1;
    simulator.send("sim.tick", question);
    const auto ack = simulator.await_ack();
    EXPECT_EQ(ack.sequence, 0);
    EXPECT_EQ(ack.count, 0);
    simulator.tick(1, {"pilot"}, true);
    EXPECT_EQ(simulator.await_ack().sequence, 1);
  });
  client.join(0.1, 60s);
  client.set_silence_limit(60s);
  shoal::sim_tick_t tick{};
  EXPECT_FALSE(client.next_tick(tick));
  thread.join();
}

TEST(LockstepClient, ContinuesWhenALastTickThatDoesNotListItEndsAnotherRun) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"});
    EXPECT_EQ(simulator.await_ack().step, 1);
    simulator.tick(1, {}, true);        // of a run without clients
    simulator.tick(1, {"else"}, true);  // of one with others
    shoal::sim_tick_t tick{};           // and of one with a client of the same name
    tick.last = 1;
    tick.client.resize(1);
    tick.client[0].name = "pilot";
    tick.client[0].session = simulator.session("pilot") + 1;
    tick.client[0].sequence = 2;
    tick.count = 1;
    simulator.send("sim.tick", tick);
    simulator.tick(2, {"pilot"});
    EXPECT_EQ(simulator.await_ack().step, 2);
    simulator.tick(2, {"pilot"}, true);
    EXPECT_EQ(simulator.await_ack().sequence, 3);
  });
  client.join(0.1, 60s);
  client.set_silence_limit(60s);
  shoal::sim_tick_t tick{};
  ASSERT_TRUE(client.next_tick(tick));
  client.acknowledge(tick);
  EXPECT_TRUE(client.next_tick(tick));
  EXPECT_EQ(tick.step, 2);
  client.acknowledge(tick);
  EXPECT_FALSE(client.next_tick(tick));
  thread.join();
  EXPECT_EQ(client.end(), LockstepClient::End::last_tick);
}

TEST(LockstepClient, RequestsAgainUntilItIsAnswered) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  std::thread thread([&] {
    const auto first = simulator.await_request();
    const auto second = simulator.await_request();
    EXPECT_EQ(first.id, second.id);
    simulator.reply(second, true, "");
  });
  EXPECT_NO_THROW(client.join(1, 60s));
  thread.join();
}

TEST(LockstepClient, SaysWhyTheSimulatorRefuses) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  std::thread thread([&] { simulator.reply(simulator.await_request(), false, "the period must be > 0"); });
  try {
    client.join(-1, 60s);
    ADD_FAILURE();
  } catch (const BusError& error) {
    EXPECT_STREQ(error.what(), "the simulator rejects 'pilot': the period must be > 0");
  }
  thread.join();
}

TEST(LockstepClient, SaysThatItWasStoppedWhileItWaited) {
  LockstepClient client(own_url(1), "pilot");
  client.stop();
  try {
    client.join(1, 60s);
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
  join(simulator, client);
  simulator.publish("auv1.note", bytes_of("one"));
  simulator.publish("auv1.note", bytes_of("two"));
  simulator.tick(1, {"pilot"});
  shoal::sim_tick_t tick{};
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
  join(simulator, client);
  simulator.tick(1, {"pilot"});
  shoal::sim_tick_t tick{};
  ASSERT_TRUE(client.next_tick(tick));
  client.acknowledge(tick);
  EXPECT_EQ(simulator.await_ack().step, 1);
  simulator.repeat_tick();
  simulator.tick(2, {"other"});
  simulator.tick(3, {"pilot"});
  ASSERT_TRUE(client.next_tick(tick));
  EXPECT_EQ(tick.step, 3);
  EXPECT_EQ(simulator.await_ack().step, 1);
}

TEST(LockstepClient, InvalidPayloadsAreIgnored) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  join(simulator, client);
  simulator.bus().publish("sim.tick", bytes_of(""), sim::Time(0));
  simulator.bus().publish("sim.tick", bytes_of("garbage that is not a tick"), sim::Time(0));
  sim::Bytes cut = shoal::encode(shoal::sim_tick_t{});
  cut.pop_back();
  simulator.bus().publish("sim.tick", cut, sim::Time(0));
  simulator.bus().publish("sim.control.reply", cut, sim::Time(0));
  simulator.tick(5, {"pilot"});
  shoal::sim_tick_t tick{};
  ASSERT_TRUE(client.next_tick(tick));
  EXPECT_EQ(tick.step, 5);
}

TEST(LockstepClient, RepeatsItsLastAnswerWithItsRequestToLeave) {
  FakeSimulator simulator;
  LockstepClient client(own_url(1), "pilot");
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(4, {"pilot"});
    // The answer with the first request is lost, and comes with the second one.
    EXPECT_EQ(simulator.await_ack().step, 4);
    EXPECT_EQ(simulator.await_request().command, "leave");
    EXPECT_EQ(simulator.await_ack().step, 4);
    const auto request = simulator.await_request();
    EXPECT_EQ(request.command, "leave");
    simulator.reply(request, true, "");
  });
  client.join(0.1, 60s);
  shoal::sim_tick_t tick{};
  ASSERT_TRUE(client.next_tick(tick));
  client.leave();
  thread.join();
}

TEST(LockstepClient, EndsWhenStoppedAndAfterSilence) {
  LockstepClient client(own_url(1), "pilot");
  shoal::sim_tick_t tick{};
  client.set_silence_limit(20ms);
  EXPECT_FALSE(client.next_tick(tick));
  EXPECT_EQ(client.end(), LockstepClient::End::silence);
  client.set_silence_limit(0ms);
  std::thread thread([&] { client.stop(); });
  EXPECT_FALSE(client.next_tick(tick));
  EXPECT_EQ(client.end(), LockstepClient::End::stopped);
  thread.join();
}

/// A client that writes down what it handles.
struct Listening {
  explicit Listening(const std::vector<std::string>& channels) {
    for (const std::string& channel : channels)
      client.subscribe(channel, [this](std::span<const std::byte> payload) {
        seen.push_back(text_of({payload.begin(), payload.end()}));
      });
    join(simulator, client);
  }
  FakeSimulator simulator;
  LockstepClient client{own_url(1), "pilot"};
  std::vector<std::string> seen;
  shoal::sim_tick_t tick{};
};

TEST(LockstepClient, EndsSoonAfterALastTickWhoseMessagesNeverCome) {
  Listening test({"a"});
  test.client.set_silence_limit(10min);
  test.simulator.name("a", bytes_of("lost"));
  test.simulator.tick(1, {"pilot"}, true);  // and the simulator ends: no one answers the requests
  EXPECT_FALSE(test.client.next_tick(test.tick));
  EXPECT_EQ(test.client.end(), LockstepClient::End::silence);
  EXPECT_TRUE(test.seen.empty());
}

TEST(LockstepClient, HandlesMessagesInTheOrderOfTheTickAndOnce) {
  Listening test({"a", "b"});
  for (const char* text : {"1", "3"}) test.simulator.name("a", bytes_of(text));
  test.simulator.name("b", bytes_of("2"));
  for (const char* text : {"3", "1", "1"}) test.simulator.bus().publish("a", bytes_of(text), sim::Time(0));
  test.simulator.bus().publish("b", bytes_of("2"), sim::Time(0));
  test.simulator.bus().publish("b", bytes_of("2"), sim::Time(0));
  test.simulator.tick(1, {"pilot"});
  ASSERT_TRUE(test.client.next_tick(test.tick));
  EXPECT_EQ(test.seen, (std::vector<std::string>{"1", "3", "2"}));
  EXPECT_EQ(test.client.counts().repeated, 2u);
}

TEST(LockstepClient, WhatWasHandledBeforeATickNamedItIsNotHandledAgain) {
  Listening test({"a"});
  test.simulator.bus().publish("a", bytes_of("1"), sim::Time(0));
  for (int step = 1; step <= 6; ++step) {
    // Named late, and later another that is equal.
    if (step == 5 || step == 6) test.simulator.name("a", bytes_of("1"));
    if (step == 5 || step == 6) test.simulator.bus().publish("a", bytes_of("1"), sim::Time(0));
    test.simulator.tick(step, {"pilot"});
    ASSERT_TRUE(test.client.next_tick(test.tick));
    test.client.acknowledge(test.tick);
    EXPECT_EQ(test.seen.size(), step < 3 ? 0u : step < 6 ? 1u : 2u) << step;
  }
  EXPECT_EQ(test.client.counts().unnamed, 1u);
}

TEST(LockstepClient, RequestsWhatIsMissingUntilItHasAll) {
  Listening test({"a"});
  test.simulator.publish("a", bytes_of("1"));
  test.simulator.name("a", bytes_of("2"));
  test.simulator.name("a", bytes_of("3"));
  std::thread thread([&] {
    test.simulator.tick(1, {"pilot"});
    auto question = test.simulator.await_question();
    EXPECT_EQ(question.first, 1);
    EXPECT_EQ(question.of_client, 0);
    EXPECT_EQ(question.session, test.simulator.session("pilot"));
    question = test.simulator.await_question();  // again
    shoal::sim_resent_t bundle{};
    bundle.client = "pilot";
    bundle.session = question.session;
    bundle.sequence = question.sequence;
    for (const char text : {'2', '3'}) {
      bundle.first = text - '1';
      bundle.count = 1;
      bundle.message = {{"a", 1, {static_cast<std::uint8_t>(text)}}};
      test.simulator.send("sim.resent", bundle);
    }
  });
  ASSERT_TRUE(test.client.next_tick(test.tick));
  thread.join();
  EXPECT_EQ(test.seen, (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_EQ(test.client.counts().requested, 2u);
}

TEST(LockstepClient, NamesWhatItPublishedAndSendsItAgain) {
  Listening test({"a"});
  test.client.publish("early", bytes_of("e"));  // waits for the tick
  test.simulator.tick(1, {"pilot"});
  ASSERT_TRUE(test.client.next_tick(test.tick));
  test.client.publish("auv1.cmd", bytes_of("command"));
  test.client.acknowledge(test.tick);
  const shoal::sim_ack_t ack = test.simulator.await_ack();
  EXPECT_EQ(ack.channel, (std::vector<std::string>{"early", "auv1.cmd"}));
  EXPECT_EQ(ack.crc[1], sim::crc32(bytes_of("command")));
  EXPECT_EQ(ack.sequence, 1);
  shoal::sim_resend_t question{};
  question.client = "pilot";
  question.session = ack.session;
  question.sequence = 1;
  question.of_client = 1;
  question.first = 1;
  std::thread thread([&] {
    test.simulator.send("sim.resend", question);
    const shoal::sim_resent_t bundle = test.simulator.await_bundle();
    EXPECT_EQ(bundle.first, 1);
    ASSERT_EQ(bundle.message.size(), 1u);
    EXPECT_EQ(bundle.message[0].channel, "auv1.cmd");
    EXPECT_EQ(bundle.message[0].data.size(), 7u);
    test.simulator.tick(2, {"pilot"});
  });
  ASSERT_TRUE(test.client.next_tick(test.tick));
  thread.join();
  test.client.acknowledge(test.tick);
  EXPECT_EQ(test.simulator.await_ack().count, 0);
}

TEST(LockstepClient, ReportsTheSimulatorOfChannelsItSubscribesToLater) {
  Listening test({"a"});
  test.simulator.tick(1, {"pilot"});
  ASSERT_TRUE(test.client.next_tick(test.tick));
  test.client.subscribe("b", [](std::span<const std::byte>) {});
  std::thread thread([&] {
    test.simulator.reply(test.simulator.await_request(), true, "");
    EXPECT_EQ(test.simulator.receives("pilot"), (std::vector<std::string>{"a", "b"}));
  });
  test.client.acknowledge(test.tick);
  thread.join();
  EXPECT_EQ(test.simulator.await_ack().step, 1);
}

TEST(LockstepClient, EndsWhenTheWorldGoesBackUnlessItGoesWithIt) {
  Listening test({"a"});
  test.simulator.tick(5, {"pilot"});
  ASSERT_TRUE(test.client.next_tick(test.tick));
  test.client.acknowledge(test.tick);
  int rewound = 0;
  test.client.on_rewind([&](const shoal::sim_tick_t& tick) { rewound = static_cast<int>(tick.step); });
  test.simulator.tick(2, {"pilot"}, false, 1);
  ASSERT_TRUE(test.client.next_tick(test.tick));
  EXPECT_EQ(rewound, 2);
  EXPECT_EQ(test.client.branch(), 1);
  test.client.acknowledge(test.tick);
  test.client.on_rewind({});
  test.simulator.tick(1, {"pilot"}, false, 2);
  EXPECT_FALSE(test.client.next_tick(test.tick));
  EXPECT_EQ(test.client.end(), LockstepClient::End::rewound);
  // It joins again, and continues with the tick that reported it.
  std::thread thread([&] {
    test.simulator.reply(test.simulator.await_request(), true, "");
    test.simulator.repeat_tick();
  });
  test.client.join(0.1, 60s);
  ASSERT_TRUE(test.client.next_tick(test.tick));
  thread.join();
  EXPECT_EQ(test.tick.branch, 2);
}

TEST(LockstepClient, SaysThatTheWorldWentOnWithoutIt) {
  Listening test({"a"});
  // The simulator answers the join once more.
  shoal::sim_control_reply_t reply{};
  reply.client = "pilot";
  reply.ok = 0;
  reply.text = "too late; join again";
  reply.id = test.simulator.join_id("pilot");
  reply.session = test.simulator.session("pilot");
  test.simulator.send("sim.control.reply", reply);
  EXPECT_FALSE(test.client.next_tick(test.tick));
  EXPECT_EQ(test.client.end(), LockstepClient::End::dropped);
  EXPECT_EQ(test.client.reason(), "too late; join again");
}

}  // namespace
}  // namespace bridges
