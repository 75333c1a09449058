// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_buses.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "bridges/base/bus_error.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/experiment/run_parts_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

const sim::Bytes word(3, std::byte{1});

const sim::LoadedWorld& world_of_three_buses() {
  static const sim::LoadedWorld loaded = sim::load_world_text(
      "shoal: 1\nbuses:\n  - {name: b, lcm_url: 'udpm://239.255.76.67:7671?ttl=0'}\n"
      "  - {name: a, lcm_url: 'udpm://239.255.76.67:7672?ttl=0'}\n",
      "well.yaml", {});
  return loaded;
}

TEST(RunBuses, AdmitTheMessagesOfTheWorldsBusFirstThenByName) {
  experiment::RunBuses buses(world_of_three_buses().config, test::PartsOfARun::run());
  std::vector<std::unique_ptr<sim::Mailbox>> mailboxes;
  for (const char* name : {"b", "a", ""}) mailboxes.push_back(buses.of(name).open_mailbox("note"));
  for (const char* name : {"b", "a", ""}) buses.network(name).publish("note", word, sim::Time{0});
  std::vector<std::string> admitted;
  const auto admit = [&] {
    buses.admit([&](const std::string& bus, std::span<const sim::MessageGate::Delivery>) { admitted.push_back(bus); });
  };
  admit();
  EXPECT_THAT(admitted, ElementsAre("", "a", "b"));
  for (const auto& mailbox : mailboxes) EXPECT_TRUE(mailbox->take());
  admit();
  EXPECT_EQ(admitted.size(), 3u) << "a bus without a message is left out";
}

TEST(RunBuses, MessagesThatWaitWhenTheyAreMutedAreDiscarded) {
  experiment::RunBuses buses(world_of_three_buses().config, test::PartsOfARun::run());
  const auto mailbox = buses.of("a").open_mailbox("note");
  buses.network("a").publish("note", word, sim::Time{0});
  buses.set_muted(true);
  buses.set_muted(false);
  buses.admit([](const std::string& bus, std::span<const sim::MessageGate::Delivery>) { FAIL() << bus; });
  EXPECT_FALSE(mailbox->take());
}

TEST(RunBuses, CountTheMessagesOfAllBuses) {
  experiment::RunBuses buses(world_of_three_buses().config, test::PartsOfARun::run());
  for (const char* name : {"", "a", "b"}) buses.of(name).publish("note", word, sim::Time{0});
  EXPECT_EQ(buses.counts().published, 3u);
}

TEST(RunBuses, ARecordIsARegularFileUnlessAnotherIsAllowed) {
  const test_support::ScratchFolder folder;
  experiment::RunOptions options = test::PartsOfARun::run();
  const auto open = [&] { const experiment::RunBuses buses(world_of_three_buses().config, options); };
  options.record = folder.file(".");
  EXPECT_THAT(open, ThrowsMessage<bridges::BusError>(HasSubstr("cannot record: it is a folder")));
  options.record = folder.file("pipe");
  ASSERT_EQ(mkfifo(options.record.c_str(), 0600), 0);
  EXPECT_THAT(open, ThrowsMessage<bridges::BusError>(HasSubstr("--special-files allows pipes and devices")));
  options.record = folder.file("run.lcm");
  EXPECT_NO_THROW(open());
}

}  // namespace
