#include "shoal/gps_data_t.hpp"
#include "tests/devices/immersed_sensor_fixture.hpp"

namespace {

std::string gps(const std::string& more = "") {
  return "        - {name: gps, type: gps, position_m: [0, 0, -0.1], rate_hz: 1, truth: true" + more + "}\n";
}

TEST(Gps, PlacesTheVehicleOnTheEarthAsTheReferenceSays) {
  // Reference gps_points.csv, charles_river, east 250 m north -400 m up 5 m: made with GeographicLib's tools and
  // confirmed by independent WGS84 formulas.
  test::TestWorld test(test::rover_world(gps(), "", "    position_m: [250, -400, 5]\n") +
                       "\norigin: {latitude_deg: 42.3584, longitude_deg: -71.0876, height_m: 0}\n"
                       "run: {seed: 3}\n");
  test::Listener<shoal::gps_data_t> fixes(test, "r1.gps");
  // The rover falls; the first fix within the first second gives its height then.
  test.run_for(1);
  const auto fix = fixes.last();
  EXPECT_EQ(fix.gps_lock, 1);
  EXPECT_NEAR(fix.xyz_pos[0], 250, 1e-3);
  EXPECT_NEAR(fix.latitude, 42.35479896130, 1e-8);
  EXPECT_NEAR(fix.longitude, -71.08456561422, 1e-8);
  EXPECT_NEAR(fix.elev, 5.017462 + (fix.xyz_pos[2] - 5), 1e-3);
}

TEST(Gps, HasNoFixBelowItsLeastHeight) {
  test::TestWorld test(test::rover_world(gps(", min_height_m: 1")));
  test::Listener<shoal::gps_data_t> fixes(test, "r1.gps");
  test.run_for(2);
  const auto fix = fixes.last();
  EXPECT_EQ(fix.gps_lock, 0);
  EXPECT_EQ(fix.numSatellites, 0);
  EXPECT_TRUE(std::isnan(fix.latitude));
}

TEST(Gps, IsLostUnderWaterAndComesBackAfterItsTime) {
  test::TestWorld test(test::marine_world("type: gps, reacquisition_s: 0.5", "[0, 0, -0.25]"));
  test::Listener<shoal::gps_data_t> fixes(test, "r1.s");
  test::set_velocity(test, {0, 0, 1});  // out of the water after 0.25 s
  test.run_for(1.5);
  int without = 0, with = 0;
  for (const auto& fix : fixes.take_all()) {
    fix.gps_lock == 0 ? ++without : ++with;
    EXPECT_EQ(std::isnan(fix.latitude), fix.gps_lock == 0);
  }
  // 25 or 26 samples under water and 50 after the last of them; none is lost again.
  EXPECT_NEAR(without, 75, 1.5);
  EXPECT_NEAR(with, 75, 1.5);
}

TEST(Gps, ErrorsHaveTheSpreadAskedForAndTheTruthHasNone) {
  test::TestWorld test(test::rover_world(
      "        - {name: gps, type: gps, rate_hz: 100, truth: true, horizontal_noise: {gaussian_std: 1.5}}\n"));
  test::Listener<shoal::gps_data_t> fixes(test, "r1.gps");
  test::Listener<shoal::gps_data_t> truths(test, "r1.gps.truth");
  test.run_for(20);
  double squares = 0;
  const auto all = fixes.take_all();
  for (const auto& fix : all) squares += fix.xyz_pos[0] * fix.xyz_pos[0];
  const auto count = static_cast<double>(all.size());
  EXPECT_NEAR(std::sqrt(squares / count), 1.5, 4 * 1.5 / std::sqrt(2 * count));
  EXPECT_NEAR(truths.last().xyz_pos[0], 0, 1e-6);
  EXPECT_DOUBLE_EQ(all.back().horizontal_accuracy, 1.5);
}

}  // namespace
