// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/gait_family.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/motion/gait/ers7_gait.hpp"

namespace {

TEST(GaitFamily, EachNameMakesAFamilyWhoseStartIsInItsRanges) {
  for (const std::string& name : motion::gait_names()) {
    const auto family = motion::make_gait(name, ers7_gait::ers7());
    EXPECT_FALSE(family->numbers().empty()) << name;
    for (const motion::GaitNumber& number : family->numbers()) {
      EXPECT_LE(number.low, number.start) << name << ' ' << number.name;
      EXPECT_LE(number.start, number.high) << name << ' ' << number.name;
    }
  }
}

TEST(GaitFamily, AnotherNameIsOutOfRange) {
  EXPECT_THROW(motion::make_gait("gallop", ers7_gait::ers7()), std::out_of_range);
}

}  // namespace
