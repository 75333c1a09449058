// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/time_order.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace bridges {
namespace {

TimeOrder order_of(const std::vector<std::int64_t>& stamps) {
  TimeOrder order;
  for (const std::int64_t utime : stamps) order.add(utime, "rover1.odometry");
  return order;
}

TEST(TimeOrder, OfEventsInOrderHasNoProblem) {
  for (const std::vector<std::int64_t>& stamps : {std::vector<std::int64_t>{}, {5}, {5, 5, 7}}) {
    EXPECT_EQ(order_of(stamps).problem(), std::nullopt);
    EXPECT_EQ(order_of(stamps).span_s(), stamps.size() < 2 ? 0 : 2e-6);
  }
}

TEST(TimeOrder, SaysWhereTimeGoesBackAndByHowMuch) {
  const TimeOrder order = order_of({5'000'000, 5'002'000, 4'998'000, 4'995'000});
  EXPECT_EQ(
      order.problem(),
      "time goes back 2 times, first by 0.004 s at event 3 (channel 'rover1.odometry'): several logs in one, or a "
      "clock that was set back");
  EXPECT_DOUBLE_EQ(order.span_s(), 0.007);  // from the earliest to the latest
  EXPECT_THAT(*order_of({2, 1}).problem(), testing::StartsWith("time goes back by 1e-06 s at event 2 ("));
}

TEST(TimeOrder, MayHaveStampsAsFarApartAsTheirTypeAllows) {
  constexpr std::int64_t far = std::int64_t{1} << 62;
  EXPECT_DOUBLE_EQ(order_of({-far, far}).span_s(), 9223372036854.775807);
  EXPECT_THAT(*order_of({far, -far}).problem(), testing::HasSubstr("by 9.22337e+12 s"));
}

}  // namespace
}  // namespace bridges
