#include "bridges/lcm/outgoing_sender.hpp"

#include <gmock/gmock.h>

#include <future>
#include <mutex>

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
  const auto until_the_thread_has_nothing_to_do = [&] { return sender.wait_until_sent(10s); };
  ASSERT_TRUE(until_the_thread_has_nothing_to_do());
  // The thread looks by itself every 20 ms: on a loaded machine it may be faster once, not always.
  const auto sends_itself = [&](const std::string& channel) {
    sender.push(channel, {});
    sender.help();
    EXPECT_TRUE(until_the_thread_has_nothing_to_do());
    const std::lock_guard lock(sent.mutex);
    EXPECT_EQ(sent.channels.back(), channel);
    return sent.threads.back() == std::this_thread::get_id();
  };
  int times = 0;
  for (int i = 0; i < 100; ++i) times += sends_itself(std::to_string(i)) ? 1 : 0;
  EXPECT_GT(times, 50);
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
  std::mutex mutex;
  std::vector<std::pair<std::string, std::thread::id>> sent;
  OutgoingSender sender({}, [&](const OutgoingQueue::Entry& message) {
    if (message.channel == "slow") {
      const auto end = std::chrono::steady_clock::now() + 2 * OutgoingSender::longest_help;
      while (std::chrono::steady_clock::now() < end) std::this_thread::yield();
    }
    const std::lock_guard lock(mutex);
    sent.emplace_back(message.channel, std::this_thread::get_id());
  });
  const auto begin = std::chrono::steady_clock::now();
  for (const char* channel : {"slow", "a", "b"}) sender.push(channel, {});
  sender.help();
  sender.push("c", {});
  sender.help();
  ASSERT_TRUE(sender.wait_until_sent(10s));
  if (std::chrono::steady_clock::now() - begin > OutgoingSender::time_out_of_help) GTEST_SKIP() << "the machine stood";
  const auto helper = std::this_thread::get_id();
  std::vector<std::string> channels;
  for (const auto& [channel, thread] : sent) {
    channels.push_back(channel);
    if (channel != "slow") EXPECT_NE(thread, helper) << channel;
  }
  EXPECT_THAT(channels, ElementsAre("slow", "a", "b", "c"));
}

TEST(OutgoingSender, HelpDoesNotWaitForAThreadThatIsHeldUp) {
  std::promise<void> begun, go_on;
  auto held_up = go_on.get_future().share();
  OutgoingSender sender({}, [&](const OutgoingQueue::Entry& message) {
    if (message.channel != "first") return;
    begun.set_value();
    held_up.wait();
  });
  sender.push("first", {});
  sender.wake();
  begun.get_future().wait();
  sender.push("second", {});
  sender.help();  // would never return
  EXPECT_FALSE(sender.wait_until_sent(1ms));
  go_on.set_value();
  EXPECT_TRUE(sender.wait_until_sent(10s));
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
