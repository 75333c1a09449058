// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/range_beacon_t.hpp"
#include "tests/devices/sound_positioning/range_beacon_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace range_beacon_fixture;

using testing::ElementsAre;

TEST(RangeBeacon, TheMediumDecidesWhatIsReceived) {
  const auto received = [](const std::string& through, const std::string& medium) {
    test::TestWorld test("medium: " + medium + "\n" +
                         boxes(", beacons: [{name: wet, position_m: [0, 5, -1]}, {name: dry, position_m: [0, 5, 1]}]"
                               ", through: " +
                               through));
    test::Listener<shoal::range_beacon_t> reports(test, "r1.b");
    test.run_for(0.1);
    return reports.last().beacon;
  };
  const std::string above = "{water: {surface_m: -0.5}}", below = "{water: {surface_m: 0.5}}";
  EXPECT_THAT(received("radio", above), ElementsAre("dry"));
  EXPECT_THAT(received("radio", below), ElementsAre());
  EXPECT_THAT(received("acoustic", above), ElementsAre());
  EXPECT_THAT(received("acoustic", below), ElementsAre("wet"));
  EXPECT_THAT(received("any", below), ElementsAre("wet", "dry"));
  EXPECT_THAT(received("radio", "{}"), ElementsAre("wet", "dry"));
}

}  // namespace
