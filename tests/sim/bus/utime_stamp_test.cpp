// SPDX-License-Identifier: BSD-3-Clause
#include "sim/bus/utime_stamp.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "shoal/message_codec.hpp"
#include "shoal/utime_t.hpp"

namespace {

TEST(UtimeStamp, IsThatOfTheEncodedMessage) {
  for (const std::int64_t utime : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1'700'000'000'123'456},
                                   std::numeric_limits<std::int64_t>::min()})
    EXPECT_EQ(sim::utime_of(shoal::encode(shoal::utime_t{utime})), utime);
}

TEST(UtimeStamp, IsReplacedAndNothingElse) {
  sim::Bytes payload = shoal::encode(shoal::utime_t{5});
  sim::set_utime(payload, -7);
  EXPECT_EQ(shoal::decode<shoal::utime_t>(payload, shoal::Finite::required).utime, -7);
  payload.push_back(std::byte{9});
  sim::set_utime(payload, 1);
  EXPECT_EQ(payload.back(), std::byte{9});
}

TEST(UtimeStamp, OfAMessageThatIsTooShortIsNone) {
  sim::Bytes payload = shoal::encode(shoal::utime_t{5});
  payload.pop_back();
  EXPECT_FALSE(sim::utime_of(payload));
  EXPECT_FALSE(sim::utime_of({}));
}

}  // namespace
