// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

TEST(DescribeCommand, KnowsDevicesMessagesAndFiles) {
  EXPECT_THAT(test::call_shoal({"describe", "lidar"}).out, HasSubstr("range_max_m"));
  EXPECT_THAT(test::call_shoal({"describe", "shoal.twist_command_t"}).out, HasSubstr("forward_mps"));
  EXPECT_THAT(test::call_shoal({"describe", "world"}).out, HasSubstr("vehicles"));
}

TEST(DescribeCommand, SaysWhatANameMayHaveMeant) {
  const test::Called called = test::call_shoal({"describe", "lidr"});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, testing::AllOf(HasSubstr("lidr"), HasSubstr("did you mean 'lidar'?")));
}

}  // namespace
