// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/outgoing_sender.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <future>
#include <mutex>

#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace bridges {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

/// Notes what is sent, and by which thread.
struct Sent {
  void operator()(const OutgoingQueue::Entry& message) {
    const std::lock_guard lock(mutex);
    channels.push_back(message.channel);
    threads.push_back(std::this_thread::get_id());
  }

  std::mutex mutex;
  std::vector<std::string> channels;
  std::vector<std::thread::id> threads;
};

TEST(OutgoingSender, WhoWaitsSendsInItsOwnThread) {
  Sent sent;
  OutgoingSender sender({}, std::ref(sent));
  // The thread looks by itself every 20 ms: on a loaded machine it may be faster, but not always.
  EXPECT_TRUE(lcm_test::await([&] {
    sender.push("a", {});
    sender.help();
    EXPECT_TRUE(sender.wait_until_sent(60s));
    const std::lock_guard lock(sent.mutex);
    return sent.threads.back() == std::this_thread::get_id();
  }));
}

TEST(OutgoingSender, KeepsTheOrderWhoeverSends) {
  Sent sent;
  std::vector<std::string> expected;
  {
    OutgoingSender sender({}, std::ref(sent));
    for (int i = 0; i < 20'000; ++i) {
      expected.push_back(std::to_string(i));
      sender.push(expected.back(), {});
      if (i % 7 == 0) sender.wake();
      if (i % 11 == 0) sender.help();
    }
    sender.close([] {});
  }
  EXPECT_EQ(sent.channels, expected);
}

TEST(OutgoingSender, AMessageThatTheNetworkHoldsUpCostsTheHelperOneSendAndThenNoneForAWhile) {
  using Clock = std::chrono::steady_clock;
  const auto helper = std::this_thread::get_id();
  Sent sent;
  Clock::time_point begin;
  const auto attempt = [&] {
    sent.channels.clear();
    sent.threads.clear();
    OutgoingSender sender({}, [&](const OutgoingQueue::Entry& message) {
      if (message.channel == "slow") {
        const auto end = Clock::now() + 2 * OutgoingSender::max_help;
        while (Clock::now() < end) std::this_thread::yield();
      }
      sent(message);
    });
    begin = Clock::now();
    for (const char* channel : {"slow", "a", "b"}) sender.push(channel, {});
    sender.help();
    sender.push("c", {});
    sender.help();
    EXPECT_TRUE(sender.wait_until_sent(60s));
  };
  // Again when the machine stood, or the thread was faster, which looks by itself every 20 ms.
  ASSERT_TRUE(lcm_test::await([&] {
    attempt();
    return sent.threads.at(0) == helper && Clock::now() - begin < OutgoingSender::time_out_of_help;
  }));
  EXPECT_THAT(sent.channels, ElementsAre("slow", "a", "b", "c"));
  EXPECT_EQ(std::count(sent.threads.begin(), sent.threads.end(), helper), 1);
}

TEST(OutgoingSender, HelpDoesNotWaitForAThreadThatIsHeldUp) {
  std::promise<void> started, go_on;
  auto held_up = go_on.get_future().share();
  OutgoingSender sender({}, [&](const OutgoingQueue::Entry& message) {
    if (message.channel != "first") return;
    started.set_value();
    held_up.wait();
  });
  sender.push("first", {});
  sender.wake();
  started.get_future().wait();
  sender.push("second", {});
  sender.help();  // would never return
  EXPECT_FALSE(sender.wait_until_sent(1ms));
  go_on.set_value();
  EXPECT_TRUE(sender.wait_until_sent(60s));
}

TEST(OutgoingSender, ClosingFreesAThreadThatIsHeldUp) {
  std::promise<void> freed;
  auto held_up = freed.get_future().share();
  OutgoingSender sender({}, [&](const OutgoingQueue::Entry&) { held_up.wait(); });
  sender.push("first", {});
  sender.push("second", {});
  sender.wake();
  sender.close([&] { freed.set_value(); });
  EXPECT_EQ(sender.dropped(), 1u);  // the second was in time for nothing
}

}  // namespace
}  // namespace bridges
