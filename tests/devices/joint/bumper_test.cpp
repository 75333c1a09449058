// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/bumper.hpp"

#include <gmock/gmock.h>

#include "shoal/bumper_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// A sled of 10 kg that slides without friction at what it is commanded, with a bumper in front (x = 0.25 to 0.3), and
/// a wall at x = 1.
std::string sled_world(const std::string& bumper, const std::string& objects = "") {
  return R"(
shoal: 1
physics: {step_s: 0.001}
materials: [{name: slick}]
contacts: [{between: [slick, any], friction: 0}]
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
  - {name: wall, fixed: true, position_m: [1.1, 0, 0.5], parts: [{shape: box, size_m: [0.2, 2, 1], material: slick}]}
)" + objects +
         R"(
vehicles:
  - name: s1
    model:
      shoal: 1
      vehicle: sled
      bodies:
        - name: base
          position_m: [0, 0, 0.1]
          parts:
            - {name: hull, shape: box, size_m: [0.5, 0.4, 0.2], mass_kg: 9, material: slick}
            - {name: front, shape: box, size_m: [0.05, 0.3, 0.1], position_m: [0.275, 0, 0], mass_kg: 1, material: slick}
      devices:
        - {name: bumper, type: bumper)" +
         bumper + "}\n";
}

/// Slides on, pressed forward with a force.
void press_for(test::TestWorld& test, double force_N, int steps) {
  auto& base = test.world.find_vehicle("s1")->body("base");
  for (int i = 0; i < steps; ++i) {
    base.add_force_W({force_N, 0, 0}, base.X_WB().translation());
    test.world.step();
  }
}

void push(test::TestWorld& test, double speed_mps) {
  test.world.find_vehicle("s1")->body("base").set_velocity_W({speed_mps, 0, 0}, sim::Vector3d::Zero());
}

TEST(Bumper, SaysAtOnceWhenATouchBeginsAndWhenItEnds) {
  test::TestWorld test(sled_world(", parts: [base/front]"));
  test::Listener<shoal::bumper_t> reports(test, "s1.bumper");
  test.run_for(0.5);
  auto all = reports.take_all();
  ASSERT_EQ(all.size(), 1u);  // how it is at the first sample
  EXPECT_EQ(all[0].touching, 0);
  push(test, 0.5);
  test.run_for(1.399);
  press_for(test, 5, 600);  // so that it does not come off again
  all = reports.take_all();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].touching, 1);
  // 0.7 m at 0.5 m/s from 0.5 s on; a contact is made when the parts overlap: a step of 1 ms more.
  EXPECT_NEAR(static_cast<double>(all[0].utime - test.world.epoch_us()) * 1e-6, 1.9, 0.003);
  push(test, -0.5);
  test.run_for(0.5);
  all = reports.take_all();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].touching, 0);
  EXPECT_EQ(all[0].count, 0);
}

TEST(Bumper, ReportsWhereWithWhomAndHowHard) {
  test::TestWorld test(sled_world(", parts: [base/front], report: always"));
  test::Listener<shoal::bumper_t> reports(test, "s1.bumper");
  test.run_for(0.1);
  push(test, 0.5);
  test.run_for(2);
  ASSERT_GT(test.world.find_vehicle("s1")->X_WV().translation().x(), 0.69);
  // It is pressed with 20 N against the wall.
  press_for(test, 20, 500);
  const auto report = reports.last();
  ASSERT_EQ(report.touching, 1);
  ASSERT_GT(report.count, 0);
  double force_N = 0;
  for (int i = 0; i < report.count; ++i) {
    EXPECT_EQ(report.part[i], "base/front");
    EXPECT_EQ(report.other[i], "wall");
    EXPECT_NEAR(report.position_m[i][0], 0.3, 0.002);  // surface layer and the overlap of the contact
    EXPECT_LE(std::abs(report.position_m[i][1]), 0.15 + 1e-6);
    EXPECT_NEAR(report.normal[i][0], -1, 1e-6);
    force_N += report.force_N[i];
  }
  EXPECT_NEAR(force_N, 20, 0.2);
}

TEST(Bumper, WithoutPartsItFeelsWithItsWholeBody) {
  test::TestWorld test(sled_world(", report: always"));
  test::Listener<shoal::bumper_t> reports(test, "s1.bumper");
  test.run_for(0.5);
  const auto report = reports.last();
  double force_N = 0;
  for (int i = 0; i < report.count; ++i) {
    EXPECT_EQ(report.other[i], "ground");
    EXPECT_NEAR(report.normal[i][2], 1, 1e-6);
    force_N += report.force_N[i];
  }
  EXPECT_NEAR(force_N, 10 * 9.80665, 0.5);  // its weight; the step's rounding of a body at rest
}

TEST(Bumper, FeelsNothingBelowItsLeastForce) {
  test::TestWorld test(sled_world(", report: always, min_force_N: 200"));
  test::Listener<shoal::bumper_t> reports(test, "s1.bumper");
  test.run_for(0.5);
  EXPECT_EQ(reports.last().touching, 0);
}

TEST(Bumper, ATouchBetweenTwoSamplesIsReported) {
  // Ten samples a second; the sled bounces off at once.
  std::string world = sled_world(", parts: [base/front], rate_hz: 10, phase_s: 0");
  world.replace(world.find("[{between: [slick, any], friction: 0}]"), 38,
                "[{between: [slick, any], friction: 0, restitution: 1}]");
  test::TestWorld test(world);
  test::Listener<shoal::bumper_t> reports(test, "s1.bumper");
  push(test, 1);
  test.run_for(1.5);
  const auto all = reports.take_all();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[1].touching, 1);
  EXPECT_EQ(all[2].touching, 0);
  EXPECT_LT(test.world.find_vehicle("s1")->X_WV().translation().x(), 0.69);
}

TEST(Bumper, NoiseOfTheForceHasTheSpreadAskedFor) {
  test::TestWorld test(sled_world(", report: always, truth: true, force_noise: {gaussian_std: 0.5}"));
  test::Listener<shoal::bumper_t> reports(test, "s1.bumper"), truths(test, "s1.bumper.truth");
  test.run_for(2);
  const auto measured = reports.take_all(), truth = truths.take_all();
  ASSERT_EQ(measured.size(), truth.size());
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (int k = 0; k < truth[i].count; ++k, ++count)
      squares += std::pow(measured[i].force_N[k] - truth[i].force_N[k], 2);
  ASSERT_GT(count, 2000);
  EXPECT_NEAR(std::sqrt(squares / count), 0.5, 4 * 0.5 / std::sqrt(2 * count));  // four standard deviations
}

TEST(Bumper, GoesWithItsVehicle) {
  test::TestWorld test(sled_world(""));
  test.run_for(0.1);
  EXPECT_NO_THROW(test.world.editor().remove_vehicle("s1"));
  test.run_for(0.1);
  EXPECT_TRUE(test.world.physics().contacts().empty());
}

TEST(Bumper, NamesAPartThatDoesNotExist) {
  try {
    test::TestWorld test(sled_world(", parts: [base/frnt]"));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("device 'bumper': 'parts' names no part 'base/frnt'"));
  }
}

}  // namespace
