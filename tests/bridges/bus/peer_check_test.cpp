// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <thread>

#include "bridges/bus/network_check.hpp"
#include "bridges/lcm/tcpq_server.hpp"

// Two machines are in tests/system/two_machines_test.cpp; here the other one is this one.

namespace {

using namespace bridges;
using testing::HasSubstr;
using testing::StartsWith;
using Verdict = Finding::Verdict;
constexpr std::chrono::milliseconds limit{2000};

TEST(PeerCheck, AHostThatIsNotKnownIsNamed) {
  const auto findings = check_peer("no-such-host.invalid", "memq://", limit);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].verdict, Verdict::bad);
  EXPECT_THAT(findings[0].text, StartsWith("'no-such-host.invalid' is not known here: "));
}

TEST(PeerCheck, AServerThatPassesMessagesOnConnects) {
  TcpqServer::Options options;
  options.port = 0;
  TcpqServer server(options, [](const std::string&) {});
  std::thread serves([&] { server.run(); });
  const auto findings = check_peer("127.0.0.1", "tcpq://127.0.0.1:" + std::to_string(server.port()), limit);
  server.stop();
  serves.join();
  ASSERT_EQ(findings.size(), 4u);
  for (const Finding& each : findings) EXPECT_EQ(each.verdict, Verdict::ok) << each.text;
  EXPECT_THAT(findings[2].text, HasSubstr(" passes messages on, round trip "));
}

TEST(PeerCheck, AMissingServerHasItsCommandAndABusWithinTheMachineConnectsNothing) {
  const auto findings = check_peer("127.0.0.1", "tcpq://127.0.0.1:9", limit);
  ASSERT_EQ(findings.size(), 4u);
  EXPECT_EQ(findings[2].text,
            "none at 127.0.0.1:9 (Connection refused); start one there: shoal tcpq --host 127.0.0.1 --port 9");
  EXPECT_EQ(findings.back().verdict, Verdict::bad);
  EXPECT_EQ(findings.back().text, "no bus reaches 127.0.0.1");
}

}  // namespace
