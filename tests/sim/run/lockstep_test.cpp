// SPDX-License-Identifier: BSD-3-Clause
#include "sim/run/lockstep.hpp"

#include <gmock/gmock.h>

#include "sim/config/diagnostics.hpp"
#include "tests/bytes_of.hpp"

namespace {

using Names = std::vector<std::string>;
using sim::Lockstep;
using testing::HasSubstr;

sim::LockstepTerms session(std::int64_t number, const Names& receives = {}) {
  sim::LockstepTerms terms;
  terms.session = number;
  terms.receives = receives;
  return terms;
}

using test_support::bytes_of;

Names missing(Lockstep& lockstep, std::int64_t step) {
  Names names;
  for (const sim::LockstepMember* member : lockstep.missing(step)) names.push_back(member->name);
  return names;
}

/// The reason, when it is refused.
std::string answer(Lockstep& lockstep, const sim::LockstepAck& ack, std::int64_t step,
                   Lockstep::Verdict expected = Lockstep::Verdict::accepted) {
  std::string why;
  EXPECT_EQ(lockstep.acknowledge(ack, step, why), expected) << why;
  return why;
}

TEST(Lockstep, RequestsEachClientInItsOwnPeriod) {
  Lockstep lockstep;
  lockstep.join("slow", {}, 10, 0);
  lockstep.join("fast", {}, 5, 0);
  EXPECT_EQ(missing(lockstep, 0), (Names{"fast", "slow"}));
  EXPECT_EQ(missing(lockstep, 5), (Names{"fast"}));
  EXPECT_EQ(missing(lockstep, 7), (Names{}));
  EXPECT_EQ(missing(lockstep, 10), (Names{"fast", "slow"}));
}

TEST(Lockstep, MissesOnlyThoseWhoHaveNotAnswered) {
  Lockstep lockstep;
  lockstep.join("a", {}, 1, 0);
  lockstep.join("b", session(7), 1, 0);
  lockstep.send_request(3);
  answer(lockstep, {"a", 3, 0, 0}, 3);
  EXPECT_EQ(missing(lockstep, 3), (Names{"b"}));
  answer(lockstep, {"b", 3, 7, 1}, 3);
  EXPECT_EQ(missing(lockstep, 3), (Names{}));
  EXPECT_EQ(missing(lockstep, 4), (Names{"a", "b"}));
}

TEST(Lockstep, RefusesWrongAnswersAndSaysWhy) {
  Lockstep lockstep;
  lockstep.join("a", session(7), 1, 0);
  lockstep.send_request(3);
  const auto refused = Lockstep::Verdict::refused;
  EXPECT_THAT(answer(lockstep, {"b", 3, 0, 0}, 3, refused),
              HasSubstr("'b' acknowledges a tick, but is not a lockstep client"));
  EXPECT_THAT(answer(lockstep, {"a", 4, 7, 1}, 3, refused), HasSubstr("step 4, which is in the future"));
  EXPECT_THAT(answer(lockstep, {"a", 3, 8, 1}, 3, refused), HasSubstr("in session 8, which is not the one"));
  EXPECT_THAT(answer(lockstep, {"a", 3, 7, 2}, 3, refused), HasSubstr("tick 2, which was not sent to it"));
  EXPECT_THAT(answer(lockstep, {"a", 2, 7, 1}, 3, refused), HasSubstr("step 2 for the tick of step 3"));
  EXPECT_EQ(missing(lockstep, 3), (Names{"a"}));
  answer(lockstep, {"a", 3, 7, 1}, 3);
  answer(lockstep, {"a", 3, 7, 1}, 3, Lockstep::Verdict::repeated);
  lockstep.send_request(4);
  answer(lockstep, {"a", 3, 7, 1}, 4, Lockstep::Verdict::repeated);  // late and twice
  EXPECT_EQ(missing(lockstep, 4), (Names{"a"}));
}

TEST(Lockstep, ListsWhatAClientMustHaveInTheOrderOfPublishing) {
  Lockstep lockstep;
  lockstep.join("a", session(7, {"x", "y"}), 2, 0);
  lockstep.join("b", session(8, {"x"}), 1, 0, 1);  // on another line
  lockstep.send_request(0);
  lockstep.post(0, "y", bytes_of("1"));
  lockstep.post(0, "x", bytes_of("2"));
  lockstep.post(0, "z", bytes_of("3"));
  lockstep.post(1, "y", bytes_of("4"));
  EXPECT_TRUE(lockstep.find("a")->list.empty());
  lockstep.send_request(1);
  EXPECT_TRUE(lockstep.find("a")->list.empty());  // not due
  lockstep.send_request(2);
  const auto& list = lockstep.find("a")->list;
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].channel, 1);
  EXPECT_EQ(list[1].channel, 0);
  EXPECT_EQ(*list[1].payload, bytes_of("2"));
  EXPECT_EQ(list[0].crc, 0x83dcefb7u);  // CRC-32 of "1"
  EXPECT_TRUE(lockstep.has_receiver(0, "y"));
  EXPECT_FALSE(lockstep.has_receiver(1, "y"));
}

TEST(Lockstep, JoiningTwiceMovesNoTick) {
  Lockstep lockstep;
  lockstep.join("a", {}, 10, 0);
  lockstep.join("a", {}, 10, 3);
  EXPECT_EQ(missing(lockstep, 10), (Names{"a"}));
  EXPECT_EQ(missing(lockstep, 13), (Names{}));
  lockstep.join("a", {}, 4, 20);
  EXPECT_EQ(missing(lockstep, 24), (Names{"a"}));
}

TEST(Lockstep, ChannelsKeepTheirPlaces) {
  Lockstep lockstep;
  lockstep.join("a", session(7, {"x"}), 1, 0);
  lockstep.join("a", session(7, {"x", "y"}), 1, 0);
  EXPECT_TRUE(lockstep.has_receiver(0, "y"));
  EXPECT_THROW(lockstep.join("a", session(7, {"y", "x"}), 1, 0), std::invalid_argument);
  EXPECT_THROW(lockstep.join("a", session(7, {"x"}), 1, 0), std::invalid_argument);
}

TEST(Lockstep, AClientThatLeftIsNotAwaited) {
  Lockstep lockstep;
  lockstep.join("a", session(7, {"x"}), 1, 0);
  EXPECT_TRUE(lockstep.leave("a"));
  EXPECT_FALSE(lockstep.leave("a"));
  lockstep.post(0, "x", bytes_of("1"));
  EXPECT_EQ(missing(lockstep, 1), (Names{}));
}

TEST(Lockstep, AfterGoingBackEverybodyIsAskedByItsPeriod) {
  Lockstep lockstep;
  lockstep.join("a", session(7, {"x"}), 10, 0);
  lockstep.join("late", session(8), 10, 55);
  lockstep.post(0, "x", bytes_of("1"));
  lockstep.send_request(60);
  answer(lockstep, {"a", 60, 7, 1}, 60);
  lockstep.rewound(20);
  EXPECT_EQ(missing(lockstep, 20), (Names{"a"}));
  EXPECT_EQ(missing(lockstep, 25), (Names{"late"}));
  lockstep.send_request(20);
  EXPECT_TRUE(lockstep.find("a")->list.empty());
  EXPECT_EQ(lockstep.find("a")->sequence, 2);
}

TEST(Lockstep, WhatIsPostedAgainIsOnTheListOfTheFirstTickAfterGoingBack) {
  Lockstep lockstep;
  lockstep.join("a", session(7, {"x"}), 10, 0);
  lockstep.join("late", session(8, {"x"}), 10, 55);  // due at 5, 15, 25 as well
  lockstep.post(0, "x", bytes_of("of the branch that is left"));
  EXPECT_EQ(lockstep.needed_from(30, 1000), 20);
  EXPECT_EQ(lockstep.needed_from(33, 1000), 25);  // late at 25, a at 30
  EXPECT_EQ(lockstep.needed_from(33, 7), 30);     // late was due too long ago
  EXPECT_EQ(lockstep.needed_from(33, 2), 33);
  EXPECT_EQ(lockstep.needed_from(3, 1000), 0);
  lockstep.restart_replay();
  for (std::int64_t step = 16; step <= 30; ++step) {  // the world is simulated again up to step 30
    lockstep.post(0, "x", bytes_of(std::to_string(step)));
    if (step < 30) lockstep.pass(step);
  }
  lockstep.end_replay();
  lockstep.rewound(30);
  lockstep.post(0, "x", bytes_of("31"));
  const auto list = [&](const std::string& name) {
    std::string text;
    for (const sim::PostedMessage& message : lockstep.find(name)->list)
      text += std::string(reinterpret_cast<const char*>(message.payload->data()), message.payload->size()) + " ";
    return text;
  };
  lockstep.send_request(30);
  EXPECT_EQ(list("a"), "21 22 23 24 25 26 27 28 29 30 31 ");
  lockstep.send_request(35);
  EXPECT_EQ(list("late"), "26 27 28 29 30 31 ");
}

TEST(Lockstep, AListThatHadNoRoomWhileGoingBackIsNotWhole) {
  Lockstep lockstep;
  lockstep.join("a", session(7, {"x"}), 10, 0);
  const sim::Bytes half(Lockstep::max_pending_bytes / 2);
  for (const bool too_much : {true, false}) {
    lockstep.restart_replay();
    for (int i = 0; i < (too_much ? 2 : 1); ++i) lockstep.post(0, "x", half);
    lockstep.end_replay();
    lockstep.rewound(0);
    EXPECT_EQ(lockstep.find("a")->too_much, too_much);
    EXPECT_EQ(lockstep.find("a")->pending.size(), too_much ? 0u : 1u);
  }
}

TEST(Lockstep, ATickThatWasOpenBeforeGoingBackIsAnsweredFirst) {
  Lockstep lockstep;
  lockstep.join("a", session(7, {"x"}), 10, 0);
  lockstep.join("simple", {}, 10, 0);
  lockstep.post(0, "x", bytes_of("1"));
  lockstep.send_request(60);
  lockstep.rewound(20);
  lockstep.rewound(10);
  EXPECT_EQ(lockstep.abandoned().size(), 2u);
  lockstep.send_request(10);
  EXPECT_EQ(lockstep.find("a")->sequence, 1);  // still the same
  EXPECT_EQ(lockstep.find("a")->list.size(), 1u);
  lockstep.rewound(20);
  const auto abandoned = Lockstep::Verdict::abandoned;
  answer(lockstep, {"a", 60, 7, 1}, 20, abandoned);
  answer(lockstep, {"simple", 60, 0, 0}, 20, abandoned);
  EXPECT_TRUE(lockstep.abandoned().empty());
  answer(lockstep, {"a", 60, 7, 1}, 20, Lockstep::Verdict::repeated);
  answer(lockstep, {"simple", 60, 0, 0}, 20, Lockstep::Verdict::repeated);
  lockstep.send_request(20);
  EXPECT_EQ(lockstep.find("a")->list.size(), 0u);
  answer(lockstep, {"a", 60, 7, 1}, 20, Lockstep::Verdict::repeated);
  answer(lockstep, {"simple", 60, 0, 0}, 20, Lockstep::Verdict::repeated);
  EXPECT_EQ(missing(lockstep, 20), (Names{"a", "simple"}));
  answer(lockstep, {"a", 20, 7, 2}, 20);
  answer(lockstep, {"simple", 20, 0, 0}, 20);
  EXPECT_EQ(missing(lockstep, 20), (Names{}));
}

TEST(Lockstep, JoiningAgainWithAnotherPeriodLeavesAnOpenTickOpen) {
  Lockstep lockstep;
  lockstep.join("a", session(7), 10, 0);
  lockstep.join("simple", {}, 10, 0);
  lockstep.send_request(20);
  lockstep.join("a", session(7), 4, 20);
  lockstep.join("simple", {}, 4, 20);
  EXPECT_EQ(missing(lockstep, 20), (Names{"a", "simple"}));
  lockstep.send_request(20);
  answer(lockstep, {"a", 20, 7, 1}, 20);
  answer(lockstep, {"simple", 20, 0, 0}, 20);
  EXPECT_EQ(missing(lockstep, 20), (Names{}));
  EXPECT_EQ(missing(lockstep, 24), (Names{"a", "simple"}));
}

TEST(Lockstep, AClientThatWasNotAskedYetMaySayThatItLives) {
  Lockstep lockstep;
  lockstep.join("a", session(7), 10, 5);
  answer(lockstep, {"a", 5, 7, 0}, 5, Lockstep::Verdict::repeated);
  EXPECT_EQ(missing(lockstep, 5), (Names{"a"}));
}

TEST(LockstepTerms, CannotAskForMorePatienceThanTheWorldHas) {
  sim::LockstepTerms defaults;
  defaults.on_timeout = sim::OnTimeout::go_on;
  defaults.timeout_s = 0.5;
  const std::string text = "{on_timeout: wait, timeout_s: 60}";
  EXPECT_EQ(sim::read_lockstep_terms(text, defaults).on_timeout, sim::OnTimeout::wait);  // the world does not say
  defaults.agreed = true;
  const auto terms = sim::read_lockstep_terms(text, defaults);
  EXPECT_EQ(terms.on_timeout, sim::OnTimeout::go_on);
  EXPECT_EQ(terms.timeout_s, 0.5);
  EXPECT_EQ(sim::read_lockstep_terms("{timeout_s: 0.1}", defaults).timeout_s, 0.1);
}

TEST(LockstepTerms, ReportTheSessionAlsoOfTextThatIsWrong) {
  EXPECT_EQ(sim::session_in("{session: 12, receives: [a]}", "join"), 12);
  EXPECT_EQ(sim::session_in("{session: 12, acknowledged: 3}", "leave"), 12);
  EXPECT_EQ(sim::session_in("{sesion: 12}", "join"), 0);
  EXPECT_EQ(sim::session_in("{", "leave"), 0);
  EXPECT_EQ(sim::session_in("{session: 12}", "follow"), 12);
  EXPECT_EQ(sim::session_in("{session: 12}", "quit"), 0);
}

TEST(LockstepTerms, AreReadWithClearErrors) {
  sim::LockstepTerms defaults;
  defaults.on_timeout = sim::OnTimeout::pause;
  const auto terms = sim::read_lockstep_terms("{session: 12, receives: [a, b], timeout_s: 2}", defaults);
  EXPECT_EQ(terms.session, 12);
  EXPECT_EQ(terms.receives, (Names{"a", "b"}));
  EXPECT_EQ(terms.timeout_s, 2);
  EXPECT_EQ(terms.on_timeout, sim::OnTimeout::pause);
  EXPECT_FALSE(terms.agreed);
  EXPECT_EQ(sim::read_lockstep_terms("", defaults).session, 0);
  const auto error = [&](const std::string& text) -> std::string {
    try {
      sim::read_lockstep_terms(text, defaults);
    } catch (const sim::ConfigError& caught) {
      return caught.what();
    }
    return "";
  };
  EXPECT_THAT(error("{sesion: 1}"),
              HasSubstr("unknown key 'sesion'; known keys: on_timeout, receives, session, timeo"));
  EXPECT_THAT(error("{session: -1}"), HasSubstr("'session' must be"));
  EXPECT_THAT(error("{receives: [a]}"), HasSubstr("'receives' needs a 'session'"));
  EXPECT_THAT(error("{session: 1, on_timeout: never}"), HasSubstr("on_timeout"));
  EXPECT_THAT(error("{session: 1, receives: ['']}"), HasSubstr("a channel must have 1 to 63 characters"));
}

}  // namespace
