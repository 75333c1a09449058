// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/message_text.hpp"

#include <gtest/gtest.h>

namespace {

using sim::did_you_mean;

TEST(DidYouMean, FindsTheClosestName) {
  EXPECT_EQ(did_you_mean("lider", {"gps", "lidar"}), "; did you mean 'lidar'?");
  EXPECT_EQ(did_you_mean("camera", {"gps", "lidar"}), "");
}

TEST(DidYouMean, FindsANameWithoutItsUnitAndWithAnother) {
  EXPECT_EQ(did_you_mean("speed", {"speed_mps"}), "; did you mean 'speed_mps'?");
  EXPECT_EQ(did_you_mean("speed_kmh", {"speed_mps"}), "; did you mean 'speed_mps', in m/s?");
  EXPECT_EQ(did_you_mean("radius_cm", {"mass_kg", "radius_m"}), "; did you mean 'radius_m', in m?");
  EXPECT_EQ(did_you_mean("speed_limit", {"speed_mps"}), "") << "'limit' is not a unit";
}

TEST(DidYouMean, KnowsWordsOfOtherSimulators) {
  EXPECT_EQ(did_you_mean("revolute", {"hinge", "slider"}), "; did you mean 'hinge'?");
  EXPECT_EQ(did_you_mean("revolute", {"box"}), "");
  EXPECT_EQ(did_you_mean("yaw", {"name", "position_m", "rpy_deg"}), "; did you mean 'rpy_deg'?");
}

}  // namespace
