// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/poll_set.hpp"

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <future>

#include "bridges/bus/arrivals.hpp"
#include "bridges/bus/lcm_bus.hpp"
#include "tests/bridges/bus/arrivals_fixture.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace arrivals_fixture;
using namespace bridges;
using namespace std::chrono_literals;

TEST(PollSet, WakesWhoeverWaitsOfTwoThatHoldOneDescriptor) {
  for (const bool first_waits : {true, false}) {
    PollSet first, second;
    Bell bell;
    int tag = 0;
    first.add(bell.fd(), &tag);
    second.add(bell.fd(), &tag);
    auto woken = std::async(std::launch::async, [&] { return (first_waits ? first : second).wait(-1ms); });
    bell.ring();
    const PollSet::Readable readable = woken.get();
    ASSERT_EQ(readable.count, 1u);
    EXPECT_EQ(readable.tags[0], &tag);
  }
}

TEST(PollSet, ForgetsWhatIsRemoved) {
  PollSet set;
  Bell bell;
  set.add(bell.fd(), nullptr);
  set.remove(bell.fd());
  bell.ring();
  EXPECT_EQ(set.wait(0ms).count, 0u);
}

}  // namespace
