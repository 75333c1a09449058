// SPDX-License-Identifier: BSD-3-Clause
#include "verification/fidelity/fidelity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fidelity/fidelity_files.hpp"

namespace {

using namespace fidelity_files;

using testing::StartsWith;

TEST_F(FidelityFiles, ATrajectoryOfOnesOwnIsComparedWithItsStart) {
  write("c.csv", header + "0,1,2,3,0,0,0.5,0,0,0,0,0,0,0\n0.1,1,2,3,0,0,0.5,0,0,0,0,0,0,0\n");
  const std::string file = cases("    bars: {position_max_m: 1e-9}\n");
  const verification::FidelityResult result =
      verification::run_fidelity_case(verification::read_fidelity_file(file).cases.front());
  EXPECT_NEAR(result.ours.front()[0], 1, 1e-12);
  EXPECT_NEAR(result.ours.front()[2], 3, 1e-12);
  EXPECT_NEAR(result.ours.front()[5], 0.5, 1e-12);
  // 2 N up on 11.5 kg and 14.57 kg of added mass, for 0.1 s.
  EXPECT_NEAR(result.ours.back()[2] - 3, -2 / 26.07 * 0.01 / 2, 0.1 * 2 / 26.07 * 0.01 / 2);
  EXPECT_THAT(result.missed, testing::ElementsAre(testing::StartsWith("position_max_m ")));
}

}  // namespace
