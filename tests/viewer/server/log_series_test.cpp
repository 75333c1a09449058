// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/log_series.hpp"

#include <gmock/gmock.h>

#include "tests/viewer/server/log_page.hpp"

namespace {

using testing::HasSubstr;

TEST(LogView, ASeriesHasEveryValueOfTheLog) {
  const test::TrafficLog log;
  test::LogPage page(log);
  const auto series = page.series(1'000'000, 2'000'000, 4000);
  EXPECT_EQ(series["id"], 5);
  ASSERT_EQ(series["values"].size(), 101u);
  for (std::size_t i = 0; i < 101; ++i) {
    EXPECT_EQ(series["t_us"][i], 1'000'000 + 10'000 * static_cast<int>(i));
    EXPECT_EQ(series["values"][i], test::TrafficLog::height(100 + static_cast<int>(i)));
  }
}

TEST(LogView, ALongSeriesKeepsTheExtremesInAtMostThePointsAskedFor) {
  const test::TrafficLog log;
  test::LogPage page(log);
  const auto series = page.series(0, 10'000'000, 20);
  EXPECT_LE(series["values"].size(), 20u);
  EXPECT_GE(series["values"].size(), 10u);
  double largest = -1e9, smallest = 1e9, shown_largest = -1e9, shown_smallest = 1e9;
  for (int i = 1; i <= 1000; ++i) {
    largest = std::max(largest, test::TrafficLog::height(i));
    smallest = std::min(smallest, test::TrafficLog::height(i));
  }
  std::int64_t before = 0;
  for (std::size_t i = 0; i < series["values"].size(); ++i) {
    shown_largest = std::max(shown_largest, series["values"][i].get<double>());
    shown_smallest = std::min(shown_smallest, series["values"][i].get<double>());
    EXPECT_GE(series["t_us"][i].get<std::int64_t>(), before);
    before = series["t_us"][i];
  }
  EXPECT_EQ(shown_largest, largest);
  EXPECT_EQ(shown_smallest, smallest);
}

TEST(LogView, ASeriesOfAFieldThatIsMissingSaysSo) {
  const test::TrafficLog log;
  test::LogPage page(log);
  EXPECT_EQ(page.series(0, 10'000'000, 20, "pos[3]")["text"],
            "series: shoal.pose_t on 'ball.pose' has no field 'pos[3]'");
}

TEST(LogSeries, WhatCannotBeReadInTimeIsAnError) {
  const test::TrafficLog log;
  const viewer::LogIndex index(log.path);
  bridges::EventLogReader reader(log.path);
  const viewer::SeriesRequest request{"1", "ball.pose", "pos[2]", 0, 10'000'000, 100};
  try {
    viewer::read_series(reader, index, request, std::chrono::steady_clock::time_point());
    FAIL();
  } catch (const viewer::PageRequestError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot be read within a second; ask for a shorter range"));
  }
}

}  // namespace
