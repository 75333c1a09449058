// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <thread>

#include "bridges/lockstep/lockstep_service.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/bridges/lockstep/lockstep_fixture.hpp"

// Several buses: requests and answers act on their own; whom the last tick is for.

namespace {

using testing::HasSubstr;
using Service = lcm_test::LockstepWorld;

/// The bus of a vehicle: the world's services hold mailboxes of it, so it goes after them.
struct OtherBus {
  sim::InProcessBus in_process;
  sim::Bus& other_bus = in_process;
  sim::MessageGate other_gate{in_process};
};

/// A world with another bus.
struct TwoBuses : OtherBus, Service {
  TwoBuses() : Service("{timeout_s: 60}", {{other_bus, other_gate, "of_a"}}) {}
  /// A request on the other bus; gives the answer.
  shoal::sim_control_reply_t ask_there(const std::string& command, const std::string& client,
                                       const std::string& text = "") {
    shoal::sim_control_request_t request{};
    request.client = client;
    request.command = command;
    request.value = 0.01;
    request.text = text;
    other_bus.publish("sim.control", shoal::encode(request), sim::Time(0));
    service.handle_requests();
    const auto message = replies_there->take();
    return message ? shoal::decode<shoal::sim_control_reply_t>(message->payload, shoal::Finite::any)
                   : shoal::sim_control_reply_t{};
  }
  template <class M>
  void send_there(const std::string& channel, const M& message) {
    other_bus.publish(channel, shoal::encode(message), sim::Time(0));
  }

  std::unique_ptr<sim::Mailbox> replies_there = other_bus.open_mailbox("sim.control.reply");
};

TEST(LockstepBuses, AClientOfTheSameNameOnAnotherBusIsRefused) {
  TwoBuses s;
  ASSERT_TRUE(s.join("pilot", "{session: 7}").ok);
  for (const char* text : {"", "{session: 7}", "{session: 8}"}) {
    const auto reply = s.ask_there("join", "pilot", text);
    EXPECT_FALSE(reply.ok);
    EXPECT_EQ(reply.text,
              "a client 'pilot' already takes part on the world's bus; give the one on bus 'of_a' another name");
  }
  EXPECT_TRUE(s.join("pilot", "{session: 7}").ok);
}

TEST(LockstepBuses, LeaveLetsGoOfNoOneOnAnotherBus) {
  TwoBuses s;
  ASSERT_TRUE(s.join("pilot", "{session: 7}").ok);
  EXPECT_EQ(s.ask_there("leave", "pilot").text,
            "the client 'pilot' takes part on the world's bus; a request on bus 'of_a' does not affect it");
  EXPECT_TRUE(s.lockstep.has("pilot"));
  ASSERT_TRUE(s.ask_there("join", "other").ok);
  EXPECT_EQ(s.request_reply("leave", 0, "", "other").text,
            "the client 'other' takes part on bus 'of_a'; a request on the world's bus does not affect it");
  testing::internal::CaptureStdout();
  EXPECT_TRUE(s.request_reply("leave", 0, "", "pilot").ok);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("a request without its session at 0.00 s on the world's bus released client 'pilot'"));
  EXPECT_FALSE(s.lockstep.has("pilot"));
}

TEST(LockstepBuses, AnswersCountOnTheirOwnBusOnly) {
  TwoBuses s;
  ASSERT_TRUE(s.join("pilot").ok);  // without a session: anyone can know what it answers
  shoal::sim_ack_t ack{};
  ack.client = "pilot";
  s.send_there("sim.ack", ack);
  shoal::sim_resend_t resend_request{};
  resend_request.client = "pilot";
  s.send_there("sim.resend", resend_request);
  shoal::sim_resent_t bundle{};
  bundle.client = "pilot";
  bundle.of_client = 1;
  s.send_there("sim.resent", bundle);
  int waited = 0;
  s.synchronize([&] {
    if (++waited == 2) s.acknowledge(0, "pilot");
  });
  EXPECT_EQ(waited, 2) << "the answer on the other bus counted";
  EXPECT_EQ(s.lockstep.bad_messages(), 3);
}

TEST(LockstepBuses, TheEndIsForThoseWhoAreListed) {
  TwoBuses s;
  ASSERT_TRUE(s.join("simple").ok);
  EXPECT_FALSE(s.request_reply("follow", 0, "", "watcher").ok) << "without a session";
  ASSERT_TRUE(s.request_reply("follow", 0, "{session: 3}", "watcher").ok);
  EXPECT_EQ(s.request_reply("follow", 0, "{session: 3}", "watcher").session, 3) << "asked again";
  ASSERT_TRUE(s.ask_there("follow", "there", "{session: 4}").ok);
  const auto ticks_there = s.other_bus.open_mailbox("sim.tick");
  s.lockstep.publish_end([](std::chrono::milliseconds) { ADD_FAILURE() << "simple clients are not waited for"; },
                         std::chrono::minutes(1));
  const auto here = s.ticks.last();
  EXPECT_EQ(here.last, 1);
  ASSERT_EQ(here.count, 2);
  EXPECT_EQ(here.client[0].name, "simple");
  EXPECT_EQ(here.client[1].name, "watcher");
  EXPECT_EQ(here.client[1].session, 3);
  EXPECT_EQ(here.client[1].sequence, 0);
  const auto there = shoal::decode<shoal::sim_tick_t>(ticks_there->take()->payload, shoal::Finite::any);
  ASSERT_EQ(there.count, 1);
  EXPECT_EQ(there.client[0].name, "there");
}

TEST(LockstepBuses, OneThatWasDroppedIsNotifiedWhenTheRunEnds) {
  Service s("{on_timeout: continue, timeout_s: 0.001}");
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  s.synchronize();  // until the time-out of a millisecond
  s.replies.take_all();
  s.lockstep.publish_end([](std::chrono::milliseconds) {}, std::chrono::minutes(1));
  const auto reply = s.replies.last();
  EXPECT_EQ(reply.session, 5);
  EXPECT_THAT(reply.text, HasSubstr("the world continued without it"));
}

}  // namespace
