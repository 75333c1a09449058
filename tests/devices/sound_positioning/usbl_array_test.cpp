// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/usbl_array.hpp"

#include <gmock/gmock.h>

#include "sim/world/world_editor.hpp"

namespace {

TEST(UsblArray, HasTheErrorOfTwoPhasesInNoise) {
  devices::UsblArrayParams array;
  array.baseline_m = 0.2;
  // 20 dB and 10 independent samples: phases of 1 / sqrt(2 * 1000) rad each, sqrt(2) times that for their difference.
  EXPECT_NEAR(array.cosine_std({sim::PowerRatio(100), 10, 0.05}),
              0.05 / (2 * M_PI * 0.2) * std::sqrt(1 / 1000.0 * (1 + 1 / 200.0)), 1e-12);
  array.phase_std_rad = 0.3;
  EXPECT_NEAR(array.cosine_std({sim::PowerRatio(1e12), 10, 0.05}), 0.05 / (2 * M_PI * 0.2) * 0.3, 1e-9);
}

TEST(UsblArray, DirectionsTurnAsOnASphere) {
  const sim::Vector3d level = devices::turned(0.3, 0, 0.1, 0);
  EXPECT_NEAR(std::atan2(level.y(), level.x()), 0.4, 1e-12);
  EXPECT_NEAR(level.z(), 0, 1e-12);
  const sim::Vector3d below = devices::turned(0, -M_PI / 2, 0.1, 0);
  EXPECT_NEAR((below - sim::Vector3d(0, std::sin(0.1), -std::cos(0.1))).norm(), 0, 1e-12);
  EXPECT_NEAR(devices::turned(1, -1, 0.2, 0.3).norm(), 1, 1e-12);
  // Beyond the plane of the array: in it.  The side is known.
  EXPECT_EQ(devices::with_cosine_errors({1, 0, 0}, 0.01, 0), sim::Vector3d(1, 0, 0));
  EXPECT_NEAR(devices::with_cosine_errors({0, 0, -1}, 0.6, 0).z(), -0.8, 1e-12);
}

}  // namespace
