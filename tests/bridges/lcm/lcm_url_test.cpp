// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/lcm_url.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/lcm/lcm_listener.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace bridges;
using namespace std::chrono_literals;

class Environment {
 public:
  explicit Environment(const char* url) { setenv("LCM_DEFAULT_URL", url, 1); }
  ~Environment() { unsetenv("LCM_DEFAULT_URL"); }
};

std::string url_error(const std::string& url) {
  try {
    return "no error, " + resolve_lcm_url(url);
  } catch (const BusError& error) {
    return error.what();
  }
}

TEST(LcmUrl, HasTheLargeBufferUnlessTheUserChoseOne) {
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(resolve_lcm_url(""), "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304");
  EXPECT_EQ(resolve_lcm_url("udpm://"), "udpm://239.255.76.67:7667?recv_buf_size=4194304");
  EXPECT_EQ(resolve_lcm_url("udpm://:7668?ttl=1"), "udpm://239.255.76.67:7668?ttl=1&recv_buf_size=4194304");
  EXPECT_EQ(resolve_lcm_url("udpm://239.1.1.1:7668?recv_buf_size=100"), "udpm://239.1.1.1:7668?recv_buf_size=100");
  EXPECT_EQ(resolve_lcm_url("memq://"), "memq://");
  const Environment environment("udpm://239.255.76.67:7700?ttl=0");
  EXPECT_EQ(resolve_lcm_url(""), "udpm://239.255.76.67:7700?ttl=0&recv_buf_size=4194304");
  EXPECT_EQ(resolve_lcm_url("memq://"), "memq://");
}

TEST(LcmUrl, ErrorsSayWhatIsWrong) {
  EXPECT_EQ(url_error("7667"), "LCM URL '7667': must look like udpm://239.255.76.67:7667?ttl=0");
  EXPECT_EQ(url_error("upd://"), "LCM URL 'upd://': unknown kind 'upd'; known kinds: memq, tcpq, udpm");
  EXPECT_EQ(url_error("mpudpm://"),
            "LCM URL 'mpudpm://': mpudpm is not supported: a single datagram from any sender can crash liblcm's "
            "receiver; use "
            "udpm or tcpq");
  EXPECT_EQ(url_error("udpm://10.0.0.1:7667"),
            "LCM URL 'udpm://10.0.0.1:7667': '10.0.0.1' is not a multicast address (224.0.0.0 to 239.255.255.255)");
  EXPECT_EQ(url_error("udpm://239.1.1.1:70000"),
            "LCM URL 'udpm://239.1.1.1:70000': the port must be 1 to 65535, got '70000'");
  EXPECT_EQ(url_error("udpm://?tll=1"),
            "LCM URL 'udpm://?tll=1': unknown option 'tll'; known options: recv_buf_size, ttl");
  EXPECT_EQ(url_error("udpm://?ttl=0&ttl=1"), "LCM URL 'udpm://?ttl=0&ttl=1': option 'ttl' is given twice");
  EXPECT_EQ(url_error("udpm://?ttl=x"), "LCM URL 'udpm://?ttl=x': ttl must be 0 to 255, got 'x'");
}

TEST(LcmUrl, NoTcpServerIsSaidAtOnce) {
  try {
    LcmBus bus("tcpq://127.0.0.1:9");
    FAIL();
  } catch (const BusError& error) {
    EXPECT_NE(std::string(error.what()).find("no LCM server at 127.0.0.1:9"), std::string::npos) << error.what();
  }
}

}  // namespace
