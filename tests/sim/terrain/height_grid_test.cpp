// SPDX-License-Identifier: BSD-3-Clause
#include "sim/terrain/height_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/terrain/terrain.hpp"
#include "tests/sim/terrain/terrain_error.hpp"

namespace {

using sim::HeightGrid;

template <typename Height>
HeightGrid grid_of(int columns, int rows, double cell_m, Height&& height) {
  HeightGrid grid;
  grid.columns = columns;
  grid.rows = rows;
  grid.cell_m = cell_m;
  grid.west_m = -3;
  grid.south_m = 2;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      grid.heights_m.push_back(height(grid.west_m + i * cell_m, grid.south_m + j * cell_m));
  return grid;
}

using test::error_of;

TEST(HeightGrid, APlaneStaysAPlaneToItsBorder) {
  const HeightGrid grid = grid_of(9, 7, 0.5, [](double x, double y) { return 3 + 0.25 * x - 0.5 * y; });
  for (const double x : {-3.0, -2.9, -1.3, 0.0, 0.99, 1.0})
    for (const double y : {2.0, 2.2, 3.7, 4.99, 5.0}) {
      const sim::SurfacePoint point = grid.smooth_at(x, y);
      EXPECT_NEAR(point.height_m, 3 + 0.25 * x - 0.5 * y, 1e-14);
      EXPECT_NEAR(point.slope_x, 0.25, 1e-13);
      EXPECT_NEAR(point.slope_y, -0.5, 1e-13);
      EXPECT_NEAR(point.bend_xx_pm, 0, 1e-12);
      EXPECT_NEAR(grid.facet_height(x, y), 3 + 0.25 * x - 0.5 * y, 1e-14);
    }
}

TEST(HeightGrid, AParaboloidHasItsDerivativesAndLiesAnEighthOfTheBendBelow) {
  const double h = 0.25;
  const auto height = [](double x, double y) { return 0.3 * x * x - 0.1 * x * y + 0.2 * y * y; };
  const HeightGrid grid = grid_of(40, 40, h, height);
  for (const auto& [x, y] : {std::pair{0.1, 5.3}, {1.37, 4.0}, {-1.0, 6.125}}) {
    const sim::SurfacePoint point = grid.smooth_at(x, y);
    EXPECT_NEAR(point.slope_x, 0.6 * x - 0.1 * y, 1e-12);
    EXPECT_NEAR(point.slope_y, 0.4 * y - 0.1 * x, 1e-12);
    EXPECT_NEAR(point.bend_xx_pm, 0.6, 1e-11);
    EXPECT_NEAR(point.bend_xy_pm, -0.1, 1e-11);
    EXPECT_NEAR(point.bend_yy_pm, 0.4, 1e-11);
    // The B-spline of x^2 is x^2 + h^2 / 4.
    EXPECT_NEAR(point.height_m - height(x, y), h * h / 4 * (0.3 + 0.2), 1e-12);
  }
}

TEST(HeightGrid, SurfaceAndSlopeContinueAcrossCellsAndNeverLeaveTheHeights) {
  sim::TerrainConfig config;
  config.source = sim::TerrainConfig::Source::fractal;
  config.size_m = {10, 10};
  config.cell_m = 0.5;
  config.amplitude_m = 2;
  const HeightGrid grid = sim::load_terrain(config).grid;
  constexpr double tiny = 1e-9;
  for (double x = -4.75; x < 4.8; x += 0.5)
    for (double y = -4.9; y < 5; y += 0.35) {
      const sim::SurfacePoint before = grid.smooth_at(x - tiny, y), after = grid.smooth_at(x + tiny, y);
      EXPECT_NEAR(before.height_m, after.height_m, 1e-7);
      EXPECT_NEAR(before.slope_x, after.slope_x, 1e-6);
      EXPECT_NEAR(before.slope_y, after.slope_y, 1e-6);
      EXPECT_GE(before.height_m, grid.lowest_m());
      EXPECT_LE(before.height_m, grid.highest_m());
    }
}

TEST(HeightGrid, TrianglesShareTheDiagonalToTheNorthEastAndLookUp) {
  const HeightGrid grid = grid_of(3, 3, 1, [](double x, double y) { return x * y; });
  const sim::Mesh mesh = sim::mesh_of(grid);
  ASSERT_EQ(mesh.triangles.size(), 8u);
  for (const auto& t : mesh.triangles) {
    const sim::Vector3d a = mesh.vertices_m[t[0]], b = mesh.vertices_m[t[1]], c = mesh.vertices_m[t[2]];
    EXPECT_GT((b - a).cross(c - a).z(), 0);
    const sim::Vector3d middle = (a + b + c) / 3;
    EXPECT_NEAR(grid.facet_height(middle.x(), middle.y()), middle.z(), 1e-12);
  }
  // The middle of the first cell lies on its diagonal: between the south-western and the north-eastern point.
  EXPECT_NEAR(grid.facet_height(-2.5, 2.5), (-3.0 * 2 + -2.0 * 3) / 2, 1e-12);
}

TEST(HeightGrid, RefusesWhatIsNoGround) {
  HeightGrid grid = grid_of(4, 4, 1, [](double, double) { return 0; });
  EXPECT_EQ(error_of([&] { sim::check_heights(grid); }), "no error");
  grid.at(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_of([&] { sim::check_heights(grid); }), "has a height that is not finite");
  grid.at(1, 2) = 20'001;
  EXPECT_EQ(error_of([&] { sim::check_heights(grid); }),
            "spans 20001 m of height, more than the earth does: wrong units?");
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) grid.at(i, j) = 100 * ((i + j) % 2);
  EXPECT_EQ(error_of([&] { sim::check_heights(grid); }),
            "is steeper than 89 degrees nearly everywhere: heights and cells in one unit, meters?");
  EXPECT_EQ(error_of([] { sim::check_grid_size(1, 5); }),
            "is not a grid: it has 1 x 5 points and needs at least 2 x 2");
  EXPECT_EQ(error_of([] { sim::check_grid_size(-4, -5); }),
            "is not a grid: it has -4 x -5 points and needs at least 2 x 2");
  EXPECT_EQ(error_of([] { sim::check_grid_size(4001, 4001); }),
            "is too large: it has 4001 x 4001 points, and may have 16 million");
}

}  // namespace
