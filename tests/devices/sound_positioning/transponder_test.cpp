// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/transponder.hpp"

#include <gmock/gmock.h>

#include "shoal/usbl_t.hpp"
#include "tests/devices/sound_positioning/usbl_worlds.hpp"

namespace {

using namespace usbl_worlds;

using shoal::usbl_t;

std::vector<std::string> first_targets(const std::string& yaml, double within_s = 0.5) {
  test::TestWorld test(yaml);
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.run_for(within_s);
  std::vector<std::string> names;
  for (const auto& fix : fixes.take_all()) names.push_back(fix.target);
  return names;
}

TEST(Transponder, SeveralAnswerAtATimeUnlessTheyShareABand) {
  const auto ring = [](const std::string& more) {
    return transponder("e", "[100, 0, -10]", more) + transponder("n", "[0, 100, -10]", more) +
           transponder("w", "[-100, 0, -10]", more) + transponder("s", "[0, -100, -10]", more);
  };
  EXPECT_THAT(first_targets(usbl_world("", ring(""))), testing::UnorderedElementsAre("e/t", "n/t", "w/t", "s/t"));
  // All answers come at once: the receiver takes one.
  EXPECT_EQ(first_targets(usbl_world("", ring(", answer_frequency_Hz: 30000"))).size(), 1u);
}

TEST(Transponder, ReceivesPingsOnItsFrequencyThatAreLoudEnough) {
  const auto received = [](const std::string& keys, const std::string& more) {
    return !first_targets(usbl_world(keys, transponder("t", "[100, 0, -10]", more))).empty();
  };
  EXPECT_TRUE(received(", frequency_Hz: 20000", ", frequency_Hz: 20000"));
  EXPECT_FALSE(received(", frequency_Hz: 20000", ""));
  EXPECT_FALSE(received("", ", code: A, network: lbl"));
  // 100 m take 15 log10(100) = 30 dB and 0.6 dB; the noise at 26 kHz in 1 kHz is some 60 dB, and 6 dB are needed.
  EXPECT_FALSE(received(", source_level_dB: 80", ""));
  EXPECT_FALSE(received("", ", source_level_dB: 80"));
  EXPECT_TRUE(received(", source_level_dB: 120", ", source_level_dB: 120"));
}

TEST(Transponder, ASilentOneDoesNotAnswer) {
  // It waits for answers from as far as its range, 0.2 s.
  test::TestWorld test(usbl_world(", ping_period_s: 0.1, range_max_m: 120", transponder("t", "[100, 0, -10]")));
  test::Listener<usbl_t> fixes(test, "r1.s");
  test.world.editor().set_fault("t/t", {});  // silent
  test.run_for(0.5);
  EXPECT_EQ(fixes.take_all().size(), 0u);
  test.world.editor().clear_faults("t/t");
  test.run_for(0.5);
  EXPECT_GE(fixes.take_all().size(), 2u);
}

}  // namespace
