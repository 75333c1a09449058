// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/sample_calendar.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::vector<std::uint32_t> due_at(sim::SampleCalendar& calendar, std::int64_t step) {
  std::vector<std::uint32_t> due;
  calendar.take(step, due);
  return due;
}

TEST(SampleCalendar, GivesEachSensorAtItsStepOnce) {
  sim::SampleCalendar calendar;
  calendar.add(7, 2);
  calendar.add(3, 2);
  calendar.add(5, 4);
  EXPECT_THAT(due_at(calendar, 1), IsEmpty());
  EXPECT_THAT(due_at(calendar, 2), UnorderedElementsAre(3, 7));
  EXPECT_THAT(due_at(calendar, 3), IsEmpty());
  EXPECT_THAT(due_at(calendar, 4), ElementsAre(5));
}

TEST(SampleCalendar, TakesTheStepsBetweenToo) {
  sim::SampleCalendar calendar;
  calendar.add(1, 2);
  calendar.add(2, 5);
  EXPECT_THAT(due_at(calendar, 6), UnorderedElementsAre(1, 2));
}

TEST(SampleCalendar, ASampleInThePastIsDueAtOnce) {
  sim::SampleCalendar calendar;
  calendar.clear(100);
  calendar.add(1, 40);
  EXPECT_THAT(due_at(calendar, 100), ElementsAre(1));
}

TEST(SampleCalendar, ForgetsWhatIsRemoved) {
  sim::SampleCalendar calendar;
  calendar.add(1, 3);
  calendar.add(2, 3);
  calendar.add(3, 100'000);
  calendar.remove(1, 3);
  calendar.remove(3, 100'000);
  EXPECT_THAT(due_at(calendar, 3), ElementsAre(2));
  EXPECT_THAT(due_at(calendar, 200'000), IsEmpty());
}

TEST(SampleCalendar, KeepsPeriodsOfOneToTenThousandStepsForLong) {
  sim::SampleCalendar calendar;
  const std::vector<std::int64_t> periods = {1, 2, 7, 100, 1000, 1023, 1024, 1025, 2048, 10'000};
  for (std::size_t i = 0; i < periods.size(); ++i) calendar.add(static_cast<std::uint32_t>(i), periods[i]);
  std::map<std::uint32_t, std::int64_t> last;
  std::vector<std::uint32_t> due;
  for (std::int64_t step = 1; step <= 50'000; ++step) {
    due.clear();
    calendar.take(step, due);
    for (const std::uint32_t sensor : due) {
      ASSERT_EQ(step - last[sensor], periods[sensor]) << sensor;
      last[sensor] = step;
      calendar.add(sensor, step + periods[sensor]);
    }
  }
  for (std::size_t i = 0; i < periods.size(); ++i)
    EXPECT_EQ(last[static_cast<std::uint32_t>(i)], 50'000 / periods[i] * periods[i]) << periods[i];
}

}  // namespace
