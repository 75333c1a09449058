// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/control_guard.hpp"

#include <gmock/gmock.h>

#include "bridges/signing/signed_message.hpp"
#include "sim/base/crc32.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/signing/keyed_world.hpp"

namespace {

using namespace keyed_world;

using testing::HasSubstr;
using testing::IsEmpty;

const std::string needs_key = bridges::needs_key_text;

TEST(ControlKey, RefusesARequestWithoutItAndSaysTheRule) {
  KeyedWorld w;
  const auto reply = w.answer_to(shoal::encode(w.request("quit")));
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->ok);
  EXPECT_EQ(reply->text, needs_key);
  EXPECT_FALSE(w.control.quit);
  EXPECT_EQ(w.service.refused_requests(), 1);
  EXPECT_THAT(w.service.audit().all(), IsEmpty());
}

TEST(ControlKey, ObeysASignedRequestOnce) {
  KeyedWorld w;
  const sim::Bytes captured = w.signed_payload("sim.control", w.request("quit"));
  EXPECT_TRUE(w.answer_to(captured)->ok);
  EXPECT_TRUE(w.control.quit);
  w.control.quit = false;
  EXPECT_FALSE(w.answer_to(captured));  // its sender would take a second answer for one to itself
  EXPECT_EQ(w.service.refused_requests(), 1);
  EXPECT_FALSE(w.control.quit);
}

TEST(ControlKey, RefusesWhatWasSignedForAnotherRun) {
  KeyedWorld w;
  const auto other_key = bridges::RunKey::from_text(std::string(64, 'b'), "test");
  const auto reply = w.answer_to(
      bridges::MessageSigner(other_key, "pilot-program").sign("sim.control", shoal::encode(w.request("quit"))));
  EXPECT_FALSE(reply->ok);
  EXPECT_THAT(reply->text, HasSubstr("signed by 'pilot-program', but not with the key of this run"));
  EXPECT_FALSE(w.control.quit);
}

TEST(ControlKey, AnswersAFloodOfRefusedRequestsTenTimesASecond) {
  KeyedWorld w;
  int answers = 0;
  for (int i = 0; i < 100; ++i) answers += w.answer_to(shoal::encode(w.request("quit"))) ? 1 : 0;
  EXPECT_GE(answers, 10);
  EXPECT_LE(answers, 30);  // a busy machine may take more than a second
  EXPECT_EQ(w.service.refused_requests(), 100);
}

TEST(ControlKey, RefusesAnAnswerToATickWithoutItAndTakesTheSignedOne) {
  KeyedWorld w("{timeout_s: 20}");
  const auto pilot = w.request("join", "{session: 5}", 0.01);
  EXPECT_FALSE(w.answer_to(shoal::encode(pilot))->ok);
  EXPECT_FALSE(w.lockstep.has("pilot"));
  EXPECT_TRUE(w.answer_to(w.signed_payload("sim.control", pilot))->ok);
  w.test.world.step();
  int waits = 0;
  w.synchronize([&] {
    if (++waits == 1) w.test.send("sim.ack", KeyedWorld::ack(1, 1, "forged"));
    if (waits == 2) w.test.bus.publish("sim.ack", w.signed_payload("sim.ack", KeyedWorld::ack(1, 1)), sim::Time(0));
  });
  EXPECT_EQ(waits, 2);
  EXPECT_EQ(w.lockstep.bad_messages(), 1);
}

TEST(ControlKey, LetsTheTimeOutDecideWhenNoOneSignsTheAnswers) {
  KeyedWorld w;
  w.answer_to(w.signed_payload("sim.control", w.request("join", "{session: 5}", 0.01)));
  w.test.world.step();
  w.synchronize([&] { w.test.send("sim.ack", KeyedWorld::ack(1, 1)); });
  EXPECT_FALSE(w.lockstep.has("pilot"));
  EXPECT_THAT(w.lockstep.summaries().at(0).ended, HasSubstr("no acknowledgement from 'pilot' for step 1"));
}

TEST(ControlKey, IsNotLostToAClientByForgedRequestsInItsName) {
  KeyedWorld w;
  w.answer_to(w.signed_payload("sim.control", w.request("join", "{session: 5}", 0.01)));
  const auto reply = w.answer_to(shoal::encode(w.request("join", "{session: 5}", 0.01)));
  EXPECT_FALSE(reply->ok);
  EXPECT_EQ(reply->session, 0);  // a client takes only a refusal of its session for its end
}

TEST(ControlKey, RefusesALeaveWithoutIt) {
  KeyedWorld w;
  w.answer_to(w.signed_payload("sim.control", w.request("join", "{session: 5}", 0.01)));
  EXPECT_EQ(w.answer_to(shoal::encode(w.request("leave")))->text, needs_key);
  EXPECT_TRUE(w.lockstep.has("pilot"));
  EXPECT_TRUE(w.answer_to(w.signed_payload("sim.control", w.request("leave")))->ok);
  EXPECT_FALSE(w.lockstep.has("pilot"));
}

TEST(ControlKey, IsNotNeededByASimulatorThatAsksWhetherItIsAlone) {
  KeyedWorld w;
  const bridges::OtherSimulators ours({}, false);
  bridges::SimService service(w.test.bus, w.test.bus, w.test.world, w.control, w.lockstep, {"{}", "test"},
                              {.others = &ours});
  w.answering = &service;
  EXPECT_TRUE(w.answer_to(shoal::encode(w.request("alive", "", 0, "shoal-run")))->ok);
  EXPECT_FALSE(w.answer_to(shoal::encode(w.request("alive")))->ok);
}

}  // namespace
