// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/link_losses.hpp"

#include <gtest/gtest.h>

namespace {

using sim::link_losses;
using sim::LinkConfig;

TEST(LinkLosses, AVehicleStandsForAllItsDevices) {
  const std::vector<LinkConfig> links{{"auv1", "auv2/modem", false, 0, 3}};
  EXPECT_EQ(link_losses(links, "auv1/modem", "auv2/modem").loss.dB(), 3);
  EXPECT_EQ(link_losses(links, "auv1/pinger", "auv2/modem").loss.dB(), 3);
  EXPECT_EQ(link_losses(links, "auv1/modem", "auv2/pinger").loss.dB(), 0);
  EXPECT_EQ(link_losses(links, "auv11/modem", "auv2/modem").loss.dB(), 0) << "only begins with the name";
}

TEST(LinkLosses, ApplyInTheOtherDirectionOnlyIfTheLinkGoesBothWays) {
  const std::vector<LinkConfig> one_way{{"a", "b", false, 0, 3}}, both{{"a", "b", true, 0, 3}};
  EXPECT_EQ(link_losses(one_way, "b/m", "a/m").loss.dB(), 0);
  EXPECT_EQ(link_losses(both, "b/m", "a/m").loss.dB(), 3);
}

TEST(LinkLosses, SeveralLinksAddDecibelsAndAreIndependentRisks) {
  const std::vector<LinkConfig> links{{"a", "b", true, 0.5, 3}, {"", "b", true, 0.5, -1}};
  const sim::LinkLosses found = link_losses(links, "a/m", "b/m");
  EXPECT_EQ(found.loss.dB(), 2);
  EXPECT_EQ(found.probability, 0.75);  // 1 - (1 - 0.5)^2
}

}  // namespace
