// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/viewer/server/log_page.hpp"

// Messages, counts and series of a log.

namespace {

using testing::HasSubstr;

TEST(LogView, ASeekSendsTheLastMessageOfASubscribedChannel) {
  const test::TrafficLog log;
  test::LogPage page(log);
  page.pause();
  page.subscribe("ball.pose");
  for (const std::int64_t time_us : {5'000'000, 1'000'000, 9'000'000}) {
    page.seek(time_us);
    test::ViewMessage message = page.message();
    while (std::abs(message.time_us - time_us) > 100'000) message = page.message();
    EXPECT_LE(message.time_us, time_us);
    EXPECT_EQ(message.header["channel"], "ball.pose");
    EXPECT_EQ(message.header["type"], "shoal.pose_t");
    EXPECT_DOUBLE_EQ(message.header["fields"]["pos"][2].get<double>(),
                     test::TrafficLog::height(static_cast<int>(message.time_us / 10'000)));
  }
}

TEST(LogView, ASubscriptionIsAnsweredWhileTheLogIsPaused) {
  const test::TrafficLog log;
  test::LogPage page(log);
  page.pause();
  page.state_after_seek(4'000'000);
  page.subscribe("ball.pose", 1);
  EXPECT_NEAR(static_cast<double>(page.message().time_us), 4e6, 1e5);
}

TEST(LogView, AnInvalidSubscriptionIsAnError) {
  const test::TrafficLog log;
  test::LogPage page(log);
  page.subscribe("ball.pose", 1000);
  EXPECT_THAT(page.text("error")["text"].get<std::string>(), HasSubstr("'rate_hz' must be above 0 and at most 30"));
}

TEST(LogView, CountsMessagesUpToTheTimeShown) {
  const test::TrafficLog log;
  test::LogPage page(log);
  page.pause();
  for (const std::int64_t time_us : {9'500'000, 500'000, 5'500'000}) {
    page.seek(time_us);
    const auto json = page.text_when("channels", [&](const auto& channels) { return channels["time_us"] == time_us; });
    std::int64_t count = 0;
    for (const auto& item : json["items"])
      if (item["name"] == "ball.pose") {
        count = item["count"];
        EXPECT_EQ(item["type"], "shoal.pose_t");
        EXPECT_EQ(item["bytes"], count * 144);
      }
    // Up to the last poses of the bodies at this time, some thirty per second.
    EXPECT_NEAR(static_cast<double>(count), static_cast<double>(time_us) / 10'000, 5);
  }
}

TEST(LogView, SaysWhoHeardWhomUpToTheTimeShown) {
  const test::TrafficLog log;
  test::LogPage page(log);
  page.pause();
  for (const int seconds : {9, 0, 4}) {
    const std::int64_t time_us = seconds * 1'000'000 + 500'000;
    page.seek(time_us);
    const auto json = page.text_when("links", [&](const auto& links) { return links["time_us"] == time_us; });
    if (seconds == 0) {
      EXPECT_TRUE(json["items"].empty());
      continue;
    }
    const int lost = seconds / 2;
    EXPECT_EQ(json["items"], web_test::Json::array({{{"from", "a/modem"},
                                                     {"to", "b/modem"},
                                                     {"sent", seconds},
                                                     {"received", seconds - lost},
                                                     {"lost", {{"noise", lost}}}}}));
  }
}

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
