// SPDX-License-Identifier: BSD-3-Clause
#include "verification/acoustics/acoustic_link.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/verification/acoustics/links_in_the_sea.hpp"
#include "verification/acoustics/acoustic_closed_forms.hpp"
#include "verification/acoustics/ray_picture.hpp"

namespace {

using namespace links_in_the_sea;

using sim::AcousticsConfig;
using sim::Decibels;
using sim::Vector3d;

TEST(AcousticLink, HasTheBudgetOfTheReference) {
  // closed_forms.csv acoustic_link: 185 dB, 25 kHz, 4 kHz wide, 1500 m, k 1.5, shipping 0.5, wind 5 m/s.
  const verification::LinkBudget budget = verification::link_budget(link_over(1500), thorp(), sea());
  EXPECT_NEAR((budget.spreading + budget.absorption).dB(), -56.79857654, 1e-6);
  EXPECT_NEAR(budget.snr.dB(), 53.63274597, 0.1);
  EXPECT_DOUBLE_EQ(budget.travel_time_s, 1);
  EXPECT_FALSE(budget.echoes);
}

TEST(AcousticLink, CountsTheDirectionsOfBothEnds) {
  verification::AcousticLink link = link_over(800);
  link.from.directivity.pattern = link.to.directivity.pattern = sim::DirectivityConfig::Pattern::hemisphere;
  // Both look along +x: the sender at the receiver, the receiver away from the sender.
  const verification::LinkBudget budget = verification::link_budget(link, thorp(), sea());
  EXPECT_EQ(budget.from_gain.dB(), 0);
  EXPECT_EQ(budget.to_gain.dB(), -30);
  // Half of the noise is received, and a thousandth of the other half.
  EXPECT_NEAR((verification::link_budget(link_over(800), thorp(), sea()).noise - budget.noise).dB(),
              -10 * std::log10(0.5 * 1.001), 1e-6);
  link.to.R_WS = Eigen::AngleAxisd(3.14159265358979, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_EQ(verification::link_budget(link, thorp(), sea()).to_gain.dB(), 0);
}

TEST(AcousticLink, DeliversByTheBitErrorsWithoutFading) {
  verification::AcousticLink link = link_over(100);
  link.detection = Decibels(-100);
  const verification::LinkBudget at_185 = verification::link_budget(link, thorp(), sea());
  // A level at which Eb/N0 is 10 dB: the reference's 0.4215 for 32 bytes of FSK.
  const verification::AcousticPacket packet = *verification::parse_packet("fsk:80:32");
  link.source_level += Decibels(10 - 10 * std::log10(4000.0 / 80)) - at_185.snr;
  EXPECT_NEAR(verification::delivery_probability(link, packet, thorp(), sea()), 0.4215093644, 1e-6);
  link.detection = Decibels(6);
  EXPECT_EQ(verification::delivery_probability(link, packet, thorp(), sea()), 0) << "10 dB less 17 dB is not noticed";
}

TEST(AcousticLink, RayleighFadingCostsTheShareOfDeepFades) {
  verification::AcousticLink link = link_over(1000);
  const verification::LinkBudget at_185 = verification::link_budget(link, thorp(), sea());
  link.source_level += Decibels(16) - at_185.snr;
  AcousticsConfig config = thorp();
  config.fading.type = sim::FadingConfig::Type::rayleigh;
  // One bit more or less comes through always: what is lost is what fades by 10 dB and more below the detection.
  const double lost =
      1 - verification::delivery_probability(link, *verification::parse_packet("psk:80:1"), config, sea());
  const double expected = 1 - std::exp(-0.1);
  EXPECT_NEAR(lost, expected, 4 * std::sqrt(expected / 2000));
}

TEST(AcousticLink, EchoesHelpInsideTheWindowAndDisturbAfterIt) {
  AcousticsConfig config = thorp();
  config.multipath.emplace().surface_loss_dB = 0;
  config.multipath->max_bounces = 1;
  config.spreading.factor = 2;
  verification::AcousticLink link = link_over(40);
  config.absorption = {sim::AbsorptionConfig::Model::constant, 0, 8};
  // The surface path is hypot(40, 40) m: 16.569 m and 11.046 ms later, 3.01 dB weaker.
  config.multipath->window_s = 0.012;
  const verification::LinkBudget helped = verification::link_budget(link, config, sea());
  EXPECT_NEAR(helped.echoes->dB(), 10 * std::log10(1.5), 1e-9);
  EXPECT_EQ(helped.late->dB(), -HUGE_VAL);
  config.multipath->window_s = 0.011;
  const verification::LinkBudget hurt = verification::link_budget(link, config, sea());
  EXPECT_NEAR(hurt.echoes->dB(), 0, 1e-12);
  EXPECT_NEAR((hurt.level - *hurt.late).dB(), 10 * std::log10(2.0), 1e-9);
  // rms of two arrivals of shares 2/3 and 1/3: sqrt(2)/3 of the time between them.
  EXPECT_NEAR(hurt.delay_spread_s, std::sqrt(2.0) / 3 * (std::sqrt(2.0) - 1) * 40 / 1500, 1e-9);
  EXPECT_LT(verification::delivery_probability(link, *verification::parse_packet("psk:4000:64"), config, sea()), 0.01)
      << "3 dB over its own echo is below the 6 dB that are needed";
}

TEST(AcousticLink, FollowsTheRayOfAThermocline) {
  AcousticsConfig config = thorp();
  const verification::LinkBudget budget = verification::link_budget(to_50_m(1000), config, thermocline());
  EXPECT_TRUE(budget.bent);
  EXPECT_FALSE(budget.shadow);
  EXPECT_NEAR(budget.travel_time_s, 0.66303492, 2e-7);  // by BELLHOP, as the loss
  EXPECT_NEAR(-budget.spreading.dB(), 69.26, 0.03);
  EXPECT_NEAR(budget.arrival_rad * 180 / std::numbers::pi, -12.011, 0.01);
  config.propagation = sim::SoundPaths::straight;
  EXPECT_FALSE(verification::link_budget(to_50_m(1000), config, thermocline()).bent);
}

}  // namespace
