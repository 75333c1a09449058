// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/lbl_t.hpp"
#include "tests/devices/sound_positioning/lbl_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace lbl_fixture;

using shoal::lbl_t;

TEST(Lbl, ReportsAsSoonAsAllHaveAnsweredAndPingsAgainAfterItsPeriod) {
  test::TestWorld test(lbl_world(", ping_period_s: 2", mooring("a", "[750, 0, -10]", ", turnaround_s: 0.1")));
  test::Listener<lbl_t> reports(test, "r1.s");
  test.run_for(3.5);
  const auto all = reports.take_all();
  ASSERT_EQ(all.size(), 2u);
  // Ping at 10 ms, 0.5 s there, turnaround, 0.5 s back, 10 ms of answer: at a sample of 10 ms.
  EXPECT_EQ(all[0].utime - test.world.epoch_us(), 1'120'000);
  EXPECT_EQ(all[1].utime - all[0].utime, 2'000'000);
}

}  // namespace
