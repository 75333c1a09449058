// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/sim/director/event_worlds.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using namespace event_worlds;

TEST(LogAction, WritesItsLineWithTheNameOfTheEvent) {
  test::TestWorld test(event_world("  - {name: bell, at: 0.1, do: [{log: it rings}]}\n"));
  const test_support::LogCapture log;
  test.run_for(0.1);
  EXPECT_EQ(log.text(), "");
  test.run_for(0.1);
  EXPECT_THAT(log.text(), testing::AllOf(testing::HasSubstr("bell"), testing::HasSubstr("it rings")));
}

TEST(LogAction, NeedsAText) {
  EXPECT_THAT(test::error_of_world(event_world("  - {name: bell, at: 0, do: [{log: {}}]}\n")),
              testing::HasSubstr("'text'"));
}

}  // namespace
