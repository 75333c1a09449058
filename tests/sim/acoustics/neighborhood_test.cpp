// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/neighborhood.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/random/random.hpp"

namespace {

using sim::Neighborhood;
using sim::Vector3d;

TEST(Neighborhood, FindsAllWhoAreNearAndFewOthers) {
  sim::Random random(1, "places");
  random.begin_step(0);
  std::vector<Neighborhood::Member> members;
  for (int i = 0; i < 2000; ++i)
    members.push_back({i, {20000 * random.uniform() - 10000, 20000 * random.uniform() - 10000, -10}});
  Neighborhood neighbors;
  neighbors.build(members, 1000);
  std::size_t found = 0, near_enough = 0;
  for (const double reach_m : {1.0, 300.0, 1000.0, 3000.0, 50000.0})
    for (int i = 0; i < 50; ++i) {
      const Vector3d at = members[static_cast<std::size_t>(i)].p_W;
      std::vector<int> numbers;
      neighbors.near(at, reach_m, numbers);
      EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
      EXPECT_EQ(std::adjacent_find(numbers.begin(), numbers.end()), numbers.end());
      for (const auto& member : members)
        if ((member.p_W - at).head<2>().norm() <= reach_m) {
          EXPECT_TRUE(std::binary_search(numbers.begin(), numbers.end(), member.number));
          near_enough += reach_m == 1000 ? 1 : 0;
        }
      found += reach_m == 1000 ? numbers.size() : 0;
    }
  // Cells of half the reach: a square of up to 2.5 reaches by the circle's area.
  EXPECT_LE(static_cast<double>(found), 2.5 * static_cast<double>(near_enough));
}

TEST(Neighborhood, OfNoOneFindsNoOne) {
  Neighborhood neighbors;
  neighbors.build({}, 100);
  std::vector<int> numbers{1};
  neighbors.near({0, 0, 0}, 1e6, numbers);
  EXPECT_TRUE(numbers.empty());
}

}  // namespace
