// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/gps_data_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using testing::ElementsAre;

TEST(Events, SetFaultsAndClearThem) {
  test::TestWorld test(test::rover_world("        - {name: gps, type: gps, rate_hz: 10, phase_s: 0.05}\n") +
                       "events:\n  - {name: a, at: 1, do: [{fault: {device: r1/gps, kind: silent}}]}\n"
                       "  - {name: b, at: 2, do: [{clear_fault: r1/gps}]}\n");
  test::Listener<shoal::gps_data_t> fixes(test, "r1.gps");
  std::vector<std::size_t> counts;
  for (int i = 0; i < 3; ++i) {
    test.run_for(1);
    counts.push_back(fixes.take_all().size());
  }
  EXPECT_THAT(counts, ElementsAre(10, 0, 10));
}

}  // namespace
