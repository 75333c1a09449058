// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/udp_receiver.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/lcm/udp_inbox.hpp"
#include "tests/bridges/lcm/datagrams.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/lcm/own_network.hpp"

namespace {

using namespace bridges;

using lcm_test::bytes_of;
using lcm_test::DatagramSocket;
using lcm_test::fragment_datagram;
using lcm_test::own_url;
using lcm_test::short_datagram;
using lcm_test::text_of;

using namespace std::chrono_literals;

DatagramSocket socket_to(const std::string& url) {
  const LcmEndpoint endpoint = lcm_endpoint(resolve_lcm_url(url));
  return {endpoint.address, endpoint.port};
}

/// How a process that listens to "a" ends when it gets these datagrams, and then the message "after them": 0 when it
/// receives this one.
int listener_after(const std::vector<sim::Bytes>& datagrams) {
  const std::string url = own_url();
  const pid_t child = fork();
  if (child == 0) {
    try {
      LcmListener listener(url);
      listener.listen("a");
      while (const auto message = listener.next(60s))
        if (text_of(message->payload) == "after them") _exit(0);
    } catch (const BusError& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    _exit(1);
  }
  const DatagramSocket out = socket_to(url);
  const FileDescriptor ended(static_cast<int>(syscall(SYS_pidfd_open, child, 0)));
  pollfd end{ended.number(), POLLIN, 0};
  // Until it is up the datagrams are lost; it receives them when it receives the last.
  for (int i = 0; i < 6000 && poll(&end, 1, 10) == 0; ++i) {
    for (const sim::Bytes& datagram : datagrams) EXPECT_TRUE(out.send(datagram));
    EXPECT_TRUE(out.send(short_datagram("a", "after them")));
  }
  if (end.revents == 0) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

TEST(UdpReceiver, AFragmentFarBeyondItsMessageDoesNoHarm) {
  const auto fragment = fragment_datagram({.message_bytes = 100'000,
                                           .offset = 0xffffffff,
                                           .number = 0,
                                           .count = 2,
                                           .channel = "a",
                                           .payload = std::string(50, 'x')});
  EXPECT_EQ(fragment.size(), 72u);
  EXPECT_EQ(listener_after({fragment}), 0) << "negative: the signal that killed it";
}

/// Runs a shell command; throws when it fails.
void command(const std::string& line) {
  if (std::system(line.c_str()) != 0) throw std::runtime_error("failed: " + line);
}

void report(int fd) {
  if (write(fd, "x", 1) != 1) throw std::runtime_error("the other process is gone");
}

void await_word(int fd) {
  char word = 0;
  if (read(fd, &word, 1) != 1) throw std::runtime_error("the other process is gone");
}

constexpr int port = 17'667;

const std::string group = "239.255.76.67";

/// Another machine, at 10.7.0.2: sends to the bus of 10.7.0.1 by unicast and by multicast until it is killed.
[[noreturn]] void be_another_machine(int reported, int tells) {
  try {
    if (unshare(CLONE_NEWNET) != 0) _exit(1);
    report(tells);
    await_word(reported);
    command("ip addr add 10.7.0.2/24 dev v1 && ip link set v1 up && ip route add 224.0.0.0/4 dev v1");
    const DatagramSocket unicast("10.7.0.1", port), multicast(group, port);
    const int ttl = 1;
    setsockopt(multicast.fd(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
    while (true) {
      unicast.send(short_datagram("a", "unicast from outside"));
      multicast.send(short_datagram("a", "multicast from outside"));
      std::this_thread::sleep_for(5ms);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  _exit(1);
}

/// A socket of an LCM program as they were: it receives whatever comes to the port.
class PlainSocket {
 public:
  PlainSocket() : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const int yes = 1;
    setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in any{};
    any.sin_family = AF_INET;
    any.sin_port = htons(port);
    if (bind(fd_, reinterpret_cast<const sockaddr*>(&any), sizeof any) != 0) throw std::runtime_error("no port");
  }
  ~PlainSocket() { close(fd_); }
  bool receives(std::string_view text) {
    std::array<char, 2000> buffer{};
    const auto got = recv(fd_, buffer.data(), buffer.size(), MSG_DONTWAIT);
    return got > 0 && std::string_view(buffer.data(), static_cast<std::size_t>(got)).find(text) != text.npos;
  }

 private:
  int fd_;
};

bool accepts_only_own_address() {
  std::array<int, 2> there{}, back{};
  if (pipe(there.data()) != 0 || pipe(back.data()) != 0) return false;
  const pid_t other = fork();
  if (other == 0) be_another_machine(there[0], back[1]);
  await_word(back[0]);
  command("ip link set lo up && ip link add v0 type veth peer name v1 netns " + std::to_string(other) +
          " && ip addr add 10.7.0.1/24 dev v0 && ip link set v0 up && ip route add 224.0.0.0/4 dev v0");
  const std::string url = "udpm://" + group + ":" + std::to_string(port) + "?ttl=";
  LcmListener here(url + "0"), network(url + "1");
  PlainSocket plain;
  here.listen("a");
  network.listen("a");
  report(there[1]);
  // That both kinds arrive is seen by those who receive them.
  bool unicast_came = false, multicast_came = false, unicast_received = false;
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (!(unicast_came && multicast_came) && std::chrono::steady_clock::now() < deadline) {
    unicast_came |= plain.receives("unicast from outside");
    while (const auto message = network.next(5ms)) {
      multicast_came |= text_of(message->payload) == "multicast from outside";
      unicast_received |= text_of(message->payload) == "unicast from outside";
      if (multicast_came) break;
    }
  }
  network.publish("a", bytes_of("from here"));
  const auto first = here.next(60s);
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  if (!unicast_came || !multicast_came) std::fputs("nothing came from the other machine\n", stderr);
  if (unicast_received) std::fputs("with ttl=1 unicast is received\n", stderr);
  if (!first) std::fputs("with ttl=0 not even what is sent here is received\n", stderr);
  if (first) std::fprintf(stderr, "with ttl=0, first: %s\n", text_of(first->payload).c_str());
  return unicast_came && multicast_came && !unicast_received && first && text_of(first->payload) == "from here";
}

TEST(UdpReceiver, WhileTtlIsZeroOnlyThisMachineIsReceivedAndUnicastNever) {
  const int result = lcm_test::in_own_network(accepts_only_own_address);
  if (result == lcm_test::not_permitted) GTEST_SKIP() << "user and network namespaces are not permitted here";
  EXPECT_EQ(result, 0);
}

TEST(UdpReceiver, OtherGroupsOnItsPortAreNotReceived) {
  const std::string url = own_url();
  const auto colon = url.rfind(':');
  const std::string other = "udpm://239.255.76.68" + url.substr(colon);
  LcmListener ours(url), theirs(other);
  ours.listen("a");
  theirs.publish("a", bytes_of("to another group"));
  ours.publish("a", bytes_of("to this group"));
  const auto first = ours.next(60s);
  ASSERT_TRUE(first);
  EXPECT_EQ(text_of(first->payload), "to this group");
}

TEST(UdpReceiver, ThreeSendersLargeMessagesComeWholeAndApart) {
  if (!lcm_test::has_large_receive_buffers()) GTEST_SKIP() << "needs sysctl -w net.core.rmem_max=4194304";
  LcmListener listener(own_url());
  listener.listen("image");
  std::vector<std::thread> senders;
  for (int i = 0; i < 3; ++i)
    senders.emplace_back([i] {
      LcmListener sender(own_url());
      for (int k = 0; k < 5; ++k)
        sender.publish("image", sim::Bytes(150'000 + static_cast<std::size_t>(i), static_cast<std::byte>(i)));
    });
  for (std::thread& sender : senders) sender.join();
  std::array<int, 3> received{};
  for (int k = 0; k < 15; ++k) {
    const auto message = listener.next(60s);
    ASSERT_TRUE(message) << k;
    const auto from = static_cast<std::size_t>(message->payload[0]);
    ASSERT_LT(from, 3u);
    EXPECT_EQ(message->payload, sim::Bytes(150'000 + from, static_cast<std::byte>(from)));
    ++received[from];
  }
  EXPECT_EQ(received, (std::array<int, 3>{5, 5, 5}));
}

/// Bytes that the kernel keeps for the UDP sockets of a port.
std::uint64_t kernel_bytes(int port) {
  std::ifstream sockets("/proc/net/udp");
  std::string line;
  std::getline(sockets, line);  // names of the columns
  std::uint64_t bytes = 0;
  while (std::getline(sockets, line)) {
    unsigned local_port = 0;
    unsigned long waiting = 0;
    if (std::sscanf(line.c_str(), " %*d: %*8x:%4x %*8x:%*4x %*2x %*8x:%8lx", &local_port, &waiting) == 2 &&
        static_cast<int>(local_port) == port)
      bytes += waiting;
  }
  return bytes;
}

TEST(UdpReceiver, WhatComesWhileTheProgramComputesIsNotLost) {
  if (!lcm_test::has_large_receive_buffers()) GTEST_SKIP() << "needs sysctl -w net.core.rmem_max=4194304";
  LcmListener listener(own_url());
  listener.listen("image");
  LcmListener sender(own_url());
  // Ten times what the kernel keeps; no one calls next() meanwhile.  The sender waits only while the kernel has so much
  // that more would be lost before any thread could take it.
  const int port = lcm_endpoint(resolve_lcm_url(own_url())).port;
  for (int i = 0; i < 400; ++i) {
    sender.publish("image", sim::Bytes(100'000, static_cast<std::byte>(i)));
    ASSERT_TRUE(lcm_test::await([&] { return kernel_bytes(port) < 1'000'000; })) << i;
  }
  for (int i = 0; i < 400; ++i) {
    const auto message = listener.next(60s);
    ASSERT_TRUE(message) << i;
    EXPECT_EQ(message->payload[0], static_cast<std::byte>(i));
  }
}

}  // namespace
