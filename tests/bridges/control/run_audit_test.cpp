// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/control/run_audit.hpp"

#include <gmock/gmock.h>

#include "bridges/signing/signed_message.hpp"
#include "tests/bridges/lockstep/lockstep_fixture.hpp"
#include "tests/bridges/signing/keyed_world.hpp"

namespace {

using namespace keyed_world;

using lcm_test::LockstepWorld;
using testing::ElementsAre;

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

}  // namespace
