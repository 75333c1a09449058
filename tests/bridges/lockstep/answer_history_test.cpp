// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/sim_audit_t.hpp"
#include "tests/bridges/lockstep/lockstep_fixture.hpp"

namespace {

using lcm_test::LockstepWorld;

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

}  // namespace
