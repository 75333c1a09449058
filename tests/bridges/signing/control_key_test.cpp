// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "bridges/signing/signed_message.hpp"
#include "shoal/sim_audit_t.hpp"
#include "tests/bridges/lockstep/lockstep_fixture.hpp"

// Who may control a run: with the key of the run, by whom, how often.

namespace {

using lcm_test::bytes_of;
using lcm_test::LockstepWorld;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const bridges::RunKey run_key = bridges::RunKey::from_text(std::string(64, 'a'), "test");
const std::string needs_key = bridges::needs_key_text;

/// A world that is controlled with its key only, and a program that has it.
struct KeyedWorld : LockstepWorld {
  explicit KeyedWorld(const std::string& terms = "{timeout_s: 0.02, on_timeout: continue}") : LockstepWorld(terms) {
    lockstep.guard().require(run_key);
  }
  template <typename Message>
  sim::Bytes signed_payload(const std::string& channel, const Message& message) {
    return signer.sign(channel, shoal::encode(message));
  }
  /// What the service answers to a payload; nothing when it does not.
  std::optional<shoal::sim_control_reply_t> answer_to(const sim::Bytes& payload) {
    replies.take_all();
    test.bus.publish("sim.control", payload, test.world.now());
    answering->handle_requests();
    const auto all = replies.take_all();
    if (all.empty()) return std::nullopt;
    return all.back();
  }
  static shoal::sim_control_request_t request(const std::string& command, const std::string& text = "",
                                              double value = 0, const std::string& client = "pilot") {
    shoal::sim_control_request_t made{};
    made.client = client;
    made.command = command;
    made.text = text;
    made.value = value;
    return made;
  }
  static shoal::sim_ack_t ack(std::int64_t sequence, std::int64_t step, const std::string& command = "") {
    shoal::sim_ack_t made{};
    made.client = "pilot";
    made.session = 5;
    made.sequence = sequence;
    made.step = step;
    made.listed = 1;
    if (!command.empty()) {
      made.count = 1;
      made.channel = {"a.cmd"};
      made.crc = {sim::crc32(bytes_of(command))};
    }
    return made;
  }

  bridges::MessageSigner signer{run_key, "pilot-program"};
  test::Listener<shoal::sim_audit_t> audit{test, "sim.audit"};
};

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

TEST(WhoAsked, StandsInTheRecordAndForTheSummary) {
  KeyedWorld w;
  w.answer_to(w.signed_payload("sim.control", w.request("remove", "a", 0, "operator")));
  w.answer_to(w.signed_payload("sim.control", w.request("remove", "nobody", 0, "operator")));  // nothing happens
  w.answer_to(w.signed_payload("sim.control", w.request("where", "", 0, "operator")));
  w.answer_to(w.signed_payload("sim.control", w.request("quit", "", 0, "operator")));
  std::vector<std::string> recorded;
  for (const auto& audit_entry : w.audit.take_all())
    recorded.push_back(audit_entry.kind + " " + audit_entry.text + " " + audit_entry.client + " " + audit_entry.signer);
  EXPECT_THAT(recorded, ElementsAre("remove a operator pilot-program", "quit  operator pilot-program"));
  ASSERT_EQ(w.service.audit().all().size(), 2u);
  EXPECT_EQ(w.service.audit().all()[1].kind, "quit");
}

TEST(WhoAsked, IsNotifiedOfWhoLetsGoOfAClientAndNotOfOneThatLeavesItself) {
  LockstepWorld w;
  for (const std::string client : {"own", "hanging"}) w.join(client, "{session: 5}");
  w.request_reply("leave", 0, "{session: 5}", "own");
  w.request_reply("leave", 0, "", "hanging");
  ASSERT_EQ(w.service.audit().all().size(), 1u);
  EXPECT_EQ(w.service.audit().all()[0].kind, "leave");
  EXPECT_EQ(w.service.audit().all()[0].client, "hanging");
  EXPECT_EQ(w.service.audit().all()[0].signer, "");
}

TEST(WhoAsked, KeepsTheFirstOfManyAndCountsTheRest) {
  LockstepWorld w;
  for (int i = 0; i < 150; ++i) w.request_reply("quit", 0, "");
  EXPECT_EQ(w.service.audit().all().size(), bridges::RunAudit::max_kept);
  EXPECT_EQ(w.service.audit().count(), 150);
}

TEST(TwoAnswers, ToOneTickAreReportedByName) {
  LockstepWorld w("{timeout_s: 20}");
  test::Listener<shoal::sim_audit_t> audit{w.test, "sim.audit"};
  w.join("pilot", "{session: 5}");
  w.test.world.step();
  w.synchronize([&] { w.acknowledge(1, "pilot", 5, 1, {{"a.cmd", "forged"}}); });
  w.acknowledge(1, "pilot", 5, 1);  // its own
  w.acknowledge(1, "pilot", 5, 1);  // the same once more: the third in all, and it differs from the first again
  w.test.world.step();
  w.synchronize([&] { w.acknowledge(2, "pilot", 5, 2); });
  EXPECT_EQ(w.lockstep.summaries().at(0).contradictions, 2);
  const auto all = audit.take_all();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].kind, "contradiction");
  EXPECT_EQ(all[0].client, "pilot");
  EXPECT_EQ(all[0].text,
            "client 'pilot' gave two different answers to the tick of step 1: one lists 1 message, the other lists 0 "
            "messages");
}

TEST(TwoAnswers, AreFoundAlsoWhenTheClientIsTicksBehind) {
  LockstepWorld w("{timeout_s: 20}");
  w.join("pilot", "{session: 5}");
  for (int tick = 1; tick <= 10; ++tick) {
    w.test.world.step();
    w.synchronize([&] { w.acknowledge(tick, "pilot", 5, tick, {{"a.cmd", "forged"}}); });
  }
  w.acknowledge(1, "pilot", 5, 1);
  w.test.world.step();
  w.synchronize([&] { w.acknowledge(11, "pilot", 5, 11); });
  EXPECT_EQ(w.lockstep.summaries().at(0).contradictions, 1);
}

TEST(TwoAnswers, ThatAreTheSameAreNotReported) {
  LockstepWorld w("{timeout_s: 20}");
  w.join("pilot", "{session: 5}");
  w.test.world.step();
  w.synchronize([&] {
    w.acknowledge(1, "pilot", 5, 0);  // it says that it lives
    w.acknowledge(1, "pilot", 5, 1, {{"a.cmd", "x"}});
    w.acknowledge(1, "pilot", 5, 1, {{"a.cmd", "x"}});
  });
  w.test.world.step();
  w.synchronize([&] { w.acknowledge(2, "pilot", 5, 2); });
  EXPECT_EQ(w.lockstep.summaries().at(0).contradictions, 0);
}

/// A world with a limit on spawn requests.
struct LimitedWorld : lcm_test::ServedWorld {
  LimitedWorld() : ServedWorld("shoal: 1\nphysics: {step_s: 0.01}\nlimits: {spawns_per_client: 2}\n") {}
  std::string spawn(const std::string& name, const std::string& client) {
    const std::string at_m = std::to_string(3 * ++places);
    const auto reply =
        request_reply("spawn", 0,
                      "{name: " + name + ", position_m: [" + at_m +
                          ", 0, 0], model: {shoal: 1, bodies: [{name: b, parts: [{shape: box, mass_kg: 1}]}]}}",
                      client);
    return reply.ok ? "ok" : reply.text;
  }
  int places = 0;
};

TEST(Limits, OnSpawnsAreOfEachClientAndOfAllTogether) {
  LimitedWorld w;
  EXPECT_EQ(w.spawn("a1", "a"), "ok");
  EXPECT_NE(w.spawn("a1", "a"), "ok");  // the name is taken: it does not count
  EXPECT_EQ(w.spawn("a2", "a"), "ok");
  EXPECT_EQ(w.spawn("a3", "a"),
            "client 'a' has used up its 2 spawn requests; see limits.spawns_per_client of the world");
  for (int i = 0; i < 9; ++i)
    for (const std::string n : {"1", "2"}) EXPECT_EQ(w.spawn("b" + std::to_string(i) + n, std::to_string(i)), "ok");
  EXPECT_EQ(w.spawn("c", "c"),
            "all clients together have made 20 spawn requests; see limits.spawns_per_client of the world");
}

}  // namespace
