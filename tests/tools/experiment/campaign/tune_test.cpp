// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/campaign/tune.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using testing::ElementsAre;

TEST(Tune, APointWithoutAValueIsBelowAllOthers) {
  const double none = std::nan("");
  EXPECT_THAT(tools::ranked_values({3, none, 5}, false), ElementsAre(-3, -10, -5));
  EXPECT_THAT(tools::ranked_values({3, none, 5}, true), ElementsAre(3, 0, 5));
  EXPECT_THAT(tools::ranked_values({none, none}, true), ElementsAre(-1, -1));
}

}  // namespace
