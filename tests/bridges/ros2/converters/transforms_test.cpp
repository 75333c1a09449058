// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/sim_bodies_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, BodiesAreTransformsNamedByTheSceneBefore) {
  ConverterContext context;
  shoal::sim_scene_t scene{};
  scene.revision = 3;
  scene.scene = R"({"bodies": [{"id": 4, "name": "a/arm", "owner": "a"}, {"id": 6, "name": "ball", "owner": ""}, 7]})";
  EXPECT_FALSE(converted(scene, "/tf", "sim.scene", &context));
  shoal::sim_bodies_t bodies{1'500'000,
                             0,
                             0,
                             3,
                             3,
                             {4, 5, 6},
                             {{1, 2, 3}, {0, 0, 0}, {4, 5, 6}},
                             {{0.5f, -0.5f, 0.5f, 0.25f}, {1, 0, 0, 0}, {1, 0, 0, 0}}};
  auto in = converted(bodies, "/tf", "sim.bodies", &context);
  ASSERT_EQ(in->number<std::uint32_t>(), 2u);  // body 5 is not in the scene
  expect_header(*in, "world");
  EXPECT_EQ(in->text(), "a/body/arm");
  for (const double value : {1.0, 2.0, 3.0, -0.5, 0.5, 0.25, 0.5}) EXPECT_EQ(in->number<double>(), value);
  expect_header(*in, "world");
  EXPECT_EQ(in->text(), "body/ball");
  bodies.revision = 4;
  EXPECT_FALSE(converted(bodies, "/tf", "sim.bodies", &context));  // of a scene that is not known
  scene.scene = "[";
  EXPECT_FALSE(converted(scene, "/tf", "sim.scene", &context));
  EXPECT_TRUE(context.body_frames.empty());
}

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
