// SPDX-License-Identifier: BSD-3-Clause
#include "tests/autonomy/cooperative/algorithms/team_dive.hpp"

#include <gtest/gtest.h>

namespace {

using test::DiveScore;
using test::run_dive;
using test::TeamDive;

// Of 20 runs the rms has a standard error of 8 %, and the mean NEES of a consistent filter one of 0.25 (the means of
// single runs deviate by 1.0 to 1.3).  Ratios of algorithms on the same runs are known better.
constexpr int seeds = 20;

TEST(TeamDive, NaiveSharingIsTooSureAndTheOthersAreNot) {
  TeamDive silent_craft;
  silent_craft.craft_silent_after_s = 300;
  const DiveScore dr = run_dive(silent_craft, "dr", seeds), naive = run_dive(silent_craft, "naive", seeds),
                  ci = run_dive(silent_craft, "ci", seeds), iu = run_dive(silent_craft, "iu", seeds),
                  cekf = run_dive(silent_craft, "cekf", seeds);
  EXPECT_GT(naive.nees_mean(), 10);
  EXPECT_LT(naive.inside_95(), 0.5);
  for (const DiveScore* consistent : {&dr, &ci, &iu, &cekf}) {
    EXPECT_GT(consistent->nees_mean(), 1.3);
    EXPECT_LT(consistent->nees_mean(), 2.8);
    EXPECT_GT(consistent->inside_95(), 0.9);
  }
  // Variances of dead reckoning after t s: 1 + (0.03^2 + 0.12^2) t / 2 in each coordinate; from 600 to 3600 s the mean
  // square of both is 2 + 0.0153 * 2100 m^2.
  EXPECT_NEAR(dr.rms_m(), 5.84, 0.15 * 5.84);
  EXPECT_LT(iu.rms_m(), 0.75 * dr.rms_m());
  EXPECT_LT(cekf.rms_m(), 1.02 * iu.rms_m());
  EXPECT_GT(ci.rms_m(), 0.9 * dr.rms_m());  // a single range seldom pays for the inflation
}

TEST(TeamDive, OneVehicleWithSatellitesHelpsThroughAChain) {
  TeamDive chain;
  chain.only_first_hears_the_craft = true;
  const DiveScore naive = run_dive(chain, "naive", seeds), ci = run_dive(chain, "ci", seeds),
                  iu = run_dive(chain, "iu", seeds), cekf = run_dive(chain, "cekf", seeds);
  EXPECT_GT(naive.nees_mean(), 5);
  EXPECT_LT(ci.nees_mean(), 2);
  EXPECT_NEAR(iu.nees_mean(), 2, 0.6);
  EXPECT_NEAR(cekf.nees_mean(), 2, 0.6);
  EXPECT_LT(cekf.rms_m(), iu.rms_m());
  EXPECT_LT(iu.rms_m(), ci.rms_m());
}

TEST(TeamDive, AllThatHearTheCraftAreBetterThanTwoMeters) {
  const DiveScore naive = run_dive({}, "naive", seeds), sci = run_dive({}, "sci", seeds),
                  osm = run_dive({}, "osm", seeds), cekf = run_dive({}, "cekf", seeds);
  EXPECT_GT(naive.nees_mean(), 3);
  EXPECT_NEAR(cekf.rms_m(), 1.43, 0.2);
  EXPECT_NEAR(cekf.nees_mean(), 2, 0.5);
  EXPECT_LT(sci.nees_mean(), 2.3);
  EXPECT_NEAR(osm.nees_mean(), 2, 0.5);
}

TEST(TeamDive, RangesToOneBetterServerNeedItsCorrelation) {
  TeamDive server;
  server.server_is_better = true;
  const DiveScore naive = run_dive(server, "naive", seeds), osm = run_dive(server, "osm", seeds),
                  cekf = run_dive(server, "cekf", seeds);
  EXPECT_GT(naive.nees_mean(), 2.3);
  EXPECT_NEAR(osm.nees_mean(), 2, 0.6);
  EXPECT_NEAR(osm.rms_m(), cekf.rms_m(), 0.1 * cekf.rms_m());
}

}  // namespace
