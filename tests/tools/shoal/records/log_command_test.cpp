// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"
#include "tests/viewer/server/log_page.hpp"

namespace {

using testing::HasSubstr;

TEST(LogCommand, NeedsAPart) {
  const test::Called called = test::call_shoal({"log"});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("needs a command"));
}

TEST(LogCommand, InfoListsTheChannelsOfALog) {
  const test::FallLog log;
  const test::Called called = test::call_shoal({"log", "info", log.path});
  EXPECT_EQ(called.exit_code, 0);
  EXPECT_THAT(called.out, testing::AllOf(HasSubstr("fall"), HasSubstr("sim.bodies"), HasSubstr("shoal.sim_bodies_t")));
}

TEST(LogCommand, InfoSaysWhatIsNoLog) {
  const test_support::ScratchFolder folder;
  const test::Called called = test::call_shoal({"log", "info", folder.file("missing.lcm")});
  EXPECT_EQ(called.exit_code, 4);
  EXPECT_THAT(called.err, HasSubstr(folder.file("missing.lcm")));
}

}  // namespace
