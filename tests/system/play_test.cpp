// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>

#include "bridges/base/bus_error.hpp"
#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/lockstep_client/lockstep_client.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/utime_t.hpp"
#include "tests/system/shoal_program.hpp"

// `shoal replay --play`: a record drives programs in lockstep, without a world.

namespace {

using namespace system_test;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

class Play : public testing::Test {
 protected:
  /// The third rover of coop_land, as its process is started there, except for its way.
  static Program rover3(const std::string& waypoints = "[[-6,28],[0,28],[0,-28],[6,-28],[6,28]]") {
    return Program({built("shoal-coop-rover"), "--name", "rover3", "--start-m", "[-6,-28]", "--start-yaw-deg", "90",
                    "--waypoints-m", waypoints, "--lcm-url", own_url(1)});
  }
  Program player(std::vector<std::string> more) {
    std::vector<std::string> arguments{built("shoal"), "replay", record, "--play", "--quiet", "--lcm-url", own_url(1)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Program(arguments);
  }
  void record_coop_land() {
    const Ended run = run_shoal({"run", source("worlds/coop_land.yaml"), "--launch", "--duration", "20", "--speed",
                                 "max", "--lcm-url", own_url(), "--record", record});
    ASSERT_THAT(run.exit_code, AnyOf(0, 1)) << run.errors;
  }
  void record_minimal() {
    const Ended run = run_shoal({"run", source("worlds/minimal.yaml"), "--duration", "5", "--speed", "max", "--bus",
                                 "none", "--record", record});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
  }

  ScratchFolder folder;
  const std::string record = folder.file("run.lcm");
};

TEST_F(Play, ARoverThatIsGivenItsRecordSaysTheSame) {
  record_coop_land();
  Program play = player({"--await", "rover3", "--compare"});
  Program rover = rover3();
  EXPECT_EQ(play.wait(), 0) << play.output() << play.errors();
  EXPECT_EQ(rover.wait(), 0) << rover.errors();
  // A decision every 0.1 s from 0 on; what was said to the last tick is in the record as well.
  EXPECT_THAT(
      play.output(),
      AllOf(HasSubstr("played 20.000 s (2000 steps, "), HasSubstr("rover3.drive.cmd: 201 equal\n"),
            HasSubstr("rover3.estimate: 200 equal\n"), HasSubstr("rover3: 201 ticks"), Not(HasSubstr("different"))));
}

TEST_F(Play, ARoverThatDecidesOtherwiseIsFoundOut) {
  record_coop_land();
  Program play = player({"--await", "rover3", "--compare"});
  Program rover = rover3("[[-6,28],[-28,28]]");  // the first leg is the same one
  EXPECT_EQ(play.wait(), 0) << play.output() << play.errors();
  rover.wait();
  Program again = player({"--await", "rover3", "--compare"});
  Program other = rover3("[[28,-28],[-6,28]]");
  EXPECT_EQ(again.wait(), 1) << again.output() << again.errors();
  EXPECT_THAT(again.output(),
              AllOf(HasSubstr("rover3.drive.cmd: "), HasSubstr(" different; first at step 10 (0.100 s): "),
                    HasSubstr(" in the log and ")));
}

/// A client of the lockstep; gives the payloads of each tick.
std::vector<std::vector<sim::Bytes>> ticks_of(const std::string& channel, double period_s) {
  bridges::LockstepClient client(own_url(1), "watcher");
  std::vector<std::vector<sim::Bytes>> ticks(1);
  client.subscribe(
      channel, [&](std::span<const std::byte> payload) { ticks.back().emplace_back(payload.begin(), payload.end()); });
  client.join(period_s, timeout);
  shoal::sim_tick_t tick{};
  while (client.next_tick(tick)) {
    client.acknowledge(tick);
    ticks.emplace_back();
  }
  EXPECT_EQ(client.end(), bridges::LockstepClient::End::last_tick);
  return ticks;
}

TEST_F(Play, EachTickHasTheMessagesOfItsTime) {
  record_minimal();
  Program play = player({});
  const auto ticks = ticks_of("sim.clock", 0.5);
  EXPECT_EQ(play.wait(), 0) << play.output() << play.errors();
  // sim.clock comes at 0, 0.1, ... 5 s; ticks at 0, 0.5, ... 5 s, and one for the end.
  ASSERT_EQ(ticks.size(), 12u);
  EXPECT_EQ(ticks[0].size(), 1u);
  for (std::size_t i = 1; i <= 10; ++i) {
    ASSERT_EQ(ticks[i].size(), 5u) << i;
    const auto last = shoal::decode<shoal::utime_t>(ticks[i].back(), shoal::Finite::any);
    EXPECT_EQ(last.utime % 60'000'000, static_cast<std::int64_t>(i) * 500'000);
  }
}

TEST_F(Play, ProgramsThatOnlyListenReceiveItAtItsSpeed) {
  record_minimal();
  bridges::LcmListener listener(own_url(1));
  listener.listen("sim.clock");
  const auto begin = std::chrono::steady_clock::now();
  Program play = player({"--join-timeout", "0", "--speed", "5", "--until", "3"});
  std::vector<std::int64_t> clocks_us;
  while (clocks_us.empty() || clocks_us.back() != 3'000'000) {  // little enough for the receive buffer
    const auto message = listener.next(timeout);
    ASSERT_TRUE(message) << play.output() << play.errors();
    clocks_us.push_back(shoal::decode<shoal::utime_t>(message->payload, shoal::Finite::any).utime % 60'000'000);
  }
  EXPECT_EQ(play.wait(), 0) << play.output() << play.errors();
  EXPECT_EQ(clocks_us.size(), 31u);  // 0 to 3 s
  EXPECT_FALSE(listener.next(0ms));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 590ms);  // at most five times real time
}

TEST_F(Play, SaysWhatIsWrong) {
  record_minimal();
  Program none_of_ours = player({"--join-timeout", "0.2"});
  EXPECT_EQ(none_of_ours.wait(), 5);
  EXPECT_THAT(none_of_ours.errors(),
              AllOf(HasSubstr("a program has not joined the lockstep on " + own_url(1)),
                    HasSubstr(" within 0.2 s; for programs that only listen: --join-timeout 0")));
  Program awaited = player({"--await", "pilot", "--join-timeout", "0.2"});
  EXPECT_EQ(awaited.wait(), 5);
  EXPECT_THAT(awaited.errors(), HasSubstr("'pilot' has not joined"));
  const Ended late = run_shoal({"replay", record, "--play", "--until", "-1"});
  EXPECT_EQ(late.exit_code, 2);
  const Ended mixed = run_shoal({"replay", record, "--play", "--set", "a=1"});
  EXPECT_EQ(mixed.exit_code, 2);
  const Ended alone = run_shoal({"replay", record, "--compare"});
  EXPECT_EQ(alone.exit_code, 2);
  const Ended none = run_shoal({"replay", folder.file("no.lcm"), "--play"});
  EXPECT_EQ(none.exit_code, 4);
}

TEST_F(Play, RefusesABusWithAnotherSimulator) {
  record_minimal();
  bridges::LcmListener listener(own_url(1));
  listener.listen("sim.info");
  Program first = player({"--join-timeout", "60"});
  ASSERT_TRUE(listener.next(timeout));
  Program second = player({"--join-timeout", "60"});
  EXPECT_EQ(second.wait(), 4);
  EXPECT_THAT(second.errors(), testing::AllOf(HasSubstr("another simulator"), HasSubstr(" on " + own_url(1))));
  first.send_signal(SIGINT);
  EXPECT_EQ(first.wait(), 130);
}

TEST_F(Play, SaysWhichChannelsTheRecordDoesNotHave) {
  record_minimal();
  Program play = player({"--join-timeout", "60"});
  shoal::sim_tick_t tick{};
  {
    bridges::LockstepClient other_client(own_url(1), "stranger");
    other_client.subscribe("rover9.lidar", [](std::span<const std::byte>) {});
    try {
      other_client.join(0.1, timeout);
      FAIL() << "it was let in";
    } catch (const bridges::BusError& error) {
      EXPECT_THAT(error.what(), HasSubstr("the record has no message on any channel that the client asks for, such as "
                                          "'rover9.lidar'"));
    }
  }
  bridges::LockstepClient client(own_url(1), "pilot");
  client.subscribe("rover1.odometry", [](std::span<const std::byte>) {});
  client.subscribe("rover1.sonar", [](std::span<const std::byte>) {});
  client.join(0.1, timeout);
  while (client.next_tick(tick)) client.acknowledge(tick);
  EXPECT_EQ(play.wait(), 0) << play.errors();
  EXPECT_THAT(play.errors(), HasSubstr("client 'pilot' asks for 'rover1.sonar', of which the record has no message"));
}

TEST_F(Play, AnswersRequestsAboutTimeAndRefusesThoseAboutAWorld) {
  record_minimal();
  bridges::LcmListener listener(own_url(1));
  listener.listen("sim.info");
  Program play = player({"--join-timeout", "0", "--speed", "0.01"});
  ASSERT_TRUE(listener.next(timeout));  // it serves requests
  const auto request_reply = [](const std::vector<std::string>& request) { return control(request, own_url(1)); };
  EXPECT_THAT(request_reply({"where"}).output, HasSubstr(" s of 5 s of a record"));
  EXPECT_EQ(request_reply({"pause"}).exit_code, 0);
  const Ended rewind = request_reply({"rewind", "--value", "1"});
  EXPECT_NE(rewind.exit_code, 0);
  EXPECT_THAT(rewind.errors, HasSubstr("there is no world"));
  EXPECT_EQ(request_reply({"quit"}).exit_code, 0);
  EXPECT_EQ(play.wait(), 0) << play.errors();
}

}  // namespace
