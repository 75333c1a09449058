// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/sim_state_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, PosesOfVehiclesAreTransformsWithWLast) {
  shoal::sim_state_t state{1'500'000, 0, 1, {"auv1"}, {{1, 2, 3}}, {{0.5, -0.5, 0.5, 0.25}}, {{0, 0, 0}}, {{0, 0, 0}}};
  auto in = converted(state, "/tf");
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);
  expect_header(*in, "world");
  EXPECT_EQ(in->text(), "auv1");
  for (const double value : {1.0, 2.0, 3.0, -0.5, 0.5, 0.25, 0.5}) EXPECT_EQ(in->number<double>(), value);
  EXPECT_TRUE(in->at_end());
}

}  // namespace
