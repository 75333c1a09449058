// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>

#include "bridges/base/bus_error.hpp"
#include "bridges/bus/lcm_bus.hpp"
#include "bridges/bus/network_check.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "bridges/lockstep/control_guard.hpp"
#include "bridges/signing/signed_message.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/lcm/own_network.hpp"

namespace {

TEST(BusReach, IsAboveTheMachineWithATtlOrAServer) {
  for (const char* url : {"udpm://239.255.76.67:7667?ttl=0", "udpm://239.255.76.67:7667?recv_buf_size=100&ttl=0",
                          "udpm://:7667?", "udpm://:7667?ttl=00", "memq://"})
    EXPECT_FALSE(bridges::leaves_machine(bridges::resolve_lcm_url(url))) << url;
  for (const char* url : {"udpm://239.255.76.67:7667?ttl=1", "udpm://:7667?recv_buf_size=100&ttl=255",
                          "udpm://:7667?recv_buf_size=100,ttl=2", "tcpq://127.0.0.1:7700"})
    EXPECT_TRUE(bridges::leaves_machine(bridges::resolve_lcm_url(url))) << url;
}

using namespace bridges;

using lcm_test::own_url;

using Verdict = Finding::Verdict;

bool has_command(const Finding& finding, const std::string& command) {
  return std::find(finding.commands.begin(), finding.commands.end(), command) != finding.commands.end();
}

TEST(NetworkCheck, SaysWhenABusCanBeReachedFromOtherMachines) {
  const Finding own = check_reach(resolve_lcm_url(own_url(4)));
  EXPECT_EQ(own.verdict, Verdict::ok) << own.text;
  const Finding far = check_reach(resolve_lcm_url("udpm://239.255.76.67:7667?ttl=1"));
  EXPECT_EQ(far.verdict, Verdict::warning);
  EXPECT_NE(far.text.find("its ttl is above 0"), std::string::npos) << far.text;
  const Finding server = check_reach("tcpq://198.51.100.1:7700");
  EXPECT_EQ(server.verdict, Verdict::warning);
  EXPECT_NE(server.text.find("what reaches the server 198.51.100.1:7700"), std::string::npos) << server.text;
}

TEST(NetworkCheck, SaysWhenThePortOfAPrivateBusIsOpenToTheNetwork) {
  const std::string url = resolve_lcm_url(own_url(5));
  const int port = lcm_endpoint(url).port;
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  ASSERT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  const Finding open = check_reach(url);
  close(fd);
  EXPECT_EQ(open.verdict, Verdict::warning);
  EXPECT_NE(open.text.find("UDP port " + std::to_string(port) + " is open to the network: 1 socket takes"),
            std::string::npos)
      << open.text;
  EXPECT_TRUE(has_command(
      open, "iptables -I INPUT -p udp --dport " + std::to_string(port) + " -m addrtype ! --src-type LOCAL -j DROP"));
}

TEST(NetworkCheck, ReportsOpenSocketsFromThoseOfLoopbackAndMulticast) {
  // As the kernel writes them on a little-endian machine: 0.0.0.0, 127.0.0.1, 192.0.2.7, 239.255.76.67; port 7667.
  const std::string table =
      "  sl  local_address rem_address   st\n"
      "   1: 00000000:1DF3 00000000:0000 07\n   2: 0100007F:1DF3 00000000:0000 07\n"
      "   3: 070200C0:1DF3 00000000:0000 0A\n   4: 434CFFEF:1DF3 00000000:0000 07\n"
      "   5: 00000000:1DF4 00000000:0000 07\n";
  std::istringstream all(table), listening(table);
  EXPECT_EQ(open_sockets(all, 7667, false).everywhere, 1);
  EXPECT_EQ(open_sockets(listening, 7667, true).everywhere, 0);
  EXPECT_EQ(open_sockets(listening, 7667, true).elsewhere, 0);  // read to its end
  std::istringstream again(table);
  EXPECT_EQ(open_sockets(again, 7667, true).elsewhere, 1);
}

}  // namespace
