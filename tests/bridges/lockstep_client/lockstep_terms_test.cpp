// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/lockstep_terms.hpp"

#include <gtest/gtest.h>

namespace bridges {
namespace {

TEST(LockstepTermsText, IsReadAsItWasMeant) {
  const sim::LockstepTerms defaults{.on_timeout = "wait", .timeout_s = 7};
  sim::LockstepTerms terms{.session = 9'000'000'000'000'000, .on_timeout = "pause", .timeout_s = 0.25};
  terms.receives = {"a.b", "a\"quoted\"", "back\\slash", "]{,: #", "-"};
  sim::LockstepTerms read = sim::read_lockstep_terms(bridges::text_of(terms), defaults);
  EXPECT_EQ(read.session, terms.session);
  EXPECT_EQ(read.receives, terms.receives);
  EXPECT_EQ(read.on_timeout, "pause");
  EXPECT_EQ(read.timeout_s, 0.25);
  EXPECT_TRUE(read.agreed);
  read = sim::read_lockstep_terms(bridges::text_of(sim::LockstepTerms{.session = 1, .on_timeout = "", .timeout_s = 0}),
                                  defaults);
  EXPECT_EQ(read.receives, std::vector<std::string>{});
  EXPECT_EQ(read.on_timeout, "wait");
  EXPECT_EQ(read.timeout_s, 7);
  EXPECT_FALSE(read.agreed);
}

TEST(LeaveTermsText, IsReadAsItWasMeant) {
  const sim::LeaveTerms read =
      sim::read_leave_terms(bridges::text_of(sim::LeaveTerms{.session = 5, .acknowledged = 17}));
  EXPECT_EQ(read.session, 5);
  EXPECT_EQ(read.acknowledged, 17);
}

TEST(FollowTermsText, IsReadAsItWasMeant) {
  EXPECT_EQ(sim::read_follow_terms(bridges::text_of(sim::FollowTerms{.session = 5})).session, 5);
}

}  // namespace
}  // namespace bridges
