// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/lockstep_service.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "bridges/lockstep_client/resend.hpp"
#include "sim/world/world_state.hpp"
#include "tests/bridges/lockstep/lockstep_fixture.hpp"

namespace {

using lcm_test::bytes_of;
using testing::HasSubstr;
using Service = lcm_test::LockstepWorld;

TEST(LockstepService, WaitsForTheClientsThatAreDueAndNamesTheMissing) {
  Service s("{timeout_s: 0.02}");
  ASSERT_TRUE(s.join("pilot").ok);
  try {
    s.synchronize();
    FAIL();
  } catch (const bridges::LockstepTimeout& error) {
    EXPECT_THAT(error.what(), HasSubstr("no acknowledgement from 'pilot' for step 0 within 0.02 s"));
  }
  ASSERT_EQ(s.ticks.last().count, 1);
  s.acknowledge(0, "pilot");
  EXPECT_EQ(s.synchronize(), bridges::LockstepOutcome::done);
}

TEST(LockstepService, AClientThatHasAnsweredDoesNotMakeTheWorldLookEveryMillisecondForTheOthers) {
  const auto long_naps = [] {
    Service s;
    EXPECT_TRUE(s.join("fast", "{session: 1, timeout_s: 60}").ok);
    EXPECT_TRUE(s.join("slow", "{session: 2, timeout_s: 60}").ok);
    std::vector<std::chrono::milliseconds> naps;
    s.lockstep.synchronize(
        [&](std::chrono::milliseconds nap) {
          naps.push_back(nap);
          if (naps.size() == 1) s.acknowledge(0, "fast", 1, 1);
          const auto end = std::chrono::steady_clock::now() + 2 * bridges::resend_grace;
          while (std::chrono::steady_clock::now() < end) std::this_thread::yield();
          if (naps.size() == 6) s.acknowledge(0, "slow", 2, 1);
        },
        [] { return true; });
    EXPECT_EQ(naps.size(), 6u);
    return std::count_if(naps.begin() + 1, naps.end(), [](auto nap) { return nap > bridges::resend_grace; });
  };
  // Its tick is sent again 20 ms after the first; only the look before that is a short one.  Again when the machine
  // stood.
  EXPECT_TRUE(lcm_test::await([&] { return long_naps() >= 3; }));
}

TEST(LockstepService, ATickNamesWhatTheClientMustHaveAndSendsItAgain) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, receives: [x, y], timeout_s: 60}").ok);
  s.gate.publish("y", bytes_of("one"), sim::Time(0));
  s.gate.publish("x", bytes_of("two"), sim::Time(0));
  int requested = 0;
  s.synchronize([&] {
    if (++requested == 1) {
      const auto tick = s.ticks.last();
      ASSERT_EQ(tick.client.size(), 1u);
      const shoal::sim_due_t& due = tick.client[0];
      EXPECT_EQ(due.name, "pilot");
      EXPECT_EQ(due.session, 5);
      EXPECT_EQ(due.sequence, 1);
      EXPECT_EQ(due.channel, (std::vector<std::int32_t>{1, 0}));
      EXPECT_EQ(due.crc[1], sim::crc32(bytes_of("two")));
      shoal::sim_resend_t resend_request{};
      resend_request.client = "pilot";
      resend_request.session = 5;
      resend_request.sequence = 1;
      resend_request.first = 1;
      s.test.send("sim.resend", resend_request);
    } else if (requested == 2) {
      const auto bundle = s.bundles.last();
      EXPECT_EQ(bundle.first, 1);
      ASSERT_EQ(bundle.message.size(), 1u);
      EXPECT_EQ(bundle.message[0].channel, "x");
      EXPECT_EQ(std::string(bundle.message[0].data.begin(), bundle.message[0].data.end()), "two");
      s.acknowledge(0, "pilot", 5, 1);
    }
  });
  EXPECT_EQ(s.lockstep.summaries().at(0).messages_resent, 1);
  EXPECT_EQ(s.lockstep.bad_messages(), 0);
}

TEST(LockstepService, BundlesThatAreTooLargeComeInParts) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, receives: [x], timeout_s: 60}").ok);
  for (int i = 0; i < 5; ++i) s.gate.publish("x", sim::Bytes(25'000, static_cast<std::byte>(i)), sim::Time(0));
  s.gate.publish("x", sim::Bytes(200'000), sim::Time(0));  // more than a datagram holds
  int requested = 0;
  s.synchronize([&] {
    if (++requested == 1) {
      shoal::sim_resend_t resend_request{};
      resend_request.client = "pilot";
      resend_request.session = 5;
      resend_request.sequence = 1;
      s.test.send("sim.resend", resend_request);
    } else if (requested == 2) {
      std::vector<std::int32_t> first;
      for (const auto& bundle : s.bundles.take_all()) first.push_back(bundle.first);
      EXPECT_EQ(first, (std::vector<std::int32_t>{0, 2, 4, 5}));  // two of 25 kB fit in 60 kB
      s.acknowledge(0, "pilot", 5, 1);
    }
  });
}

TEST(LockstepService, RequestsWhatAClientPublishedUntilItIsThere) {
  Service s;
  const auto reader = s.gate.open_mailbox("cmd");
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}").ok);
  int waited = 0;
  bool sent = false;
  s.synchronize([&] {
    if (++waited == 1) {
      s.test.bus.publish("cmd", bytes_of("2"), sim::Time(0));
      s.acknowledge(0, "pilot", 5, 1, {{"cmd", "1"}, {"cmd", "2"}});
      return;
    }
    for (const auto& resend_request : s.resend_requests.take_all()) {
      EXPECT_EQ(resend_request.of_client, 1);
      EXPECT_EQ(resend_request.first, 0);
      s.resend("pilot", '1');
      sent = true;
    }
  });
  EXPECT_TRUE(sent);
  EXPECT_EQ(s.admitted(), "12");
}

TEST(LockstepService, WhatOneClientPublishesIsOnTheListOfAnotherInOrder) {
  Service s;
  ASSERT_TRUE(s.join("b", "{session: 5, receives: [note]}").ok);
  ASSERT_TRUE(s.join("a", "{session: 6}").ok);
  s.synchronize([&] {
    s.acknowledge(0, "a", 6, 1, {{"note", "1"}, {"other", "x"}});  // no one in the world reads `note`
    s.test.bus.publish("note", bytes_of("1"), sim::Time(0));
    s.acknowledge(0, "b", 5, 1);
    for (const auto& resend_request : s.resend_requests.take_all()) {
      EXPECT_EQ(resend_request.client, "a");  // it came before anyone listened
      s.test.bus.publish("note", bytes_of("1"), sim::Time(0));
    }
  });
  s.gate.admit();
  s.test.world.step();
  s.synchronize([&] {
    const auto tick = s.ticks.last();
    ASSERT_EQ(tick.client.size(), 2u);
    EXPECT_EQ(tick.client[1].crc, (std::vector<std::int64_t>{sim::crc32(bytes_of("1"))}));
    s.acknowledge(1, "a", 6, 2);
    s.acknowledge(1, "b", 5, 2);
  });
}

TEST(LockstepService, WrongAcknowledgementsAreRefusedAndCounted) {
  Service s("{timeout_s: 0.02}");
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  s.acknowledge(1'000'000, "pilot", 5, 1);
  s.acknowledge(0, "pilot", 6, 1);
  s.acknowledge(0, "stranger");
  EXPECT_THROW(s.synchronize(), bridges::LockstepTimeout);
  EXPECT_EQ(s.lockstep.bad_messages(), 3);
}

TEST(LockstepService, ASecondClientOfANameIsRefusedWhenTheFirstAnswers) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}").ok);
  EXPECT_TRUE(s.is_undecided("join", "pilot", "{session: 6}"));
  s.synchronize([&] { s.acknowledge(0, "pilot", 5, 1); });
  EXPECT_THAT(s.join("pilot", "{session: 6}").text, HasSubstr("another client named 'pilot' takes part"));
}

TEST(LockstepService, ASecondClientIsRefusedAlsoWhileTheFirstIsAtWork) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}").ok);
  s.synchronize([&] {
    EXPECT_TRUE(s.is_undecided("join", "pilot", "{session: 6}"));
    s.acknowledge(0, "pilot", 5, 1);
  });
  s.test.world.step();
  s.synchronize([&] {
    EXPECT_THAT(s.join("pilot", "{session: 6}").text, HasSubstr("another client named 'pilot' takes part"));
    s.acknowledge(1, "pilot", 5, 2);
  });
}

TEST(LockstepService, ASecondClientTakesThePlaceOfAFirstThatIsGone) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, on_timeout: wait, timeout_s: 60}").ok);
  s.lockstep.client_exited("pilot");
  EXPECT_TRUE(s.lockstep.has("pilot"));  // that is what was agreed
  ASSERT_TRUE(s.join("pilot", "{session: 6, timeout_s: 60}").ok);
  s.synchronize([&] { s.acknowledge(0, "pilot", 6, 1); });
}

TEST(LockstepService, ALeaveWaitsForTheAcknowledgementBeforeIt) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}").ok);
  bool left = false;
  s.synchronize([&] {
    if (!left) {
      EXPECT_TRUE(s.is_undecided("leave", "pilot", "{session: 5}"));
    }
    s.acknowledge(0, "pilot", 5, 1);
    left = true;
  });
  EXPECT_TRUE(s.request_reply("leave", 0, "{session: 5}").ok);
  EXPECT_FALSE(s.lockstep.has("pilot"));
  EXPECT_EQ(s.lockstep.summaries().at(0).ended, "left");
}

TEST(LockstepService, ALeaveForAReasonIsListedWithIt) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}").ok);
  s.synchronize([&] { s.acknowledge(0, "pilot", 5, 1); });
  EXPECT_TRUE(s.request_reply("leave", 0, "{session: 5, acknowledged: 1, reason: \"KeyError: 'map'\"}").ok);
  EXPECT_EQ(s.lockstep.summaries().at(0).ended, "left: KeyError: 'map'");
  EXPECT_TRUE(s.lockstep.has_left("pilot"));
  EXPECT_EQ(s.lockstep.reason_to_leave("pilot"), "KeyError: 'map'");
  ASSERT_TRUE(s.join("guest", "{session: 6}").ok);
  EXPECT_EQ(s.lockstep.reason_to_leave("guest"), "");
  ASSERT_TRUE(s.request_reply("leave", 0, "", "guest").ok);
  EXPECT_EQ(s.lockstep.reason_to_leave("guest"), "");
}

TEST(LockstepService, ALeaveIsGrantedThoughTheNextTickHasGoneOut) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}").ok);
  s.synchronize([&] { s.acknowledge(0, "pilot", 5, 1); });
  s.test.world.step();
  s.synchronize([&] {
    EXPECT_TRUE(s.is_undecided("leave", "pilot", "{session: 5, acknowledged: 2}"));  // its answer is on its way
    EXPECT_THAT(s.request_reply("leave", 0, "{session: 5, acknowledged: 3}").text,
                HasSubstr("after tick 3, which was not"));
    EXPECT_TRUE(s.request_reply("leave", 0, "{session: 5, acknowledged: 1}").ok);
  });
  EXPECT_FALSE(s.lockstep.has("pilot"));
}

TEST(LockstepService, JoiningAgainLeavesTheOpenTickOpen) {
  Service s;
  const auto reader = s.gate.open_mailbox("cmd");
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}").ok);
  int waited = 0;
  s.synchronize([&] {
    ++waited;
    if (waited == 1) {
      ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}", 0.02).ok);
    } else if (waited == 3) {
      s.test.bus.publish("cmd", bytes_of("1"), sim::Time(0));
      s.acknowledge(0, "pilot", 5, 1, {{"cmd", "1"}});
    }
  });
  EXPECT_EQ(waited, 3);
  EXPECT_EQ(s.admitted(), "1");
  s.test.world.step();
  s.synchronize([] { ADD_FAILURE() << "its period is two steps now"; });
  s.test.world.step();
  s.synchronize([&] { s.acknowledge(2, "pilot", 5, 2); });
  EXPECT_EQ(s.lockstep.bad_messages(), 0);
}

TEST(LockstepService, WithoutALateClientTheWorldContinuesAndReportsItSo) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, on_timeout: continue, timeout_s: 0.001}").ok);
  s.synchronize();
  EXPECT_FALSE(s.lockstep.has("pilot"));
  s.acknowledge(0, "pilot", 5, 1);
  s.replies.take_all();
  s.synchronize();
  const auto reply = s.replies.last();
  EXPECT_FALSE(reply.ok);
  EXPECT_THAT(reply.text, HasSubstr("the world continued without it: join again"));
}

TEST(LockstepService, ALateClientPausesTheWorldUntilItAnswers) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, on_timeout: pause, timeout_s: 0.001}").ok);
  s.synchronize([&] {
    if (s.control.paused) s.acknowledge(0, "pilot", 5, 1);
  });
  EXPECT_FALSE(s.control.paused);
  EXPECT_TRUE(s.lockstep.has("pilot"));
  s.test.world.step();
  s.synchronize([&] {
    if (s.control.paused) s.control.paused = false;  // someone resumes
  });
  EXPECT_FALSE(s.lockstep.has("pilot"));
}

TEST(LockstepService, AStepWhileALateClientPausesTheWorldDoesNotDropIt) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, on_timeout: pause, timeout_s: 0.001}").ok);
  int waited = 0;
  s.synchronize([&] {
    if (!s.control.paused) return;
    if (++waited == 1) s.control.add_steps(2);
    if (waited == 3) s.acknowledge(0, "pilot", 5, 1);
  });
  EXPECT_EQ(waited, 3);
  EXPECT_TRUE(s.lockstep.has("pilot"));
  EXPECT_TRUE(s.control.paused);
  EXPECT_EQ(s.control.single_steps, 2);
}

TEST(LockstepService, TimeOutsRestWhileSomeOneHasPausedTheWorld) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, on_timeout: continue, timeout_s: 0.05}").ok);
  const auto begin = std::chrono::steady_clock::now();
  bool answered = false;
  s.synchronize([&] {
    s.control.set_paused(true);
    if (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(200)) return;  // four time-outs
    s.acknowledge(0, "pilot", 5, 1);
    answered = true;
  });
  EXPECT_TRUE(answered);
  EXPECT_TRUE(s.lockstep.has("pilot"));
  s.control.set_paused(false);
  s.test.world.step();
  s.synchronize();
  EXPECT_FALSE(s.lockstep.has("pilot"));
}

TEST(LockstepService, AClientCannotMakeAWorldWaitLongerThanItsFileSays) {
  Service s("{on_timeout: continue, timeout_s: 0.02}");
  ASSERT_TRUE(s.join("stranger", "{session: 5, on_timeout: wait, timeout_s: 1000}").ok);
  bool named = false;
  s.synchronize([&] {
    if (std::exchange(named, true)) return;
    EXPECT_THAT(s.service.waits_for(), testing::MatchesRegex("waits [0-9.]+ s for 'stranger'"));
  });
  EXPECT_TRUE(named);
  EXPECT_FALSE(s.lockstep.has("stranger"));
  EXPECT_EQ(s.service.waits_for(), "");
}

TEST(LockstepService, AJoinThatComesLateDoesNotTakeInAgainWhoHasLeft) {
  Service s;
  ASSERT_TRUE(s.join("guest", "{session: 77}").ok);
  ASSERT_TRUE(s.request_reply("leave", 0, "", "guest").ok);
  EXPECT_THAT(s.join("guest", "{session: 77}").text, HasSubstr("the session 77 of client 'guest' is over (left)"));
  EXPECT_FALSE(s.lockstep.has("guest"));
  EXPECT_TRUE(s.join("guest", "{session: 78}").ok);
  EXPECT_FALSE(s.join("guest", "{session: 77}").ok);
  EXPECT_TRUE(s.lockstep.has("guest"));
}

TEST(LockstepService, AReplyNamesTheSessionThatItIsFor) {
  Service s;
  EXPECT_EQ(s.join("pilot", "{session: 5, timeout_s: 60}").session, 5);
  s.synchronize([&] {
    EXPECT_TRUE(s.is_undecided("join", "pilot", "{session: 6}"));
    s.acknowledge(0, "pilot", 5, 1);
  });
  const auto refused = s.join("pilot", "{session: 6}");
  EXPECT_FALSE(refused.ok);
  EXPECT_EQ(refused.session, 6);
  EXPECT_EQ(s.request_reply("leave", 0, "{session: 5}", "pilot").session, 5);
  EXPECT_EQ(s.request_reply("alive", 0, "", "pilot").session, 0);
}

TEST(LockstepService, WhileTheWorldIsPausedASecondClientIsRefusedWhenTheFirstLives) {
  Service s;
  for (const bool asked_before : {false, true}) {
    const std::string name = asked_before ? "asked" : "not asked";
    ASSERT_TRUE(s.join(name, "{session: 5, timeout_s: 60}", 100).ok);
    if (asked_before) s.synchronize([&] { s.acknowledge(0, name, 5, 1); });
    s.control.paused = true;
    s.ticks.take_all();
    EXPECT_TRUE(s.is_undecided("join", name, "{session: 6}"));
    const auto tick = s.ticks.last();
    ASSERT_EQ(tick.client.size(), 1u);
    EXPECT_EQ(tick.client[0].session, 5);
    EXPECT_EQ(tick.client[0].sequence, asked_before ? 1 : 0);
    s.acknowledge(tick.step, name, 5, tick.client[0].sequence);
    EXPECT_THAT(s.join(name, "{session: 6}").text, HasSubstr("takes part and is responding"));
    EXPECT_EQ(s.lockstep.bad_messages(), 0);
    s.control.paused = false;
    ASSERT_TRUE(s.request_reply("leave", 0, "", name).ok);
  }
}

TEST(LockstepService, WhileTheWorldIsPausedASecondClientTakesThePlaceOfAFirstThatIsSilent) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}").ok);
  s.synchronize([&] { s.acknowledge(0, "pilot", 5, 1); });
  s.acknowledge(0, "pilot", 5, 1);  // sent before it crashed, and read only now
  s.control.paused = true;
  const auto begin = std::chrono::steady_clock::now();
  while (s.is_undecided("join", "pilot", "{session: 6}"))
    ASSERT_LT(std::chrono::steady_clock::now() - begin, std::chrono::minutes(1));
  EXPECT_GT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
  s.control.paused = false;
  s.test.world.step();
  s.synchronize([&] { s.acknowledge(1, "pilot", 6, 1); });
  EXPECT_EQ(s.lockstep.bad_messages(), 0);
}

TEST(LockstepService, AnOperatorsMessageThatEqualsOneOfAClientIsAdmitted) {
  Service s;
  const auto reader = s.gate.open_mailbox("cmd");
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}").ok);
  s.synchronize([&] {
    s.test.bus.publish("cmd", bytes_of("stop"), sim::Time(0));
    s.acknowledge(0, "pilot", 5, 1, {{"cmd", "stop"}});
  });
  EXPECT_EQ(s.admitted(), "stop");
  // The network may have repeated the first; the second is someone else's.
  for (int i = 0; i < 2; ++i) s.test.bus.publish("cmd", bytes_of("stop"), sim::Time(0));
  EXPECT_EQ(s.admitted(), "stop");
  EXPECT_EQ(s.lockstep.summaries().at(0).messages_repeated, 1);
  // After a moment it can only be someone else's, also when the world does not step meanwhile.
  s.test.world.step();
  s.synchronize([&] {
    s.test.bus.publish("cmd", bytes_of("stop"), sim::Time(0));
    s.acknowledge(1, "pilot", 5, 2, {{"cmd", "stop"}});
  });
  EXPECT_EQ(s.admitted(), "stop");
  const auto begin = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(400)) s.service.handle_requests();
  s.test.bus.publish("cmd", bytes_of("stop"), sim::Time(0));
  EXPECT_EQ(s.admitted(), "stop");
  EXPECT_EQ(s.lockstep.summaries().at(0).messages_repeated, 1);
}

TEST(LockstepService, AFloodOfJoinsLeavesTheClientsThatAreThere) {
  Service s;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(s.join("client" + std::to_string(i), "", 100).ok);
  EXPECT_THAT(s.join("one more").text, HasSubstr("1000 clients have joined"));
  EXPECT_TRUE(s.lockstep.has("client999"));
}

TEST(LockstepService, KeepsThePauseThatSomeOneAskedForWhileAClientWasLate) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, on_timeout: pause, timeout_s: 0.001}").ok);
  s.synchronize([&] {
    if (!s.control.paused) return;
    s.control.set_paused(true);
    s.acknowledge(0, "pilot", 5, 1);
  });
  EXPECT_TRUE(s.control.paused);
}

TEST(LockstepService, KeepsThePauseOfARewindWhileAClientWasLate) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, on_timeout: pause, timeout_s: 0.001}").ok);
  int sequence = 0;
  s.synchronize([&] {
    if (!s.control.paused) return;
    if (sequence == 0) s.lockstep.set_branch(1);
    s.acknowledge(0, "pilot", 5, ++sequence);  // that of the branch that was left, then the new one
  });
  EXPECT_EQ(sequence, 2);
  EXPECT_TRUE(s.control.paused);
}

TEST(LockstepService, WhatWasPublishedForATickBeforeARewindIsDroppedWithoutComplaint) {
  Service s;
  const auto reader = s.gate.open_mailbox("cmd");
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}", 0.02).ok);
  s.synchronize([&] { s.acknowledge(0, "pilot", 5, 1); });
  s.test.world.step();
  const sim::Bytes before = s.test.world.state().snapshot();  // at a step without a tick
  s.test.world.step();
  EXPECT_THROW(s.lockstep.synchronize([](std::chrono::milliseconds) {},
                                      [&, calls = 0]() mutable {
                                        if (++calls == 3) throw std::logic_error("a rewind in the middle of it");
                                        return true;
                                      }),
               std::logic_error);
  s.test.world.state().restore(before);
  s.lockstep.set_branch(1);
  s.lockstep.set_branch(2);  // while it thinks
  s.test.bus.publish("cmd", bytes_of("old"), sim::Time(0));
  s.ticks.take_all();
  int ticks = 0;
  s.synchronize([&] {
    for (const auto& tick : s.ticks.take_all()) {
      EXPECT_EQ(tick.step, 2);
      EXPECT_EQ(tick.branch, 0);  // it is the tick of then, until it is answered
      EXPECT_EQ(tick.client.at(0).sequence, 2);
      // The first answer is lost.
      if (++ticks == 2) s.acknowledge(2, "pilot", 5, 2, {{"cmd", "old"}, {"cmd", "late"}});
    }
  });
  EXPECT_EQ(ticks, 2);
  s.test.bus.publish("cmd", bytes_of("late"), sim::Time(0));
  s.test.bus.publish("cmd", bytes_of("stranger's"), sim::Time(0));
  EXPECT_EQ(s.admitted(), "stranger's");
  s.test.world.step();
  s.synchronize([&] {
    const auto tick = s.ticks.last();
    EXPECT_EQ(tick.step, 2);
    EXPECT_EQ(tick.branch, 2);
    EXPECT_EQ(tick.client.at(0).sequence, 3);
    s.acknowledge(2, "pilot", 5, 3);
  });
  EXPECT_EQ(s.lockstep.bad_messages(), 0);
}

TEST(LockstepService, AClientThatMustHaveTooMuchUntilItsNextTickIsDroppedAndTold) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, receives: [image], timeout_s: 60}", 1e6).ok);
  s.synchronize([&] { s.acknowledge(0, "pilot", 5, 1); });
  const sim::Bytes image(50'000'000);
  for (int i = 0; i < 6; ++i) s.gate.publish("image", image, sim::Time(0));
  s.test.world.step();
  s.synchronize();
  EXPECT_FALSE(s.lockstep.has("pilot"));
  EXPECT_FALSE(s.replies.last().ok);
  EXPECT_THAT(s.lockstep.summaries().at(0).ended, HasSubstr("more than 256 MB of messages until its next tick"));
}

TEST(LockstepService, AnAcknowledgementMayNameTenThousandMessages) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, timeout_s: 60}").ok);
  std::vector<std::pair<std::string, std::string>> named(10'001, {"nobody reads this", "x"});
  bool refused = false;
  s.synchronize([&] {
    s.acknowledge(0, "pilot", 5, 1, named);
    if (refused) return;
    refused = true;
    named.pop_back();
  });
  EXPECT_TRUE(refused);
  EXPECT_EQ(s.lockstep.bad_messages(), 1);
}

TEST(LockstepService, OnlyManyClientsOfThePastAreListed) {
  Service s;
  for (int i = 0; i < 2500; ++i) {
    const std::string name = "client" + std::to_string(i);
    ASSERT_TRUE(s.join(name, "", 100).ok);
    ASSERT_TRUE(s.request_reply("leave", 0, "", name).ok);
  }
  EXPECT_EQ(s.lockstep.summaries().size(), 2000u);
}

TEST(LockstepService, ReportsTheEndUntilAllKnow) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, receives: [x]}", 1).ok);
  s.gate.publish("x", bytes_of("last"), sim::Time(0));
  int waited = 0;
  s.lockstep.publish_end(
      [&](std::chrono::milliseconds) {
        if (++waited == 3) s.acknowledge(0, "pilot", 5, 1);
      },
      std::chrono::minutes(1));
  EXPECT_EQ(waited, 3);
  const auto tick = s.ticks.last();
  EXPECT_EQ(tick.last, 1);
  EXPECT_EQ(tick.client.at(0).count, 1);
}

TEST(LockstepService, GivesMoreTimeAtTheEndToAClientThatStillRequestsMessages) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5, receives: [x]}", 1).ok);
  s.gate.publish("x", bytes_of("last"), sim::Time(0));
  shoal::sim_resend_t question{};
  question.client = "pilot";
  question.session = 5;
  question.sequence = 1;
  constexpr std::chrono::milliseconds limit(500);
  const auto late = std::chrono::steady_clock::now() + 2 * limit;
  bool answered = false;
  s.lockstep.publish_end(
      [&](std::chrono::milliseconds) {
        s.test.send("sim.resend", question);
        if (std::chrono::steady_clock::now() < late || answered) return;
        s.acknowledge(0, "pilot", 5, 1);
        answered = true;
      },
      limit);
  EXPECT_TRUE(answered);
  EXPECT_EQ(s.bundles.last().message.at(0).channel, "x");
}

}  // namespace
