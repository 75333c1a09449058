// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/bus_reach.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "bridges/base/bus_error.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "bridges/lockstep/control_guard.hpp"
#include "bridges/signing/signed_message.hpp"

namespace {

TEST(BusReach, IsAboveTheMachineWithATtlOrAServer) {
  for (const char* url : {"udpm://239.255.76.67:7667?ttl=0", "udpm://239.255.76.67:7667?recv_buf_size=100&ttl=0",
                          "udpm://:7667?", "udpm://:7667?ttl=00", "memq://"})
    EXPECT_FALSE(bridges::leaves_machine(bridges::resolve_lcm_url(url))) << url;
  for (const char* url : {"udpm://239.255.76.67:7667?ttl=1", "udpm://:7667?recv_buf_size=100&ttl=255",
                          "udpm://:7667?recv_buf_size=100,ttl=2", "tcpq://127.0.0.1:7700"})
    EXPECT_TRUE(bridges::leaves_machine(bridges::resolve_lcm_url(url))) << url;
}

}  // namespace
