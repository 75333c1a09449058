// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/device_table.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "sim/state/state_archive.hpp"

namespace {

using testing::ElementsAre;

TEST(DeviceTable, TheNextNumberIsTheSizeAndStaysSoUntilItIsTaken) {
  sim::DeviceTable table;
  EXPECT_EQ(table.next_number(), 0);
  EXPECT_EQ(table.next_number(), 0);
  EXPECT_EQ(table.size(), 1u);
  EXPECT_EQ(table.at(0), nullptr);
}

TEST(DeviceTable, PrescribedNumbersComeInTheirOrder) {
  sim::DeviceTable table;
  EXPECT_TRUE(table.as_prescribed());
  table.prescribe({4, 2});
  EXPECT_FALSE(table.as_prescribed());
  EXPECT_EQ(table.next_number(), 4);
  EXPECT_THAT(table.free_numbers(), ElementsAre(2, 4));
  EXPECT_EQ(table.size(), 5u);
}

TEST(DeviceTable, NumbersThatCannotBeAreRefused) {
  for (const std::vector<int>& numbers : {std::vector<int>{-1}, std::vector<int>{10'000'000}, std::vector<int>{3, 3}}) {
    sim::DeviceTable table;
    EXPECT_THROW(table.prescribe(numbers), std::out_of_range);
  }
}

TEST(DeviceTable, ASnapshotHasEachFreePlaceOnce) {
  sim::DeviceTable table;
  table.set_free({1, 0, 2}, 3);
  EXPECT_EQ(table.next_number(), 2);
  for (const std::vector<int>& numbers :
       {std::vector<int>{0, 1}, std::vector<int>{0, 1, 1}, std::vector<int>{0, 1, 3}, std::vector<int>{-1, 0, 1}})
    EXPECT_THROW(table.set_free(numbers, 3), sim::SnapshotError);
  EXPECT_THROW(table.set_free({0, 1}, 2), sim::SnapshotError);  // the table has three places
  EXPECT_THAT(table.free_numbers(), ElementsAre(1, 0, 2));
}

}  // namespace
