// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/marine_snow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace {

struct Image {
  sim::FloatImage light{160, 120, 3}, depth_m{160, 120, 1};

  void draw(double per_m3, std::uint64_t seed, int first, int end, double time_s = 0, double refraction = 1,
            float wall_m = std::numeric_limits<float>::infinity()) {
    std::fill(depth_m.data.begin(), depth_m.data.end(), wall_m);
    sim::OpticsConfig lens;
    lens.width = 160, lens.height = 120, lens.fov_rad = 1.2;
    sim::WaterLight water;
    water.is_under = true;
    water.eye_depth_m = 10;
    water.attenuation.setConstant(0.1F);
    sim::MarineSnow(per_m3, seed)
        .draw(sim::make_pose({3, 2, -10}, {0, 0, 0.4}), time_s, sim::Optics(lens), refraction, water,
              sim::LinearColor::Ones(), {}, {light, depth_m, false, first, end, 1});
  }
  double sum() const {
    double all = 0;
    for (const float value : light.data) all += static_cast<double>(value);
    return all;
  }
};

TEST(MarineSnow, IsAFunctionOfSeedAndTime) {
  Image first, again, other, later;
  first.draw(500, 1, 0, 120), again.draw(500, 1, 0, 120), other.draw(500, 2, 0, 120), later.draw(500, 1, 0, 120, 60);
  EXPECT_GT(first.sum(), 0);
  EXPECT_EQ(first.light.data, again.light.data);
  EXPECT_NE(first.light.data, other.light.data);
  EXPECT_NE(first.light.data, later.light.data);  // it sinks
}

TEST(MarineSnow, IsTheSameInStripsOfRows) {
  Image whole, strips;
  whole.draw(500, 1, 0, 120);
  for (int row = 0; row < 120; ++row) strips.draw(500, 1, row, row + 1);
  EXPECT_EQ(whole.light.data, strips.light.data);
}

TEST(MarineSnow, IsBehindAPortOnlyWhereRaysLook) {
  Image straight, port, wall;
  straight.draw(5000, 1, 0, 120), port.draw(5000, 1, 0, 120, 0, sim::water_index);
  EXPECT_GT(port.sum(), 0);
  // Its field of view is narrower by the index, in both directions; none is behind the camera.
  EXPECT_LT(port.sum(), straight.sum());
  wall.draw(5000, 1, 0, 120, 0, sim::water_index, 0.01F);
  EXPECT_EQ(wall.sum(), 0);
}

TEST(MarineSnow, HasLightInProportionToItsDensity) {
  Image few, many;
  few.draw(500, 1, 0, 120), many.draw(5000, 1, 0, 120);
  EXPECT_NEAR(many.sum() / few.sum(), 10, 3);
}

}  // namespace
