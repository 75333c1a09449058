// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/record_line.hpp"

#include <gtest/gtest.h>

namespace {

TEST(RecordLine, HasTheStaticMarginOrSaysThatThereIsNone) {
  experiment::Support support;
  support.static_margin_m = 0.0434;
  EXPECT_EQ(tools::margin_text(support), "static 43 mm");
  support.static_margin_m = -0.0056;
  EXPECT_EQ(tools::margin_text(support), "static -6 mm");
  EXPECT_EQ(tools::margin_text(std::nullopt), "no support");
}

TEST(RecordLine, ListsThePushOfEachDirectionAndTheWeakest) {
  motion::PushMargin margin;
  margin.mass_kg = 2;
  margin.withstood_mps = {1, 2, 0.5, 3, 6, 3, 0.75, 2};  // 6 m/s is the largest push that is tried
  EXPECT_EQ(tools::push_text(margin, 1.5),
            "withstands pushes at 1.50 s, N s: ahead 2.00, ahead left 4.00, left 1.00, back left 6.00, back >12.00, "
            "back right 6.00, right 1.50, ahead right 4.00; least 1.00 left");
}

}  // namespace
