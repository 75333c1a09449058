// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/lockstep_terms.hpp"

#include <gmock/gmock.h>

#include "bridges/base/bus_error.hpp"
#include "tests/comma_locale.hpp"

namespace bridges {
namespace {

TEST(LockstepTermsText, IsReadAsItWasMeant) {
  const sim::LockstepTerms defaults{.on_timeout = sim::OnTimeout::wait, .timeout_s = 7};
  sim::LockstepTerms terms{
      .session = 9'000'000'000'000'000, .on_timeout = sim::OnTimeout::pause, .timeout_s = 0.25, .agreed = true};
  terms.receives = {"a.b", "a\"quoted\"", "back\\slash", "]{,: #", "-"};
  sim::LockstepTerms read = sim::read_lockstep_terms(bridges::text_of(terms), defaults);
  EXPECT_EQ(read.session, terms.session);
  EXPECT_EQ(read.receives, terms.receives);
  EXPECT_EQ(read.on_timeout, sim::OnTimeout::pause);
  EXPECT_EQ(read.timeout_s, 0.25);
  EXPECT_TRUE(read.agreed);
  read = sim::read_lockstep_terms(bridges::text_of(sim::LockstepTerms{.session = 1, .timeout_s = 0}), defaults);
  EXPECT_EQ(read.receives, std::vector<std::string>{});
  EXPECT_EQ(read.on_timeout, sim::OnTimeout::wait);
  EXPECT_EQ(read.timeout_s, 7);
  EXPECT_FALSE(read.agreed);
}

TEST(LockstepTermsText, HasAPointInItsNumbersInEveryLocaleOfTheProgram) {
  const test_support::CommaLocale comma;
  for (const double timeout_s : {0.5, 1e-3, 1e6}) {
    const sim::LockstepTerms terms{.session = 5, .timeout_s = timeout_s};
    EXPECT_EQ(sim::read_lockstep_terms(bridges::text_of(terms), {}).timeout_s, timeout_s);
  }
}

TEST(LockstepTermsText, AWordOfTheClientIsOneOfThoseOfTheWorld) {
  EXPECT_EQ(bridges::on_timeout_of("continue"), sim::OnTimeout::go_on);
  EXPECT_EQ(bridges::on_timeout_of(""), std::nullopt);
  EXPECT_THAT([] { bridges::on_timeout_of("never"); },
              testing::ThrowsMessage<BusError>("'on_timeout' must be one of: wait, pause, continue, end; got 'never'"));
}

TEST(LeaveTermsText, IsReadAsItWasMeant) {
  const sim::LeaveTerms read =
      sim::read_leave_terms(bridges::text_of(sim::LeaveTerms{.session = 5, .acknowledged = 17}));
  EXPECT_EQ(read.session, 5);
  EXPECT_EQ(read.acknowledged, 17);
  EXPECT_EQ(read.reason, "");
}

TEST(LeaveTermsText, HasAReasonOfOneLine) {
  const auto read_again = [](const std::string& reason) {
    return sim::read_leave_terms(bridges::text_of(sim::LeaveTerms{.session = 5, .reason = reason})).reason;
  };
  EXPECT_EQ(read_again("KeyError: \"a\\b\"\nat once"), "KeyError: \"a\\b\" at once");
  EXPECT_EQ(read_again(std::string(299, 'x') + "\u00e9"), std::string(299, 'x')) << "characters are kept whole";
}

TEST(FollowTermsText, IsReadAsItWasMeant) {
  EXPECT_EQ(sim::read_follow_terms(bridges::text_of(sim::FollowTerms{.session = 5})).session, 5);
}

}  // namespace
}  // namespace bridges
