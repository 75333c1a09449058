// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/report/chart_axis.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using testing::ElementsAre;

std::vector<std::string> texts_of(const std::vector<double>& values, bool log = false) {
  experiment::ChartAxis axis(log);
  for (const double value : values) axis.add(value);
  const std::vector<double> ticks = axis.ticks();
  std::vector<std::string> texts;
  for (const double tick : ticks) texts.push_back(experiment::tick_text(ticks, tick));
  return texts;
}

TEST(ChartAxis, TicksAreRoundNumbersAroundTheValues) {
  EXPECT_THAT(texts_of({1, 9}), ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(texts_of({0.5141, 4.6}), ElementsAre("0", "1", "2", "3", "4", "5"));
  EXPECT_THAT(texts_of({0, 0.5, 1}), ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_THAT(texts_of({2, 3, 4}), ElementsAre("2", "3", "4"));
  EXPECT_THAT(texts_of({-3, 12}), ElementsAre("-5", "0", "5", "10", "15"));
  EXPECT_THAT(texts_of({1000.01, 1000.04}), ElementsAre("1000.01", "1000.02", "1000.03", "1000.04"));
  EXPECT_THAT(texts_of({2e-7, 9e-7}), ElementsAre("2e-07", "4e-07", "6e-07", "8e-07", "1e-06"));
}

TEST(ChartAxis, OneValueLiesBetweenTicks) {
  EXPECT_THAT(texts_of({7}), ElementsAre("6", "7", "8"));
  EXPECT_THAT(texts_of({0}), ElementsAre("-1", "0", "1"));
  EXPECT_THAT(texts_of({0.7}), ElementsAre("0.60", "0.65", "0.70", "0.75", "0.80"));
  // The same except for rounding.
  EXPECT_THAT(texts_of({7, 7 + 1e-14}), ElementsAre("6.0", "6.5", "7.0", "7.5", "8.0"));
}

TEST(ChartAxis, LogarithmicTicksAreRoundNumbersThemselves) {
  EXPECT_THAT(texts_of({15, 900}, true), ElementsAre("10", "20", "50", "100", "200", "500", "1000"));
  EXPECT_THAT(texts_of({3}, true), ElementsAre("2", "5"));
  EXPECT_THAT(texts_of({1, 1e5}, true), ElementsAre("1", "10", "100", "1000", "10000", "100000"));
}

TEST(ChartAxis, IsEmptyWithoutFiniteValues) {
  experiment::ChartAxis axis, log(true);
  axis.add(std::nan(""));
  log.add(-1);
  EXPECT_TRUE(axis.empty());
  EXPECT_TRUE(log.empty());
}

TEST(ChartAxis, SharesAreThoseOfTheRangeOfTicks) {
  EXPECT_DOUBLE_EQ(experiment::share_of_axis({0, 2, 4}, false, 1), 0.25);
  EXPECT_DOUBLE_EQ(experiment::share_of_axis({1, 10, 100}, true, 10), 0.5);
}

}  // namespace
