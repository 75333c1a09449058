// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/record_file.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "bridges/log/event_log.hpp"
#include "bridges/log/mcap_conversion.hpp"
#include "bridges/log/recording_bus.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/utime_t.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/log/mcap_conversion_fixture.hpp"

namespace {

using namespace mcap_conversion_fixture;
using lcm_test::bytes_of;
using lcm_test::ScratchFolder;
using lcm_test::text_of;
using testing::ElementsAre;

std::vector<std::string> events_of(const std::string& path) {
  bridges::EventLogReader log(path);
  std::vector<std::string> events;
  while (const auto event = log.next())
    events.push_back(std::to_string(event->number) + " at " + std::to_string(event->utime) + ": " +
                     text_of(event->payload));
  EXPECT_TRUE(log.problems().empty());
  return events;
}

TEST(RecordBranch, BeginsWithACopyAndContinuesFromThere) {
  const ScratchFolder folder;
  sim::InProcessBus network;
  bridges::RecordingBus bus(network, folder.file("a.lcm"), 1'000);
  bus.publish("x", bytes_of("one"), sim::Time{10});
  const std::uint64_t events = bus.recorded();
  const std::uint64_t position = bus.position();
  bus.publish("x", bytes_of("two"), sim::Time{20});
  bus.prepare(folder.file("b.lcm"), events, position, bridges::Existing::refuse);
  bus.go_on();
  bus.publish("x", bytes_of("other"), sim::Time{15});
  bus.close();
  EXPECT_EQ(bus.error(), std::nullopt);
  EXPECT_THAT(events_of(folder.file("a.lcm")), ElementsAre("0 at 1010: one", "1 at 1020: two"));
  EXPECT_THAT(events_of(folder.file("b.lcm")), ElementsAre("0 at 1010: one", "1 at 1015: other"));
}

TEST(RecordBranch, TheOldRecordContinuesWhenTheNewOneCannotBeMade) {
  const ScratchFolder folder;
  sim::InProcessBus network;
  bridges::RecordingBus bus(network, folder.file("a.lcm"), 0);
  bus.publish("x", bytes_of("one"), sim::Time{10});
  EXPECT_THROW(bus.prepare(folder.file("no/b.lcm"), 0, 0, bridges::Existing::refuse), bridges::BusError);
  EXPECT_THROW(bus.prepare(folder.file("a.lcm"), 0, 0, bridges::Existing::refuse), bridges::BusError);
  bus.publish("x", bytes_of("two"), sim::Time{20});
  bus.close();
  EXPECT_THAT(events_of(folder.file("a.lcm")), ElementsAre("0 at 10: one", "1 at 20: two"));
}

TEST(RecordBranch, TheOldRecordContinuesWhenTheNewOneIsNotWanted) {
  const ScratchFolder folder;
  sim::InProcessBus network;
  bridges::RecordingBus bus(network, folder.file("a.lcm"), 0);
  bus.publish("x", bytes_of("one"), sim::Time{10});
  bus.prepare(folder.file("b.lcm"), bus.recorded(), bus.position(), bridges::Existing::refuse);
  EXPECT_TRUE(std::filesystem::exists(folder.file("b.lcm")));
  bus.give_up();
  EXPECT_FALSE(std::filesystem::exists(folder.file("b.lcm")));
  bus.go_on();
  bus.publish("x", bytes_of("two"), sim::Time{20});
  bus.close();
  EXPECT_THAT(events_of(folder.file("a.lcm")), ElementsAre("0 at 10: one", "1 at 20: two"));
}

TEST(RecordBranch, ACopyThatDoesNotFitOnTheDiskIsRefused) {
  const ScratchFolder folder;
  sim::InProcessBus network;
  bridges::RecordingBus bus(network, folder.file("a.lcm"), 0);
  bus.publish("x", bytes_of("one"), sim::Time{10});
  // A link, as what was prepared without success is removed.
  std::filesystem::create_symlink("/dev/full", folder.file("full"));
  EXPECT_THROW(bus.prepare(folder.file("full"), bus.recorded(), bus.position(), bridges::Existing::overwrite),
               bridges::BusError);
  EXPECT_EQ(bus.error(), std::nullopt);
}

TEST(RecordBranch, AnMcapRecordContinuesInAnotherFile) {
  const ScratchFolder folder;
  sim::InProcessBus network;
  bridges::RecordingBus bus(network, folder.file("a.mcap"), 0);
  bus.publish("x", shoal::encode(shoal::utime_t{1}), sim::Time{10});
  const std::uint64_t events = bus.recorded();
  const std::uint64_t position = bus.position();
  bus.publish("x", shoal::encode(shoal::utime_t{2}), sim::Time{20});
  bus.prepare(folder.file("b.mcap"), events, position, bridges::Existing::refuse);
  bus.publish("x", shoal::encode(shoal::utime_t{3}), sim::Time{30});
  bus.go_on();
  bus.publish("x", shoal::encode(shoal::utime_t{4}), sim::Time{15});
  bus.close();
  EXPECT_EQ(bus.error(), std::nullopt);
  EXPECT_EQ(count_messages(folder.file("a.mcap")), 3u);
  EXPECT_EQ(count_messages(folder.file("b.mcap")), 2u);
}

}  // namespace
