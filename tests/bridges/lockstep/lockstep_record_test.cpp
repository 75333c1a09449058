// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "bridges/lockstep/lockstep_service.hpp"
#include "tests/bridges/lockstep/lockstep_fixture.hpp"

// A run with a record admits all that its clients list, also on channels that nothing reads.

namespace {

using lcm_test::bytes_of;
using testing::ElementsAre;
using testing::IsEmpty;

/// A world whose bus is recorded.
struct Recorded : lcm_test::LockstepWorld {
  explicit Recorded(const std::string& terms = "{timeout_s: 60}") : LockstepWorld(terms, {}, true) {}
  void publish(const std::string& channel, const std::string& text) {
    test.bus.publish(channel, bytes_of(text), sim::Time(0));
  }
};

/// Answers of a client with session 5 that publishes `text` on `channel` in each tick; a request for what was published
/// before anyone listened is served.
void answer_tick(lcm_test::LockstepWorld& s, std::int64_t sequence, const std::string& channel,
                 const std::string& text) {
  bool answered = false;
  s.synchronize([&] {
    if (!answered) {
      s.test.bus.publish(channel, bytes_of(text), sim::Time(0));
      s.acknowledge(s.test.world.step_number(), "pilot", 5, sequence, {{channel, text}});
    }
    answered = true;
    if (!s.resend_requests.take_all().empty()) s.test.bus.publish(channel, bytes_of(text), sim::Time(0));
  });
}

TEST(LockstepRecord, HasWhatAClientListsOnAChannelThatNothingReads) {
  Recorded s;
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  answer_tick(s, 1, "note", "1");
  EXPECT_EQ(s.admitted(), "1");  // the first one was requested: no one listened yet
  s.test.world.step();
  answer_tick(s, 2, "note", "2");
  EXPECT_EQ(s.admitted(), "2");
  EXPECT_THAT(s.lockstep.not_recorded(), IsEmpty());
}

TEST(LockstepRecord, WithoutARecordTheWorldDoesNotWaitForThem) {
  lcm_test::LockstepWorld s;
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  answer_tick(s, 1, "note", "1");
  EXPECT_EQ(s.admitted(), "");
  EXPECT_TRUE(s.resend_requests.take_all().empty());
  EXPECT_THAT(s.lockstep.not_recorded(), IsEmpty());
}

TEST(LockstepRecord, TheRunContinuesWithoutWhatDoesNotArriveAndNamesIt) {
  Recorded s("{timeout_s: 0.02}");
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  const auto list_only = [&](std::int64_t sequence) {
    int answers = 0;
    return s.synchronize([&] {
      if (++answers == 1)
        s.acknowledge(s.test.world.step_number(), "pilot", 5, sequence, {{"note", "1"}, {"log", "2"}});
      if (answers == 2) s.publish("log", "2");
    });
  };
  EXPECT_EQ(list_only(1), bridges::LockstepOutcome::done);
  EXPECT_EQ(s.admitted(), "2");
  EXPECT_THAT(s.lockstep.not_recorded(), ElementsAre("1 message of client 'pilot' on 'note' (they did not arrive)"));
  // The world does not wait for that channel again.
  s.test.world.step();
  EXPECT_EQ(list_only(2), bridges::LockstepOutcome::done);
  EXPECT_THAT(s.lockstep.not_recorded(), ElementsAre("2 messages of client 'pilot' on 'note' (they did not arrive)"));
  EXPECT_EQ(s.lockstep.summaries().front().timeouts, 0);
}

TEST(LockstepRecord, AMessageThatTheWorldReadsIsStillNeeded) {
  Recorded s("{timeout_s: 0.02}");
  const auto reader = s.gate.open_mailbox("cmd");
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  EXPECT_THROW(s.synchronize([&] {
    s.acknowledge(0, "pilot", 5, 1, {{"note", "1"}, {"cmd", "2"}});
  }),
               bridges::LockstepTimeout);
}

TEST(LockstepRecord, WhatAClientListedBeforeItsProcessEndedIsNamed) {
  Recorded s;
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  int waited = 0;
  s.synchronize([&] {
    if (++waited == 1) s.acknowledge(0, "pilot", 5, 1, {{"note", "1"}});
    if (waited == 2) s.lockstep.client_exited("pilot");
  });
  EXPECT_THAT(s.lockstep.not_recorded(), ElementsAre("1 message of client 'pilot' on 'note' (they did not arrive)"));
}

TEST(LockstepRecord, ChannelsOfTheSimulatorAreNotRecordedForAClient) {
  Recorded s;
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  s.synchronize([&] { s.acknowledge(0, "pilot", 5, 1, {{"sim.control", "x"}}); });
  EXPECT_FALSE(s.gate.reads("sim.control"));
  EXPECT_THAT(s.lockstep.not_recorded(),
              ElementsAre("1 message of client 'pilot' on 'sim.control' (channels of the simulator)"));
}

TEST(LockstepRecord, AThousandChannelsAreOpenedAndTheOthersNamed) {
  Recorded s;
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  std::vector<std::pair<std::string, std::string>> published;
  for (int i = 0; i < 1001; ++i) published.emplace_back("note." + std::to_string(i), "1");
  int waited = 0;
  s.synchronize([&] {
    if (++waited == 1) s.acknowledge(0, "pilot", 5, 1, published);
    if (waited == 2)
      for (const auto& [channel, text] : published) s.publish(channel, text);
  });
  EXPECT_EQ(s.admitted().size(), 1000u);
  EXPECT_THAT(s.lockstep.not_recorded(),
              ElementsAre("1 message of client 'pilot' on 'note.1000' (more than 1000 channels)"));
}

TEST(LockstepRecord, DoesNotCountAsAReaderOfAChannel) {
  for (const bool is_recorded : {false, true}) {
    lcm_test::LockstepWorld s("{timeout_s: 60}", {}, is_recorded);
    const auto reader = s.gate.open_mailbox("cmd");
    ASSERT_TRUE(s.join("pilot", "{session: 5, receives: [x, y]}").ok);
    s.gate.publish("x", bytes_of("1"), sim::Time(0));
    bool answered = false;
    s.synchronize([&] {
      if (!answered) s.acknowledge(0, "pilot", 5, 1, {{"note", "1"}, {"cmd", "2"}, {"note", "3"}});
      answered = true;
      if (s.resend_requests.take_all().empty()) return;
      for (const auto& [channel, text] : {std::pair("note", "1"), std::pair("cmd", "2"), std::pair("note", "3")})
        s.test.bus.publish(channel, bytes_of(text), sim::Time(0));
    });
    const auto use = s.lockstep.channel_use().clients().at("pilot");
    EXPECT_EQ(use.at("note").published, 2);
    EXPECT_FALSE(use.at("note").is_read);
    EXPECT_TRUE(use.at("cmd").is_read);
    EXPECT_TRUE(use.at("x").is_subscribed && use.at("x").has_received);
    EXPECT_TRUE(use.at("y").is_subscribed && !use.at("y").has_received);
    s.lockstep.client_exited("pilot");
    EXPECT_EQ(s.lockstep.channel_use().clients().at("pilot").size(), 4u) << "those of former clients are kept";
  }
}

TEST(LockstepRecord, AClientThatListsNothingIsNamed) {
  Recorded s;
  ASSERT_TRUE(s.join("pilot").ok);
  s.synchronize([&] { s.acknowledge(0, "pilot"); });
  EXPECT_THAT(s.lockstep.not_recorded(),
              ElementsAre("messages of client 'pilot' on channels that nothing reads (its answers list nothing)"));
}

}  // namespace
