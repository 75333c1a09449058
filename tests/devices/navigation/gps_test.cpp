// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <sstream>

#include "shoal/gps_data_t.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"
#include "tests/fidelity/closed_forms.hpp"
#include "tests/fidelity/gps_points.hpp"

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

TEST(Gps, FindsEveryPointOfTheReference) {
  for (const test::GpsPoint& point : test::gps_points()) {
    std::ostringstream place, origin;
    place << "[" << point.p_W.x() << ", " << point.p_W.y() << ", " << point.p_W.z() << "]";
    origin.precision(12);
    origin << "origin: {latitude_deg: " << point.origin.latitude_deg
           << ", longitude_deg: " << point.origin.longitude_deg << ", height_m: " << point.origin.height_m << "}\n";
    const auto fix = test::first_report<shoal::gps_data_t>(
        test::marine_world("type: gps", place.str(), "[]", "", "{}") + origin.str());
    EXPECT_NEAR(fix.latitude, point.position.latitude_deg, 1e-8) << origin.str() << place.str();
    EXPECT_NEAR(fix.longitude, point.position.longitude_deg, 1e-8) << origin.str() << place.str();
    EXPECT_NEAR(fix.elev, point.position.height_m, 1e-3) << origin.str() << place.str();
  }
}

/// A weightless box with a perfect receiver at a place, in a world whose origin is at 60 degrees north.
std::string far_box(const std::string& place) {
  return test::marine_world("type: gps", place, "[]", "", "{}") + "origin: {latitude_deg: 60, longitude_deg: 10}\n";
}

TEST(Gps, TheCourseIsFromTheMeridianOfItsPlace) {
  // 30 km to the east the meridian has turned by the convergence: the longitude that lies between, 30 km / (N cos 60
  // deg) with N = 6 394 209 m, times sin(60 deg) = 0.4656 deg.
  test::TestWorld test(far_box("[30000, 0, 100]"));
  test::Listener<shoal::gps_data_t> fixes(test, "r1.s");
  test::set_velocity(test, {0, 2, 0});  // north of the origin
  test.run_for(0.1);
  const auto fix = fixes.last();
  EXPECT_NEAR(fix.heading, sim::degrees_to_radians(0.4656), sim::degrees_to_radians(0.001));
  EXPECT_NEAR(fix.speed, 2, 1e-4);  // the vertical has turned by 0.27 deg: 2 (1 - cos)
  test::set_velocity(test, {2, 0, 0});
  test.run_for(0.1);
  EXPECT_NEAR(fixes.last().heading, sim::degrees_to_radians(90.4656), sim::degrees_to_radians(0.001));
}

TEST(Gps, HoldsTheLastCourseAtRest) {
  // In 0.1 m to the west the meridian turns by 3e-8 rad.
  test::TestWorld test(far_box("[0, 0, 100]"));
  test::Listener<shoal::gps_data_t> fixes(test, "r1.s"), truths(test, "r1.s.truth");
  test::set_velocity(test, {-1, 1, 0});
  test.run_for(0.1);
  EXPECT_NEAR(fixes.last().heading, sim::degrees_to_radians(-45), 1e-6);
  for (const sim::Vector3d& slow_mps :
       {sim::Vector3d(0, 0, 0), sim::Vector3d(7e-18, 0, 0), sim::Vector3d(9e-4, 0, 0)}) {
    test::set_velocity(test, slow_mps);
    test.run_for(0.1);
    EXPECT_NEAR(fixes.last().heading, sim::degrees_to_radians(-45), 1e-6);
    EXPECT_NEAR(truths.last().heading, sim::degrees_to_radians(-45), 1e-6);
  }
  test::set_velocity(test, {2e-3, 0, 0});
  test.run_for(0.1);
  EXPECT_NEAR(fixes.last().heading, sim::degrees_to_radians(90), 1e-6);
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

TEST(Gps, IsLostWhileAWaveIsOverIt) {
  // 0.2 m over still water, in waves 0.5 m high above it: under water while cos(wt) > 0.4.
  test::TestWorld test(test::held_in_place(test::marine_world(
      "type: gps", "[0, 0, 0.2]", "[]", "", "{water: {}, waves: {type: regular, height_m: 1, period_s: 5}}")));
  test::Listener<shoal::gps_data_t> fixes(test, "r1.s");
  test.run_for(50);
  int without = 0, changes = 0, last = -1;
  const auto all = fixes.take_all();
  for (const auto& fix : all) {
    without += fix.gps_lock == 0;
    changes += last >= 0 && (fix.gps_lock == 0) != (last == 0);
    last = fix.gps_lock;
  }
  // Ten waves, two changes each.  Each change is a sample of 100 in a second early or late.
  EXPECT_EQ(changes, 20);
  EXPECT_NEAR(without / static_cast<double>(all.size()), std::acos(0.4) / std::numbers::pi, 20.0 / 5000);
}

TEST(Gps, ErrorsWanderAsTheReferenceSays) {
  const auto drive = test::closed_form("gps_gauss_markov", "sigma=2.5;tau=300", "discrete_drive_std");
  const auto covariance = test::closed_form("gps_gauss_markov", "sigma=2.5;tau=300", "autocovariance");
  const std::string noise = "{gauss_markov_std: " + std::to_string(drive.at("sigma")) +
                            ", gauss_markov_time_s: " + std::to_string(drive.at("tau")) + "}";
  test::TestWorld test(test::box_world(
      "        - {name: gps, type: gps, rate_hz: 1, horizontal_noise: " + noise + ", vertical_noise: " + noise + "}\n",
      "{step_s: 0.1, gravity_mps2: 0}", "run: {seed: 5}\n"));
  test::Listener<shoal::gps_data_t> fixes(test, "r1.gps");
  test.run_for(90000);
  const auto all = fixes.take_all();
  const auto lag = static_cast<std::size_t>(covariance.at("lag"));
  const double kept = std::exp(-drive.at("dt") / drive.at("tau"));
  double squares = 0, products = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t k = 0; k + lag < all.size(); ++k) {
      squares += std::pow(all[k + 1].xyz_pos[axis] - kept * all[k].xyz_pos[axis], 2);
      products += all[k].xyz_pos[axis] * all[k + lag].xyz_pos[axis];
    }
  const double count = 3.0 * static_cast<double>(all.size() - lag);
  // The mean of products over 3 x 300 correlation times has a standard error of sqrt(2 / 900) = 5 %; the row allows 15.
  test::expect_closed_form(products / count, covariance);
  EXPECT_NEAR(std::sqrt(squares / count), drive.expected, 4 * drive.expected / std::sqrt(2 * count));
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
