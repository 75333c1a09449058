// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/read_ahead.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "bridges/log/recording_bus.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using bridges::LogEventView;
using experiment::ReadAhead;

class ReadAheadTest : public testing::Test {
 protected:
  /// Events of many sizes, several blocks of them.
  void write(int events) {
    sim::InProcessBus network;
    bridges::RecordingBus bus(network, path, 0);
    for (int i = 0; i < events; ++i)
      bus.publish("channel" + std::to_string(i % 7), sim::Bytes(static_cast<std::size_t>(i) * 37 % 1'000, std::byte{3}),
                  sim::Time(i));
  }
  test_support::ScratchFolder folder;
  std::string path = folder.file("log.lcm");
};

TEST_F(ReadAheadTest, GivesTheEventsOfTheFileInTheirOrder) {
  write(20'000);  // 10 MB
  ReadAhead ahead(path);
  bridges::EventLogReader file(path);
  LogEventView event;
  while (const auto expected = file.next()) {
    ASSERT_TRUE(ahead.next(event));
    ASSERT_EQ(event.number, expected->number);
    ASSERT_EQ(event.utime, expected->utime);
    ASSERT_EQ(event.offset, expected->offset);
    ASSERT_EQ(event.channel, expected->channel);
    ASSERT_TRUE(
        std::equal(event.payload.begin(), event.payload.end(), expected->payload.begin(), expected->payload.end()));
  }
  EXPECT_FALSE(ahead.next(event));
  EXPECT_FALSE(ahead.next(event));
}

TEST_F(ReadAheadTest, MayBeLeftInTheMiddle) {
  write(20'000);
  for (const int events : {0, 1, 5'000}) {
    ReadAhead ahead(path);
    LogEventView event;
    for (int i = 0; i < events; ++i) ASSERT_TRUE(ahead.next(event));
  }
}

TEST_F(ReadAheadTest, AnEmptyFileHasNoEvents) {
  std::ofstream(path).flush();
  ReadAhead ahead(path);
  LogEventView event;
  EXPECT_FALSE(ahead.next(event));
  EXPECT_THROW(ReadAhead(folder.file("missing.lcm")), bridges::BusError);
}

}  // namespace
