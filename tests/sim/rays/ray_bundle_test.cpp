// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/ray_bundle.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace {

using sim::Vector3d;

/// Rays from around a place, in directions around x.
std::vector<sim::Ray> rays_around(std::mt19937& random, double radius_m, double slope, const Vector3d& place_W) {
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<sim::Ray> rays(64);
  for (sim::Ray& ray : rays) {
    ray.origin_W = place_W + radius_m * Vector3d(any(random), any(random), any(random));
    ray.direction_W = Vector3d(1, slope * any(random), slope * any(random)).normalized();
  }
  return rays;
}

/// A bundle with the rays that made it: some from one place, some parallel, some far from the origin of the world.
struct Case {
  Case(int number, std::mt19937& random)
      : place_W(number % 4 == 0 ? Vector3d(1e6, -2e5, 40) : Vector3d(3, 1, 2)),
        rays(rays_around(random, number % 3 == 0 ? 0 : 2, number % 5 == 0 ? 0 : 0.3, place_W)),
        bundle(rays) {}

  Vector3d place_W;
  std::vector<sim::Ray> rays;
  sim::RayBundle bundle;
};

TEST(RayBundle, NeverExcludesASphereThatARayTouches) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 500; ++i) {
    const Case given(i, random);
    for (const sim::Ray& ray : given.rays) {
      const double along_m = 40 * share(random), radius_m = 0.01 + 2 * share(random);
      const Vector3d aside = ray.direction_W.cross(Vector3d(0, share(random) - 0.5, share(random) - 0.5)).normalized();
      const Vector3d center_W = ray.origin_W + along_m * ray.direction_W + 0.9999 * radius_m * aside;
      ASSERT_TRUE(given.bundle.may_reach(center_W, radius_m)) << i;
    }
  }
}

TEST(RayBundle, ExcludesSpheresBesideAndBehindIt) {
  std::mt19937 random(7);
  int narrow = 0;
  for (int i = 0; i < 500; ++i) {
    const Case given(i, random);
    if (!given.bundle.is_narrow()) continue;  // some have too many directions
    ++narrow;
    EXPECT_FALSE(given.bundle.may_reach(given.place_W + Vector3d(-20, 0, 0), 1)) << i;
    EXPECT_FALSE(given.bundle.may_reach(given.place_W + Vector3d(5, 60, 0), 1)) << i;
  }
  EXPECT_GT(narrow, 200);
}

TEST(RayBundle, ExcludesNothingForRaysOfManyDirections) {
  std::mt19937 random(7);
  auto rays = rays_around(random, 0, 0.1, Vector3d::Zero());
  EXPECT_FALSE(sim::RayBundle(rays).may_reach({-10, 0, 0}, 1));
  rays.front().direction_W = -Vector3d::UnitX();
  EXPECT_TRUE(sim::RayBundle(rays).may_reach({-10, 0, 0}, 1));
  EXPECT_TRUE(sim::RayBundle().may_reach({-10, 0, 0}, 1));
}

}  // namespace
