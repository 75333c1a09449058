// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/network_check.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "bridges/bus/lcm_bus.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/lcm/own_network.hpp"

namespace {

using namespace bridges;

using lcm_test::in_own_network;
using lcm_test::not_permitted;
using lcm_test::own_url;

using Verdict = Finding::Verdict;

const Finding& named(const std::vector<Finding>& findings, const std::string& name) {
  const auto found = std::find_if(findings.begin(), findings.end(), [&](const Finding& f) { return f.name == name; });
  if (found == findings.end()) throw std::runtime_error("no finding '" + name + "'");
  return *found;
}

bool has_command(const Finding& finding, const std::string& command) {
  return std::find(finding.commands.begin(), finding.commands.end(), command) != finding.commands.end();
}

TEST(NetworkCheck, FindsNothingWrongWhereTheTestsRun) {
  const auto findings = check_network(own_url(2));
  EXPECT_EQ(named(findings, "LCM URL").verdict, Verdict::ok);
  EXPECT_NE(named(findings, "multicast route").verdict, Verdict::bad);
  EXPECT_EQ(named(findings, "round trip").verdict, Verdict::ok) << named(findings, "round trip").text;
}

TEST(NetworkCheck, MemqNeedsNoNetwork) {
  const auto findings = check_network("memq://");
  EXPECT_EQ(findings.size(), 2u);
  EXPECT_EQ(named(findings, "round trip").verdict, Verdict::ok) << named(findings, "round trip").text;
}

TEST(NetworkCheck, ReportsABadUrlAndAMissingServer) {
  EXPECT_EQ(check_network("udpm://10.0.0.1:7667").back().verdict, Verdict::bad);
  EXPECT_EQ(named(check_network("tcpq://127.0.0.1:9"), "round trip").verdict, Verdict::bad);
}

TEST(NetworkCheck, NamesWhoElseUsesThePort) {
  // Another process: our own sockets are known to us.
  const std::string url = own_url(3);
  std::array<int, 2> ready{};
  ASSERT_EQ(pipe(ready.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    const int fd = socket(AF_INET, SOCK_DGRAM, 0);
    const int one = 1;
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &one, sizeof(one));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(lcm_endpoint(url).port));
    const bool bound = bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
    if (write(ready[1], bound ? "y" : "n", 1) == 1) pause();
    _exit(0);
  }
  char answer = 0;
  ASSERT_EQ(read(ready[0], &answer, 1), 1);
  ASSERT_EQ(answer, 'y');
  const auto findings = check_network(url);
  const Finding& port = named(findings, "UDP port " + std::to_string(lcm_endpoint(url).port));
  EXPECT_NE(port.text.find("(" + std::to_string(child) + ")"), std::string::npos) << port.text;
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  close(ready[0]);
  close(ready[1]);
}

TEST(NetworkCheck, SaysHowToMendANetworkWithoutRoute) {
  const int result = in_own_network([] {
    const auto findings = check_network("udpm://239.255.76.67:7667");
    const Finding& route = named(findings, "multicast route");
    return route.verdict == Verdict::bad && has_command(route, "ip link set lo up") &&
           has_command(route, "ip link set lo multicast on") && has_command(route, "ip route add 224.0.0.0/4 dev lo") &&
           named(findings, "round trip").verdict == Verdict::bad;
  });
  if (result == not_permitted) GTEST_SKIP() << "user and network namespaces are not permitted here";
  EXPECT_EQ(result, 0);
}

TEST(NetworkCheck, TheCommandsItNamesMendTheNetwork) {
  const int result = in_own_network([] {
    const auto before = check_network("udpm://239.255.76.67:7667");
    for (const std::string& command : named(before, "multicast route").commands)
      if (std::system(command.c_str()) != 0) return false;
    const auto after = check_network("udpm://239.255.76.67:7667");
    return named(after, "multicast route").verdict == Verdict::ok && named(after, "round trip").verdict == Verdict::ok;
  });
  if (result == not_permitted) GTEST_SKIP() << "user and network namespaces are not permitted here";
  EXPECT_EQ(result, 0);
}

TEST(LcmBus, SaysWhatIsWrongWithoutARoute) {
  const int result = in_own_network([] {
    try {
      LcmBus bus("udpm://239.255.76.67:7667");
    } catch (const BusError& error) {
      return std::string(error.what()).find("run `shoal doctor`") != std::string::npos;
    }
    return false;
  });
  if (result == not_permitted) GTEST_SKIP() << "user and network namespaces are not permitted here";
  EXPECT_EQ(result, 0);
}

}  // namespace
