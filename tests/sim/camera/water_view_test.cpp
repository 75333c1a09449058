// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/water_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/bus/in_process_bus.hpp"
#include "sim/camera/renderer.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/sim/camera/water_view_fixture.hpp"

namespace {

using namespace water_view_fixture;

TEST(WaterView, FindsTheStillSurface) {
  const Sea sea(false);
  sim::WaterView water(sea.world.medium(), {}, {sim::water_optics(20)});
  water.update({0, 0, 3});
  EXPECT_FALSE(water.is_under());
  EXPECT_NEAR(water.crossing_m(sim::Vector3d(0.8, 0, -0.6), 100), 5, 1e-9);
  EXPECT_FALSE(std::isfinite(water.crossing_m(sim::Vector3d(0.8, 0, 0.6), 100)));
  EXPECT_FALSE(std::isfinite(water.crossing_m(sim::Vector3d(0.8, 0, -0.6), 4.9)));
  water.update({0, 0, -3});
  EXPECT_TRUE(water.is_under());
  EXPECT_NEAR(water.crossing_m(sim::Vector3d(0.8, 0, 0.6), 100), 5, 1e-9);
  EXPECT_NEAR(water.daylight(-2).y(), std::exp(-2 * sim::water_optics(20).downward.y()), 1e-3);
}

TEST(WaterView, FindsTheWavesOfTheRun) {
  const Sea sea(true);
  sim::WaterView water(sea.world.medium(), {}, {sim::water_optics(20)});
  const sim::Vector3d eye_W(1, 2, 4);
  water.update(eye_W);
  for (const double yaw_rad : {0.0, 1.0, 2.5, 4.0})
    for (const double down : {0.4, 0.7, 0.95}) {
      const sim::Vector3d direction_W(std::sqrt(1 - down * down) * std::cos(yaw_rad),
                                      std::sqrt(1 - down * down) * std::sin(yaw_rad), -down);
      const double range_m = water.crossing_m(direction_W, 100);
      ASSERT_TRUE(std::isfinite(range_m));
      const sim::Vector3d p_W = eye_W + range_m * direction_W;
      // The grid cannot show waves shorter than 8 points: of 0.6 m and less, with small amplitudes.
      EXPECT_NEAR(p_W.z(), sea.world.medium().surface_m(p_W.x(), p_W.y()), 0.03) << p_W.transpose();
    }
}

TEST(WaterView, FocusesSunlightWithoutChangingItsMean) {
  const Sea sea(false);
  sim::WaterLook look{sim::water_optics(20)};
  look.caustics = true;
  look.seed = 7;
  sim::WaterView water(sea.world.medium(), {}, look);
  water.update({0, 0, -1});
  for (const double depth_m : {0.5, 2.0, 5.0}) {
    double sum = 0, squares = 0;
    int count = 0;
    for (double x = 0; x < 40; x += 0.13)
      for (double y = 0; y < 40; y += 0.13, ++count) {
        const double factor = water.caustic({x, y, -depth_m});
        sum += factor, squares += factor * factor;
      }
    EXPECT_NEAR(sum / count, 1, 0.03) << depth_m;
    EXPECT_GT(squares / count - sum / count * sum / count, 0.001) << depth_m;
  }
  EXPECT_EQ(water.caustic({1, 2, 0.5}), 1);
  sim::WaterView same(sea.world.medium(), {}, look);
  same.update({0, 0, -1});
  EXPECT_EQ(water.caustic({1, 2, -2}), same.caustic({1, 2, -2}));
}

TEST(WaterView, ExposesAGrayCardThreeMetersAwayAsGray) {
  const Sea sea(false);
  sim::WaterView water(sea.world.medium(), {}, {sim::water_optics(20)});
  water.update({0, 0, -4});
  const sim::WaterOptics optics = sim::water_optics(20);
  const sim::LinearColor left = (-3 * optics.attenuation).array().exp();
  const sim::LinearColor light = water.daylight(-4).cwiseProduct(left).cwiseProduct(water.gain());
  EXPECT_NEAR(light.x(), light.y(), 0.01 * light.y());
  EXPECT_NEAR(light.z(), light.y(), 0.01 * light.y());
  water.update({0, 0, 4});
  EXPECT_EQ(water.gain(), sim::LinearColor::Ones().eval());
}

}  // namespace
