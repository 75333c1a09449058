// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/event_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/eventlog.h>

#include <random>
#include <vector>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/log/recording_bus.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/log/scripted_bus.hpp"

namespace {

using namespace scripted_bus;
using namespace bridges;

using lcm_test::ScratchFolder;

using namespace std::chrono_literals;

TEST(EventLog, ATruncatedLastEventEndsTheReading) {
  const ScratchFolder folder;
  ScriptedBus inner;
  run(inner, folder.file("log"));
  const std::string whole = contents(folder.file("log"));
  for (const std::size_t cut : {1, 10, 40, 60, 75}) {
    write(folder.file("cut"), whole.substr(0, whole.size() - cut));
    EventLogReader reader(folder.file("cut"));
    EXPECT_EQ(read_all(reader).size(), 999u);  // the last one has 28 + 3 + 49 bytes
    ASSERT_EQ(reader.problems().size(), 1u);
    EXPECT_EQ(reader.problems()[0], "byte " + std::to_string(whole.size() - 80) + ": the last event is cut off (" +
                                        std::to_string(80 - cut) + " bytes)");
  }
}

TEST(EventLog, SkipsGarbageAndReportsIt) {
  const ScratchFolder folder;
  ScriptedBus inner;
  run(inner, folder.file("log"));
  const std::string whole = contents(folder.file("log"));
  const std::size_t third = 31 + 32;  // the first two have 0 and 1 bytes of payload
  write(folder.file("bad"), whole.substr(0, third) + "rubbish" + whole.substr(third));
  EventLogReader reader(folder.file("bad"));
  EXPECT_EQ(read_all(reader).size(), 1000u);
  ASSERT_EQ(reader.problems().size(), 1u);
  EXPECT_EQ(reader.problems()[0], "byte 63: 7 bytes between events were skipped");
}

TEST(EventLog, ADamagedLengthCostsOneEvent) {
  const ScratchFolder folder;
  ScriptedBus inner;
  run(inner, folder.file("log"));
  std::string log = contents(folder.file("log"));
  log[24] = 0x70;  // the first event's data length
  write(folder.file("bad"), log);
  EventLogReader reader(folder.file("bad"));
  EXPECT_EQ(read_all(reader).size(), 999u);
  ASSERT_EQ(reader.problems().size(), 1u);
  EXPECT_EQ(reader.problems()[0], "byte 0: 31 bytes of a damaged event were skipped");
}

TEST(EventLog, SurvivesFlippedBits) {
  const ScratchFolder folder;
  ScriptedBus inner;
  run(inner, folder.file("log"));
  const std::string whole = contents(folder.file("log")).substr(0, 4000);
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    std::string log = whole;
    for (int flips = 0; flips < 5; ++flips) log[random() % log.size()] ^= static_cast<char>(1 << random() % 8);
    write(folder.file("bad"), log);
    EventLogReader reader(folder.file("bad"));
    EXPECT_LE(read_all(reader).size(), 80u);
  }
}

TEST(EventLog, AnEmptyFileHasNoEventsAndAMissingOneIsAnError) {
  const ScratchFolder folder;
  write(folder.file("empty"), "");
  EventLogReader reader(folder.file("empty"));
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.problems().empty());
  EXPECT_THROW(EventLogReader(folder.file("missing")), BusError);
  EXPECT_THROW(EventLogReader("/dev/null"), BusError);
}

}  // namespace

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
