// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/recording_bus.hpp"

#include <gtest/gtest.h>
#include <lcm/eventlog.h>

#include <filesystem>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/log/event_log.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/log/scripted_bus.hpp"

namespace {

using namespace scripted_bus;
using namespace bridges;

using lcm_test::await;
using lcm_test::bytes_of;
using lcm_test::ScratchFolder;
using lcm_test::text_of;

using namespace std::chrono_literals;

TEST(RecordingBus, EqualRunsLeaveEqualFiles) {
  const ScratchFolder folder;
  ScriptedBus bus;
  run(bus, folder.file("one.lcm"));
  run(bus, folder.file("two.lcm"));
  EXPECT_EQ(bus.published, 2000);
  EXPECT_EQ(contents(folder.file("one.lcm")), contents(folder.file("two.lcm")));
}

TEST(RecordingBus, StampsEpochPlusSimulatedTimeAndNeverGoesBack) {
  const ScratchFolder folder;
  ScriptedBus inner;
  {
    RecordingBus bus(inner, folder.file("log"), epoch);
    bus.publish("a", bytes_of("1"), sim::Time(0));
    bus.publish("a", bytes_of("2"), sim::Time(2'500'000));
    bus.publish("a", bytes_of("3"), sim::Time(1'000'000));
  }
  EventLogReader reader(folder.file("log"));
  const auto events = read_all(reader);
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].utime, epoch);
  EXPECT_EQ(events[1].utime, epoch + 2'500'000);
  EXPECT_EQ(events[2].utime, epoch + 2'500'000);
  EXPECT_TRUE(reader.problems().empty());
}

TEST(RecordingBus, IsWrittenWhileASimulatedSecondLasts) {
  const ScratchFolder folder;
  ScriptedBus inner;
  RecordingBus bus(inner, folder.file("log"), epoch);
  bus.publish("a", bytes_of("1"), sim::Time(0));
  bus.end_of_step();
  bus.publish("a", bytes_of("2"), sim::Time(1000));
  // A run at a thousandth of real time: nothing more comes for a long while of wall time.
  constexpr std::size_t event_bytes = 28 + 1 + 1;
  const auto size = [&] { return std::filesystem::file_size(folder.file("log")); };
  EXPECT_TRUE(await([&] {
    bus.end_of_step();
    return size() == 2 * event_bytes;
  })) << size()
      << " bytes were written";
}

TEST(RecordingBus, LcmReadsTheLog) {
  const ScratchFolder folder;
  ScriptedBus inner;
  run(inner, folder.file("log"));
  lcm_eventlog_t* log = lcm_eventlog_create(folder.file("log").c_str(), "r");
  ASSERT_NE(log, nullptr);
  int count = 0;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log)) {
    EXPECT_EQ(event->eventnum, count);
    EXPECT_EQ(event->timestamp, epoch + count * 10'000);
    EXPECT_EQ(std::string(event->channel, static_cast<std::size_t>(event->channellen)), "a.b");
    EXPECT_EQ(event->datalen, count % 50);
    lcm_eventlog_free_event(event);
    ++count;
  }
  lcm_eventlog_destroy(log);
  EXPECT_EQ(count, 1000);
}

TEST(RecordingBus, RecordsWhatIsAdmittedAndNotWhatIsTaken) {
  const ScratchFolder folder;
  ScriptedBus inner;
  inner.incoming.push({"a.cmd", bytes_of("thrown away"), true});
  inner.incoming.push({"a.cmd", bytes_of("handed over"), true});
  {
    RecordingBus bus(inner, folder.file("log"), epoch);
    sim::MessageGate gate(bus);
    const auto first = gate.open_mailbox("a.cmd");
    const auto second = gate.open_mailbox("a.cmd");
    gate.collect();
    ASSERT_EQ(gate.waiting().size(), 2u);
    gate.waiting().erase(gate.waiting().begin());
    bus.set_time(sim::Time(70));
    bus.admitted(gate.admit());
  }
  EventLogReader reader(folder.file("log"));
  const auto events = read_all(reader);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(text_of(events[0].payload), "handed over");
  EXPECT_EQ(events[0].utime, epoch + 70);
}

TEST(RecordingBus, AMessageThatComesBackFromTheNetworkIsRecordedOnce) {
  const ScratchFolder folder;
  RecordingBus bus(std::make_unique<LcmBus>("memq://"), folder.file("log"), epoch);
  const auto mailbox = bus.open_mailbox("a");
  bus.publish("a", bytes_of("x"), sim::Time(0));
  bus.end_of_step();
  EXPECT_TRUE(await([&] { return mailbox->take().has_value(); }));
  EXPECT_EQ(bus.recorded(), 1u);
}

TEST(RecordingBus, AFullDiskIsReportedOnceAndTheRunContinues) {
  ScriptedBus inner;
  RecordingBus bus(inner, "/dev/full", epoch, Existing::overwrite);
  const sim::Bytes payload(100'000);
  for (int i = 0; i < 100; ++i) bus.publish("a", payload, sim::Time(i));
  EXPECT_EQ(bus.error().value_or(""), "/dev/full: cannot record: No space left on device");
  EXPECT_EQ(inner.published, 100);
  EXPECT_LT(bus.recorded(), 100u);
}

TEST(RecordingBus, AFullDiskIsReportedAlsoWhenItShowsAtTheEnd) {
  ScriptedBus inner;
  RecordingBus bus(inner, "/dev/full", epoch, Existing::overwrite);
  bus.publish("a", bytes_of("x"), sim::Time(0));
  EXPECT_FALSE(bus.error());
  bus.close();
  EXPECT_EQ(bus.error().value_or(""), "/dev/full: cannot record: No space left on device");
}

TEST(RecordingBus, NothingStaysInMemoryForLong) {
  const ScratchFolder folder;
  ScriptedBus inner;
  RecordingBus bus(inner, folder.file("log"), epoch);
  bus.publish("a", bytes_of("x"), sim::Time(1'000'000));
  EXPECT_TRUE(await([&] { return std::filesystem::file_size(folder.file("log")) == 30; })) << "once a second";
  bus.publish("a", bytes_of("x"), sim::Time(2'000'000));  // too early, if this machine is fast
  EXPECT_TRUE(await([&] {
    bus.hand_over();
    return std::filesystem::file_size(folder.file("log")) == 2 * 30;
  })) << "a run that stands still asks for it";
}

TEST(RecordingBus, OverwritesOnlyWhenTold) {
  const ScratchFolder folder;
  ScriptedBus inner;
  write(folder.file("log"), "precious");
  try {
    RecordingBus bus(inner, folder.file("log"), epoch);
    FAIL();
  } catch (const BusError& error) {
    EXPECT_EQ(std::string(error.what()),
              folder.file("log") + ": already exists; choose another name or pass --overwrite");
  }
  EXPECT_EQ(contents(folder.file("log")), "precious");
  { RecordingBus bus(inner, folder.file("log"), epoch, Existing::overwrite); }
  EXPECT_EQ(contents(folder.file("log")), "");
  EXPECT_THROW(RecordingBus(inner, folder.file("no/such/folder"), epoch), BusError);
}

}  // namespace
