// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/range_beacon.hpp"

#include <gmock/gmock.h>

#include "shoal/range_beacon_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/sound_positioning/range_beacon_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace range_beacon_fixture;

using testing::ElementsAre;

std::string other(const std::string& name, const std::string& position_m, const std::string& more = "") {
  return "  - {name: " + name + ", position_m: " + position_m +
         ", model: {shoal: 1, vehicle: box, bodies: [{name: hull, parts: [{shape: box, size_m: [0.2, 0.2, 0.2], "
         "mass_kg: 1}]}], devices: [{name: b, type: range_beacon, beacon_only: true" +
         more + "}]}}\n";
}

const char* wall = "{name: wall, fixed: true, position_m: [2, 0, 0], parts: [{shape: box, size_m: [0.1, 2, 2]}]}";

TEST(RangeBeacon, MeasuresRangeAndDirectionByThe345Triangle) {
  test::TestWorld test(
      boxes(", bearing: true, elevation: true, beacons: [{name: buoy, position_m: "
            "[0, -6, 8]}]",
            other("r2", "[3, 4, 0]")));
  test::Listener<shoal::range_beacon_t> reports(test, "r1.b");
  test::Listener<shoal::range_beacon_t> silence(test, "r2.b");
  test.run_for(0.5);
  const auto report = reports.last();
  ASSERT_THAT(report.beacon, ElementsAre("buoy", "r2/b"));
  EXPECT_NEAR(report.range_m[0], 10, 1e-9);
  EXPECT_NEAR(report.bearing_rad[0], -std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(report.elevation_rad[0], std::atan2(8, 6), 1e-9);
  EXPECT_NEAR(report.range_m[1], 5, 1e-9);
  EXPECT_NEAR(report.bearing_rad[1], std::atan2(4, 3), 1e-9);
  EXPECT_NEAR(report.elevation_rad[1], 0, 1e-9);
  EXPECT_TRUE(silence.take_all().empty());  // r2 only answers
}

TEST(RangeBeacon, WithoutDirectionsTheyAreNan) {
  test::TestWorld test(boxes("", other("r2", "[3, 4, 0]")));
  test::Listener<shoal::range_beacon_t> reports(test, "r1.b");
  test.run_for(0.5);
  const auto report = reports.last();
  ASSERT_EQ(report.count, 1);
  EXPECT_TRUE(std::isnan(report.bearing_rad[0]));
  EXPECT_TRUE(std::isnan(report.elevation_rad[0]));
}

TEST(RangeBeacon, ReceivesItsNetworkWithinItsRangeOnly) {
  test::TestWorld test(boxes(", range_max_m: 6", other("near", "[3, 4, 0]") + other("far", "[0, 6.1, 0]") +
                                                     other("strange", "[0, 1, 0]", ", network: other")));
  test::Listener<shoal::range_beacon_t> reports(test, "r1.b");
  test.run_for(0.5);
  EXPECT_THAT(reports.last().beacon, ElementsAre("near/b"));
}

TEST(RangeBeacon, AWallHidesWhatIsBehindIt) {
  const std::string others = other("r2", "[4, 0, 0]") + other("r3", "[0, 4, 0]");
  const std::string fixed = ", beacons: [{name: on_wall, position_m: [1.95, 0.5, 0]}]";
  test::TestWorld test(boxes(fixed, others, wall));
  test::Listener<shoal::range_beacon_t> reports(test, "r1.b");
  test.run_for(0.5);
  EXPECT_THAT(reports.last().beacon, ElementsAre("on_wall", "r3/b"));
  test::TestWorld through(boxes(fixed + ", occlusion: false", others, wall));
  test::Listener<shoal::range_beacon_t> all(through, "r1.b");
  through.run_for(0.5);
  EXPECT_THAT(all.last().beacon, ElementsAre("on_wall", "r2/b", "r3/b"));
}

TEST(RangeBeacon, BeaconsComeAndGoWithTheirVehicles) {
  test::TestWorld test(boxes("", other("r2", "[3, 4, 0]") + other("r3", "[0, 2, 0]")));
  test::Listener<shoal::range_beacon_t> reports(test, "r1.b");
  test.run_for(0.5);
  EXPECT_THAT(reports.last().beacon, ElementsAre("r2/b", "r3/b"));
  sim::VehicleInstance again = test.loaded.config.vehicles[1];
  test.world.editor().remove_vehicle("r2");
  test.run_for(0.5);
  EXPECT_THAT(reports.last().beacon, ElementsAre("r3/b"));
  test.world.editor().add_vehicle(again);
  test.run_for(0.5);
  EXPECT_THAT(reports.last().beacon, ElementsAre("r3/b", "r2/b"));
  test.world.editor().remove_vehicle("r1");  // the one that measures
  test.run_for(0.5);
}

TEST(RangeBeacon, ASilentBeaconDoesNotAnswer) {
  test::TestWorld test(boxes("", other("r2", "[3, 4, 0]")));
  test::Listener<shoal::range_beacon_t> reports(test, "r1.b");
  test.world.editor().set_fault("r2/b", {});  // silent
  test.run_for(0.5);
  EXPECT_EQ(reports.last().count, 0);
  test.world.editor().clear_faults("r2/b");
  test.run_for(0.5);
  EXPECT_EQ(reports.last().count, 1);
}

TEST(RangeBeacon, ErrorsHaveTheSpreadAskedForAndTheTruthHasNone) {
  test::TestWorld test(
      boxes(", bearing: true, range_noise: {gaussian_std: 0.1}, bearing_noise: "
            "{gaussian_std: 0.02}",
            other("r2", "[3, 4, 0]")));
  test::Listener<shoal::range_beacon_t> reports(test, "r1.b");
  test::Listener<shoal::range_beacon_t> truths(test, "r1.b.truth");
  test.run_for(20);
  double mean = 0, range = 0, bearing = 0;
  const auto all = reports.take_all();
  const auto n = static_cast<double>(all.size());
  for (const auto& report : all) {
    mean += report.range_m.at(0) / n;
    range += std::pow(report.range_m.at(0) - 5, 2) / n;
    bearing += std::pow(report.bearing_rad.at(0) - std::atan2(4, 3), 2) / n;
  }
  EXPECT_NEAR(mean, 5, 4 * 0.1 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(range), 0.1, 4 * 0.1 / std::sqrt(2 * n));
  EXPECT_NEAR(std::sqrt(bearing), 0.02, 4 * 0.02 / std::sqrt(2 * n));
  EXPECT_NEAR(truths.last().range_m.at(0), 5, 1e-9);
}

TEST(RangeBeacon, MissesTheShareAskedFor) {
  test::TestWorld test(boxes(", beacon_dropout: 0.3", other("r2", "[3, 4, 0]") + other("r3", "[0, 3, 0]")));
  test::Listener<shoal::range_beacon_t> reports(test, "r1.b");
  test.run_for(20);
  const auto all = reports.take_all();
  const double n = 2.0 * static_cast<double>(all.size());
  double received = 0;
  for (const auto& report : all) received += report.count;
  EXPECT_NEAR(received / n, 0.7, 4 * std::sqrt(0.3 * 0.7 / n));
}

TEST(RangeBeacon, RefusesTwoBeaconsOfOneName) {
  try {
    test::TestWorld test(boxes(", beacons: [{name: a, position_m: [1, 0, 0]}, {name: a, position_m: [2, 0, 0]}]"));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("duplicate beacon 'a'"));
  }
}

}  // namespace
