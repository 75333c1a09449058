// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/memory_forecast.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using sim::MemoryForecast;

TEST(MemoryForecast, RefusesVehiclesThatDoNotFit) {
  // 64 vehicles took 64 MB, and will need half as much again: 1000 take 1500 MB, of which 1400 MB are available.
  MemoryForecast forecast(1000, 5'000'000, 1'400'000'000);
  EXPECT_FALSE(forecast.is_due(63));
  ASSERT_TRUE(forecast.is_due(64));
  EXPECT_EQ(forecast.problem(64, 69'000'000),
            "1000 vehicles would need about 1.5 GB of memory, 1.5 MB each; 1.4 GB are available");
}

TEST(MemoryForecast, IsRepeatedAtEachDoubling) {
  MemoryForecast forecast(1000, 0, 2'000'000'000);
  ASSERT_TRUE(forecast.is_due(64));
  EXPECT_EQ(forecast.problem(64, 64'000'000), "");
  EXPECT_FALSE(forecast.is_due(100));
  ASSERT_TRUE(forecast.is_due(128));
  // The second 64 are larger.
  EXPECT_EQ(forecast.problem(128, 384'000'000),
            "1000 vehicles would need about 4.5 GB of memory, 4.5 MB each; 2.0 GB are available");
}

TEST(MemoryForecast, IsNotMadeWithoutFigures) {
  EXPECT_FALSE(MemoryForecast(1000, {}, 900'000'000).is_due(64));
  EXPECT_FALSE(MemoryForecast(1000, 5'000'000, {}).is_due(64));
  EXPECT_FALSE(MemoryForecast(64, 5'000'000, 900'000'000).is_due(64)) << "all were built";
}

TEST(MemoryForecast, FindsTheMemoryOfThisProcess) {
  const auto available = sim::available_bytes();
  ASSERT_TRUE(available);
  EXPECT_GT(*available, 1'000'000u);
  const auto before = sim::allocated_bytes();
  if (!before) GTEST_SKIP() << "the allocator of a sanitizer is not counted";
  const std::vector<char> block(100'000'000);
  EXPECT_GE(*sim::allocated_bytes(), *before + block.size());
}

TEST(MemoryForecast, WritesSizesWithTwoDigits) {
  EXPECT_EQ(sim::size_text(999), "999 B");
  EXPECT_EQ(sim::size_text(85'400), "85 kB");
  EXPECT_EQ(sim::size_text(3'240'000'000), "3.2 GB");
  EXPECT_EQ(sim::size_text(999'600), "1.0 MB");
}

}  // namespace
