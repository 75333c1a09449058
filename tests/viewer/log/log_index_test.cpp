// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/log_index.hpp"

#include <gmock/gmock.h>

#include "bridges/base/bus_error.hpp"
#include "tests/viewer/server/log_page.hpp"
#include "viewer/server/log_view.hpp"

namespace {

using testing::HasSubstr;

TEST(LogIndex, KnowsTheSpanAndTheEventsOfALog) {
  const test::FallLog log;
  const viewer::LogIndex index(log.path);
  EXPECT_EQ(index.start_us(), 0);
  EXPECT_EQ(index.end_us(), 3'000'000);
  EXPECT_EQ(index.world(), "fall");
  ASSERT_GE(index.occasions().size(), 1u);
  EXPECT_EQ(index.occasions()[0].who, "half");
  EXPECT_NEAR(static_cast<double>(index.occasions()[0].time_us), 1e6, 1e4);
}

TEST(LogIndex, SaysWhatALogLacks) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("empty.lcm");
  { test::RecordedRun run("shoal: 1\n", path); }
  try {
    const viewer::LogIndex index(path);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("empty.lcm: has neither sim.scene nor sim.bodies"));
    EXPECT_THAT(error.what(), HasSubstr("`shoal view " + path + " --resimulate` re-simulates and shows its world"));
  }
}

}  // namespace
