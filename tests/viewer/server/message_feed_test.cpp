// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/viewer/server/log_page.hpp"

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

}  // namespace
