// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/udp_inbox.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <optional>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/lcm/lcm_listener.hpp"
#include "tests/bridges/lcm/datagrams.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/lcm/own_network.hpp"

namespace {

using namespace bridges;

using lcm_test::DatagramSocket;
using lcm_test::own_url;
using lcm_test::short_datagram;

using namespace std::chrono_literals;

DatagramSocket socket_to(const std::string& url) {
  const LcmEndpoint endpoint = lcm_endpoint(resolve_lcm_url(url));
  return {endpoint.address, endpoint.port};
}

constexpr int port = 17'667;

const std::string group = "239.255.76.67";

TEST(UdpInbox, LetsTheKernelDropWhatNoOneWantsUntilSomeOneDoes) {
  const LcmEndpoint endpoint = lcm_endpoint(resolve_lcm_url(own_url()));
  UdpInbox inbox(
      {.group = endpoint.address, .port = endpoint.port, .buffer_bytes = 1 << 20, .this_machine_only = true});
  int received = 0;
  const UdpInbox::Subscription accepts{"wanted", [](const LcmMessage&, void* count) { ++*static_cast<int*>(count); },
                                       &received};
  const UdpInbox::Subscription late{"late", accepts.handler, &received};
  inbox.add(accepts);
  const DatagramSocket out = socket_to(own_url());
  const auto send_and_handle = [&](const char* channel) {
    ASSERT_TRUE(out.send(short_datagram(channel, "payload.")));
    inbox.handle();
  };
  ASSERT_TRUE(lcm_test::await([&] {
    send_and_handle("unwanted");
    return inbox.filters();
  }));
  const auto before = inbox.counts();
  EXPECT_GE(before.unmatched, 64u);
  for (int i = 0; i < 100; ++i) send_and_handle("unwanted");
  send_and_handle("late");
  EXPECT_EQ(inbox.counts().datagrams, before.datagrams);
  send_and_handle("wanted");
  EXPECT_EQ(received, 1);
  inbox.add(late);
  EXPECT_FALSE(inbox.filters());
  send_and_handle("late");
  EXPECT_EQ(received, 2);
  inbox.remove(late);
  send_and_handle("late");
  EXPECT_EQ(received, 2);
}

}  // namespace

namespace bridges {

namespace {

using lcm_test::fragment_datagram;
using lcm_test::short_datagram;

/// A socket of this process's own on the loopback interface, with a filter; what passes it can be read at once.
class FilteredSocket {
 public:
  explicit FilteredSocket(std::vector<sock_filter> program) : in_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(in_.number(), reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(getsockname(in_.number(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    const sock_fprog attached{static_cast<unsigned short>(program.size()), program.data()};
    EXPECT_EQ(setsockopt(in_.number(), SOL_SOCKET, SO_ATTACH_FILTER, &attached, sizeof attached), 0)
        << program.size() << " steps";
    out_.emplace("127.0.0.1", ntohs(address.sin_port));
  }

  bool passes(const sim::Bytes& datagram) {
    // Where nothing is refused the datagram is in the queue when sendto() returns: loopback is synchronous.
    if (!out_->send(datagram)) return false;
    sim::Bytes buffer(70'000);
    return recv(in_.number(), buffer.data(), buffer.size(), MSG_DONTWAIT) == static_cast<ssize_t>(datagram.size());
  }

 private:
  FileDescriptor in_;
  std::optional<lcm_test::DatagramSocket> out_;
};

/// Names of every length, and many that begin alike.
std::vector<std::string> names(std::size_t count) {
  std::vector<std::string> all;
  const std::string alphabet = "abcdefghijklmnopqrstuvwxyz0123456789.abcdefghijklmnopqrstuvwxyz0";
  for (std::size_t length = 1; length <= 63 && all.size() < count; ++length) all.push_back(alphabet.substr(0, length));
  while (all.size() < count) all.push_back("r" + std::to_string(all.size()) + ".cmd");
  return all;
}

TEST(ChannelFilter, LetsEveryMessageOfItsChannelsPass) {
  for (const std::size_t count : {1u, 9u, 70u, 1000u}) {
    const auto channels = names(count);
    FilteredSocket socket(channel_filter(channels));
    for (const std::string& channel : channels) {
      for (const std::size_t size : {0u, 1u, 7u, 8u, 100u, 3000u}) {
        const std::string payload(size, '\xff');
        EXPECT_TRUE(socket.passes(short_datagram(channel, payload))) << channel << " " << size;
        EXPECT_TRUE(socket.passes(
            fragment_datagram({.message_bytes = 100'000, .count = 3, .channel = channel, .payload = payload})))
            << channel << " " << size;
      }
    }
  }
}

TEST(ChannelFilter, DropsWhatNoneOfItsChannelsMatches) {
  FilteredSocket socket(channel_filter(names(70)));
  const std::string payload(8, 'x');  // the least that a message of LCM has
  int passed = 0;
  for (int i = 0; i < 500; ++i) {
    const std::string channel = "garbage" + std::to_string(i);
    passed += socket.passes(short_datagram(channel, payload)) ? 1 : 0;
    passed += socket.passes(fragment_datagram({.count = 3, .channel = channel, .payload = payload})) ? 1 : 0;
    passed += socket.passes(short_datagram(std::string(1 + i % 3, 'Q'), payload)) ? 1 : 0;
  }
  EXPECT_EQ(passed, 0) << "the hash has 32 bits: one in a million sets of 1500 names may meet";
  EXPECT_FALSE(socket.passes(lcm_test::short_datagram("", "")));
  sim::Bytes not_lcm(100);
  EXPECT_FALSE(socket.passes(not_lcm));
}

TEST(ChannelFilter, PassesFragmentsThatDoNotNameTheirChannel) {
  FilteredSocket socket(channel_filter({"a"}));
  EXPECT_TRUE(socket.passes(fragment_datagram({.number = 1, .count = 3, .payload = "x"})));
}

TEST(ChannelFilter, WithoutChannelsPassesFragmentsOnly) {
  FilteredSocket socket(channel_filter({}));
  EXPECT_FALSE(socket.passes(short_datagram("a", "12345678")));
  EXPECT_TRUE(socket.passes(fragment_datagram({.number = 1, .count = 3, .payload = "x"})));
}

TEST(ChannelFilter, OfTooManyChannelsIsEmpty) {
  EXPECT_TRUE(channel_filter(names(10'000)).empty());
}

}  // namespace

}  // namespace bridges
