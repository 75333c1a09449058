// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/channel_filter.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <optional>

#include "bridges/base/file_descriptor.hpp"
#include "tests/bridges/lcm/datagrams.hpp"

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
