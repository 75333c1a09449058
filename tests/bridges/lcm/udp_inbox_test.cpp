// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/udp_inbox.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

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
