// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <thread>
#include <utility>

#include "bridges/lockstep/lockstep_service.hpp"
#include "tests/bridges/lockstep/lockstep_fixture.hpp"

// Answers that are not true, and what comes twice on a busy machine.

namespace {

using lcm_test::bytes_of;
using testing::HasSubstr;
using Service = lcm_test::LockstepWorld;

TEST(LockstepAnswers, SaysThatWhatAnAnswerNamesHasNotCome) {
  Service s("{timeout_s: 0.02}");
  const auto reader = s.gate.open_mailbox("cmd");
  ASSERT_TRUE(s.join("liar", "{session: 5}").ok);
  try {
    s.synchronize([&] { s.acknowledge(0, "liar", 5, 1, {{"cmd", "1"}, {"cmd", "2"}, {"elsewhere", "3"}}); });
    ADD_FAILURE();
  } catch (const bridges::LockstepTimeout& timeout) {
    // zlib.crc32(b"1") is 83dcefb7
    EXPECT_STREQ(timeout.what(),
                 "lockstep: client 'liar' acknowledged step 0, but 2 of the 3 messages that it lists were not "
                 "received, first 'cmd' with CRC-32 83dcefb7 within 0.02 s");
  }
}

TEST(LockstepAnswers, SaysWhatDoesNotMatchInWhatIsSentAgain) {
  Service s("{timeout_s: 0.02}");
  const auto reader = s.gate.open_mailbox("cmd");
  ASSERT_TRUE(s.join("liar", "{session: 5}").ok);
  testing::internal::CaptureStdout();
  EXPECT_THROW(s.synchronize([&] {
    s.acknowledge(0, "liar", 5, 1, {{"cmd", "1"}});
    s.resend("liar", '2');
  }),
               bridges::LockstepTimeout);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("client 'liar' sends again 'cmd' with CRC-32 1ad5be0d at place 0, but named 'cmd' with CRC-32 "
                        "83dcefb7"));
}

TEST(LockstepAnswers, WhatALeavingClientSendsTwiceIsNoBadMessage) {
  Service s;
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  s.synchronize([&] { s.acknowledge(0, "pilot", 5, 1); });
  EXPECT_TRUE(s.request_reply("leave", 0, "{session: 5, acknowledged: 1}", "pilot").ok);
  EXPECT_TRUE(s.request_reply("leave", 0, "{session: 5, acknowledged: 1}", "pilot").ok) << "its reply was late";
  s.acknowledge(0, "pilot", 5, 1);  // the tick was late, and it answered once more
  shoal::sim_resend_t resend_request{};
  resend_request.client = "pilot";
  resend_request.session = 5;
  resend_request.sequence = 1;
  s.test.send("sim.resend", resend_request);
  s.synchronize();
  EXPECT_EQ(s.lockstep.bad_messages() + s.service.bad_messages(), 0);
}

TEST(LockstepAnswers, WhatCameWithAnAnswerAfterTheInputsWasLookedAtIsNotAskedFor) {
  Service s("{timeout_s: 60}");
  const auto reader = s.gate.open_mailbox("cmd");
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  // LCM's thread brings a command and the answer behind it between the collection of messages and that of answers.
  s.lockstep.set_on_answer([&](const std::string&) { s.test.bus.publish("cmd", bytes_of("1"), sim::Time(0)); });
  bool sent = false;
  s.lockstep.synchronize(
      [&](std::chrono::milliseconds) {
        if (!std::exchange(sent, true)) s.acknowledge(0, "pilot", 5, 1, {{"cmd", "1"}});
      },
      [&] {  // and then this process has no processor for longer than it waits before it asks: the sleep is the cause
        if (sent)
          std::this_thread::sleep_for(std::chrono::milliseconds(3));  // that is tested, and no wait for a result
        return true;
      });
  EXPECT_EQ(s.admitted(), "1");
  EXPECT_TRUE(s.resend_requests.take_all().empty());
}

TEST(LockstepAnswers, WhatIsSentAgainTooLateIsNoBadMessage) {
  Service s;
  const auto reader = s.gate.open_mailbox("cmd");
  ASSERT_TRUE(s.join("pilot", "{session: 5}").ok);
  s.synchronize([&] {
    s.acknowledge(0, "pilot", 5, 1, {{"cmd", "1"}});
    s.test.bus.publish("cmd", bytes_of("1"), sim::Time(0));
  });
  EXPECT_EQ(s.admitted(), "1");  // the step after; the simulator had asked for it once, and the answer comes now
  s.resend("pilot", '1');
  s.synchronize([&] { s.acknowledge(0, "pilot", 5, 1); });
  EXPECT_EQ(s.lockstep.bad_messages(), 0);
}

}  // namespace
