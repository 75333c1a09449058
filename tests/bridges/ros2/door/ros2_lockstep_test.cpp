// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/door/ros2_lockstep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/bridges/lockstep/fake_simulator.hpp"

namespace {

using bridges::ros2::Ros2Lockstep;
using bridges::ros2::Tick;
using bridges::ros2::TickExchange;
using lcm_test::await;
using lcm_test::bytes_of;
using testing::ElementsAre;

/// The lockstep in a thread, with what it gives to the nodes.
class Member {
 public:
  Member()
      : lockstep_(lcm_test::own_url(1), {{"pilot"}, "shoal-ros2", 0.1},
                  {[this](const std::string& channel, std::span<const std::byte>) {
                     lockstep_.count("/" + channel, 10);
                     add("pass " + channel);
                   },
                   [] { return std::optional(std::set<std::string>{"auv1.depth"}); },
                   [this](const Tick& tick) {
                     std::string text = (tick.last ? "last " : "tick ") + std::to_string(tick.step);
                     for (const auto& [topic, count] : tick.counts) text += " " + topic + " " + std::to_string(count);
                     add(text);
                   },
                   [](const std::string&) {}}),
        thread_([this] { lockstep_.run(); }) {}

  Ros2Lockstep& lockstep() { return lockstep_; }
  void join() { thread_.join(); }
  std::vector<std::string> events() {
    const std::scoped_lock lock(mutex_);
    return events_;
  }

 private:
  void add(const std::string& event) {
    const std::scoped_lock lock(mutex_);
    events_.push_back(event);
  }

  std::mutex mutex_;
  std::vector<std::string> events_;
  Ros2Lockstep lockstep_;
  std::thread thread_;
};

/// Answers a request of this name.
void grant(lcm_test::FakeSimulator& simulator, const std::string& command) {
  const auto request = simulator.await_request();
  EXPECT_EQ(request.command, command);
  simulator.reply(request, true, "");
}

TEST(Ros2LockstepTest, ATickFollowsItsMessagesAndWaitsForTheCommandsOfTheNodes) {
  lcm_test::FakeSimulator simulator;
  Member member;
  grant(simulator, "join");
  simulator.tick(1, {"shoal-ros2"});
  EXPECT_TRUE(await([&] { return member.events().size() == 1; }));
  Tick answer;
  answer.step = 1;
  answer.node = "pilot";
  answer.counts = {{"/a", 1}, {"/b", 1}};
  member.lockstep().add("/b", TickExchange::Command{"auv1.cmd", bytes_of("second")});
  member.lockstep().take(answer);
  member.lockstep().add("/a", TickExchange::Command{"auv1.cmd", bytes_of("first")});
  grant(simulator, "join");  // for the channels that it has learned
  EXPECT_THAT(simulator.await_ack().channel, ElementsAre("auv1.cmd", "auv1.cmd"));
  for (const char* text : {"first", "second"}) {
    std::optional<sim::Message> command;
    EXPECT_TRUE(await([&] { return (command = simulator.commands().take()).has_value(); }));
    EXPECT_EQ(lcm_test::text_of(command->payload), text);
  }
  simulator.publish("auv1.depth", bytes_of("7"));
  simulator.tick(2, {"shoal-ros2"}, true);
  member.join();
  EXPECT_THAT(member.events(), ElementsAre("tick 1", "pass auv1.depth", "last 2 /auv1.depth 1"));
}

TEST(Ros2LockstepTest, ToBeStoppedWhileANodeIsSilentReleasesTheWorld) {
  lcm_test::FakeSimulator simulator;
  Member member;
  grant(simulator, "join");
  simulator.tick(1, {"shoal-ros2"});
  EXPECT_TRUE(await([&] { return member.events().size() == 1; }));
  member.lockstep().stop();
  grant(simulator, "leave");
  member.join();
}

}  // namespace
