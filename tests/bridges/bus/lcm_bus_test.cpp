// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/lcm_bus.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <mutex>
#include <thread>

#include "bridges/lcm/lcm_listener.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace bridges;

using lcm_test::await;
using lcm_test::bytes_of;
using lcm_test::own_url;
using lcm_test::text_of;

using namespace std::chrono_literals;

constexpr sim::Time now{0};

/// The next message of the mailbox, waiting for it.
std::optional<sim::Message> take(sim::Mailbox& mailbox, std::chrono::milliseconds limit = 60s) {
  std::optional<sim::Message> message;
  await([&] { return (message = mailbox.take()).has_value(); }, limit);
  return message;
}

/// Takes what a bus sends over TCP, or lets it wait.
class TcpServer {
 public:
  explicit TcpServer(bool reads = true) : reads_(reads), listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address_;
    EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address_), size), 0);
    EXPECT_EQ(getsockname(listener_, reinterpret_cast<sockaddr*>(&address_), &size), 0);
    EXPECT_EQ(listen(listener_, 8), 0);
    thread_ = std::thread([this] { serve(); });
  }
  ~TcpServer() {
    shutdown(listener_, SHUT_RDWR);
    thread_.join();
    close(listener_);
    if (unread_ >= 0) close(unread_);
  }
  std::string url() const { return "tcpq://127.0.0.1:" + std::to_string(ntohs(address_.sin_port)); }
  bool has(const std::string& text) {
    const std::lock_guard lock(mutex_);
    return got_.find(text) != std::string::npos;
  }

 private:
  void serve() {
    for (int fd = 0; (fd = accept(listener_, nullptr, nullptr)) >= 0; close(fd)) {
      std::array<char, 4096> part{};
      if (recv(fd, part.data(), 8, MSG_WAITALL) != 8) continue;  // someone knocked only
      const std::array<std::uint32_t, 2> answer{htonl(0x287617fa), htonl(0x0100)};
      if (send(fd, answer.data(), sizeof answer, MSG_NOSIGNAL) < 0) continue;
      if (!reads_) return static_cast<void>(unread_ = fd);
      for (ssize_t size = 0; (size = read(fd, part.data(), part.size())) > 0;) {
        const std::lock_guard lock(mutex_);
        got_.append(part.data(), static_cast<std::size_t>(size));
      }
    }
  }

  bool reads_;
  int listener_, unread_ = -1;
  sockaddr_in address_{};
  std::mutex mutex_;
  std::string got_;
  std::thread thread_;
};

TEST(LcmBus, WhoWaitsHasMessagesSentOverTcpToo) {
  TcpServer server;
  LcmBus bus(server.url());
  int quick = 0;
  // Until some were quick, which a busy machine may delay.
  for (int i = 0; quick < 5 && i < 1000; ++i) {
    const std::string text = "message " + std::to_string(i) + ".";
    const auto begin = std::chrono::steady_clock::now();
    bus.publish("a", bytes_of(text), now);
    EXPECT_FALSE(bus.wait_for_message(1ms));
    EXPECT_TRUE(await([&] { return server.has(text); }));
    if (std::chrono::steady_clock::now() - begin < 10ms) ++quick;
  }
  EXPECT_GE(quick, 5) << "nobody else wakes the sender, which looks every 20 ms";
}

/// Messages from another bus come over the network, those of the bus itself at once.
class LcmBusFrom : public testing::TestWithParam<std::string> {
 protected:
  bool from_network() const { return GetParam() == "network"; }

  LcmBus bus{own_url()};
  LcmBus other_bus{own_url()};
  LcmBus& sender = from_network() ? other_bus : bus;
};

INSTANTIATE_TEST_SUITE_P(Sender, LcmBusFrom, testing::Values("network", "itself"),
                         [](const auto& chosen) { return chosen.param; });

TEST_P(LcmBusFrom, DeliversToEveryMailboxOfTheChannel) {
  const auto first = bus.open_mailbox("auv1.lidar");
  const auto second = bus.open_mailbox("auv1.lidar");
  const auto other = bus.open_mailbox("auv1.imu");
  sender.publish("auv1.lidar", bytes_of("hello"), now);
  sender.end_of_step();
  for (sim::Mailbox* mailbox : {first.get(), second.get()}) {
    const auto message = take(*mailbox);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->channel, "auv1.lidar");
    EXPECT_EQ(text_of(message->payload), "hello");
    EXPECT_EQ(message->from_outside, from_network());
    EXPECT_FALSE(mailbox->take());
  }
  EXPECT_FALSE(other->take());
}

TEST_P(LcmBusFrom, ChannelsWithSpecialCharactersAreLiteral) {
  const std::vector<std::string> names{"a.b", "axb", "a+b", "aab", "a*b", "(a)|[b]{1}^$?\\", "a.*"};
  std::vector<std::unique_ptr<sim::Mailbox>> mailboxes;
  for (const std::string& name : names) mailboxes.push_back(bus.open_mailbox(name));
  for (const std::string& name : names) sender.publish(name, bytes_of(name), now);
  sender.end_of_step();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto message = take(*mailboxes[i]);
    ASSERT_TRUE(message) << names[i];
    EXPECT_EQ(text_of(message->payload), names[i]);
  }
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_FALSE(mailboxes[i]->take()) << names[i];
}

TEST_P(LcmBusFrom, CarriesABurstWithoutLossAndInOrder) {
  if (!lcm_test::has_large_receive_buffers()) GTEST_SKIP() << "needs sysctl -w net.core.rmem_max=4194304";
  const auto odd = bus.open_mailbox("odd", 2000);
  const auto even = bus.open_mailbox("even", 2000);
  const std::string filling(800, 'x');
  for (int i = 0; i < 2000; ++i)
    sender.publish(i % 2 == 0 ? "even" : "odd", bytes_of(std::to_string(i) + " " + filling), now);
  sender.end_of_step();
  for (int i = 0; i < 2000; ++i) {
    const auto message = take(i % 2 == 0 ? *even : *odd);
    ASSERT_TRUE(message) << i;
    EXPECT_EQ(std::stoi(text_of(message->payload)), i);
  }
  const sim::BusCounts counts = bus.counts();
  EXPECT_EQ(sender.counts().published, 2000u);
  EXPECT_EQ(counts.received, 2000u);
  EXPECT_EQ(counts.dropped_incoming + counts.dropped_outgoing, 0u);
}

TEST_P(LcmBusFrom, FullMailboxDropsTheOldestAndCounts) {
  const auto small = bus.open_mailbox("a", 3);
  const auto large = bus.open_mailbox("a", 100);
  for (int i = 0; i < 10; ++i) sender.publish("a", bytes_of(std::to_string(i)), now);
  sender.end_of_step();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(take(*large));
  EXPECT_EQ(small->dropped(), 7u);
  EXPECT_EQ(large->dropped(), 0u);
  EXPECT_EQ(bus.counts().dropped_incoming, 7u);
  EXPECT_EQ(text_of(small->take()->payload), "7");
}

TEST_P(LcmBusFrom, WaitingEndsWhenAMessageComes) {
  const auto mailbox = bus.open_mailbox("a");
  EXPECT_FALSE(bus.wait_for_message(1ms));
  std::thread other([&] {
    sender.publish("a", bytes_of("x"), now);
    sender.end_of_step();
  });
  EXPECT_TRUE(bus.wait_for_message(60s));
  EXPECT_TRUE(mailbox->take());
  EXPECT_FALSE(bus.wait_for_message(1ms));
  other.join();
}

TEST_P(LcmBusFrom, WaitingEndsAtOnceWhenAMessageCameBefore) {
  const auto mailbox = bus.open_mailbox("a");
  sender.publish("a", bytes_of("x"), now);
  sender.end_of_step();
  ASSERT_TRUE(take(*mailbox));
  EXPECT_TRUE(bus.wait_for_message(0ms));
  EXPECT_FALSE(bus.wait_for_message(0ms));
}

TEST_P(LcmBusFrom, AClosedMailboxGetsNothing) {
  auto removed = bus.open_mailbox("a");
  const auto stays = bus.open_mailbox("a");
  removed.reset();
  sender.publish("a", bytes_of("x"), now);
  sender.end_of_step();
  EXPECT_TRUE(take(*stays));
}

TEST_P(LcmBusFrom, AMailboxThatIsOpenedAgainReceivesWhatComesFromThenOn) {
  bus.open_mailbox("a").reset();
  sender.publish("a", bytes_of("unreceived"), now);
  sender.end_of_step();
  const auto again = bus.open_mailbox("a");
  sender.publish("a", bytes_of("received"), now);
  sender.end_of_step();
  // The first one may still be on its way when the mailbox opens.
  auto message = take(*again);
  if (message && text_of(message->payload) == "unreceived") message = take(*again);
  ASSERT_TRUE(message);
  EXPECT_EQ(text_of(message->payload), "received");
}

TEST_P(LcmBusFrom, MessagesLeaveAlsoWithoutEndOfStep) {
  const auto mailbox = bus.open_mailbox("a");
  sender.publish("a", bytes_of("x"), now);
  EXPECT_TRUE(take(*mailbox));
}

TEST(LcmBus, WhatItSentItselfDoesNotComeASecondTime) {
  LcmBus bus(own_url()), other(own_url());
  const auto mailbox = bus.open_mailbox("a");
  const auto far = other.open_mailbox("a");
  bus.publish("a", bytes_of("own"), now);
  EXPECT_TRUE(mailbox->take());  // at once, not when it has been around
  bus.end_of_step();
  ASSERT_TRUE(take(*far));
  other.publish("a", bytes_of("foreign"), now);
  other.end_of_step();
  // One sender's messages keep their order: the echo, had it been let in, would be before this.
  const auto next = take(*mailbox);
  ASSERT_TRUE(next);
  EXPECT_EQ(text_of(next->payload), "foreign");
}

TEST_P(LcmBusFrom, RefusesBadChannelNames) {
  EXPECT_THROW(bus.open_mailbox(""), std::invalid_argument);
  EXPECT_THROW(bus.open_mailbox(std::string(64, 'a')), std::invalid_argument);
  EXPECT_THROW(bus.publish("", {}, now), std::invalid_argument);
  EXPECT_THROW(bus.publish(std::string(64, 'a'), {}, now), std::invalid_argument);
  EXPECT_NO_THROW(bus.open_mailbox(std::string(63, 'a')));
}

TEST(LcmBus, TwoProcessesWorthOfBusesReceiveEachOther) {
  LcmBus one(own_url()), two(own_url());
  const auto mailbox = two.open_mailbox("a");
  one.publish("a", bytes_of("x"), now);
  one.end_of_step();
  EXPECT_TRUE(take(*mailbox));
}

TEST(LcmBus, CarriesALargeImage) {
  if (!lcm_test::has_large_receive_buffers()) GTEST_SKIP() << "needs sysctl -w net.core.rmem_max=4194304";
  LcmBus bus(own_url());
  const auto mailbox = bus.open_mailbox("image");
  sim::Bytes image(600'000);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<std::byte>(i * 7);
  bus.publish("image", image, now);
  bus.end_of_step();
  const auto message = take(*mailbox);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->payload, image);
}

TEST(LcmBus, DropsTooLargeMessagesAndCounts) {
  LcmBus bus("memq://");
  const auto mailbox = bus.open_mailbox("a");
  bus.publish("a", sim::Bytes((std::size_t{16} << 20) + 1), now);
  bus.publish("a", bytes_of("x"), now);
  bus.end_of_step();
  EXPECT_EQ(take(*mailbox)->payload.size(), 1u);
  EXPECT_EQ(bus.counts().dropped_outgoing, 1u);
}

// What is sent is never taken, so the sender waits forever: who waited for the sender would not come to the end.
TEST(LcmBus, PublishNeverWaits) {
  TcpServer server(false);
  LcmBus bus(server.url());
  const sim::Bytes payload(64'000);
  for (int i = 0; i < 10'000; ++i) {
    bus.publish("nobody", payload, now);
    bus.end_of_step();
  }
  const sim::BusCounts counts = bus.counts();
  EXPECT_EQ(counts.published, 10'000u);
  EXPECT_GT(counts.dropped_outgoing, 1000u);  // the queue holds 64 MiB, and the network less
}

TEST(LcmBus, TheDestructorSendsWhatIsQueued) {
  LcmListener listener(own_url());
  listener.listen("last");
  {
    LcmBus bus(own_url());
    for (int i = 0; i < 100; ++i) bus.publish("last", bytes_of(std::to_string(i)), now);
  }
  for (int i = 0; i < 100; ++i) {
    const auto message = listener.next(60s);
    ASSERT_TRUE(message);
    EXPECT_EQ(text_of(message->payload), std::to_string(i));
  }
}

}  // namespace
