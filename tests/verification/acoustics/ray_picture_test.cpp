// SPDX-License-Identifier: BSD-3-Clause
#include "verification/acoustics/ray_picture.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/verification/acoustics/links_in_the_sea.hpp"
#include "verification/acoustics/acoustic_closed_forms.hpp"
#include "verification/acoustics/acoustic_link.hpp"

namespace {

using namespace links_in_the_sea;

using test_support::ScratchFolder;

TEST(RayField, ShadowsBeginWhereTheLastRayGrazes) {
  // 1897 m to the bottom of the mixed layer, and 238 m from there to 50 m: 2135 m.
  const verification::RayField field = verification::ray_field(1, 2400, 25000, thorp(), thermocline(), {});
  const double row_m = field.deepest_m / field.rows;
  double first_dark_m = 0;
  for (const verification::RayField::Point& point : field.points)
    if (std::abs(point.depth_m - 50) < 0.51 * row_m && point.shadow && first_dark_m == 0) first_dark_m = point.range_m;
  EXPECT_NEAR(first_dark_m, 2135, 30);
  ASSERT_FALSE(field.fan.empty());
  for (const sim::RayTrace& ray : field.fan) EXPECT_NEAR(ray.depth_m.at(0), 1, 1e-9);
  const ScratchFolder folder;
  verification::draw_rays(field, "rays", folder.file("rays.png"));
  EXPECT_GT(std::filesystem::file_size(folder.file("rays.png")), 10000u);
}

}  // namespace
