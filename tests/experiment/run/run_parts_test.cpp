// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_parts.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/experiment/run_parts_fixture.hpp"

namespace {

using testing::ElementsAre;

const sim::Bytes word(3, std::byte{1});
constexpr const char* two_buses =
    "buses:\n  - {name: b, lcm_url: 'udpm://239.255.76.67:7671?ttl=0'}\n"
    "  - {name: a, lcm_url: 'udpm://239.255.76.67:7672?ttl=0'}\n";

TEST(RunParts, ATapReceivesWhatIsPublishedOnEveryBus) {
  std::vector<std::string> heard;
  experiment::RunParts::Options options;
  options.tap = [&](std::string_view channel, std::span<const std::byte>, sim::Time) { heard.emplace_back(channel); };
  test::PartsOfARun run(options, two_buses);
  heard.clear();  // what the parts said at their start
  experiment::RunBuses& buses = run.parts.buses;
  EXPECT_TRUE(buses.has_listeners());
  buses.outer().publish("one", word, sim::Time{0});
  buses.of("a").publish("two", word, sim::Time{0});
  buses.set_muted(true);
  buses.of("b").publish("muted", word, sim::Time{0});
  EXPECT_THAT(heard, ElementsAre("one", "two"));
}

TEST(RunParts, ATapOfWhatIsPublishedReceivesItWhileTheBusesAreMuted) {
  std::vector<std::string> heard;
  experiment::RunParts::Options options;
  options.tap = [&](std::string_view channel, std::span<const std::byte>, sim::Time) { heard.emplace_back(channel); };
  options.taps = experiment::RunBuses::Tap::published;
  test::PartsOfARun run(options);
  heard.clear();  // what the parts said at their start
  const auto network = run.parts.buses.network().open_mailbox("one", 10);
  run.parts.buses.set_muted(true);
  run.parts.buses.outer().publish("one", word, sim::Time{0});
  EXPECT_THAT(heard, ElementsAre("one"));
  EXPECT_FALSE(network->take());
}

TEST(RunParts, BusesAreFoundByNameAndByBus) {
  test::PartsOfARun run({}, two_buses);
  experiment::RunBuses& buses = run.parts.buses;
  EXPECT_FALSE(buses.has_listeners());
  EXPECT_TRUE(buses.has(""));
  EXPECT_TRUE(buses.has("a"));
  EXPECT_FALSE(buses.has("c"));
  EXPECT_EQ(buses.name_of(buses.of("a")), "a");
  EXPECT_EQ(buses.name_of(buses.outer()), "");
}

TEST(RunParts, RequestsThatChangeTheWorldAreInTheJournal) {
  std::vector<std::string> inputs;
  test::PartsOfARun run;
  run.parts.journal.set_listener(
      [&](std::int64_t, const bridges::RunJournal::Input& input) { inputs.push_back(input.channel); });
  shoal::sim_control_request_t request{};
  request.command = "do";
  request.text = "{move: {name: crate, position_m: [0, 0, 50]}}";
  run.parts.service.execute_local(request, nullptr);
  EXPECT_THAT(inputs, ElementsAre(bridges::RunJournal::request_channel));
}

}  // namespace
