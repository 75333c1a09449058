// SPDX-License-Identifier: BSD-3-Clause
// The first request of the overlap of a group looks at positions, repeated ones at an index.
#include <gtest/gtest.h>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world_file/load_world.hpp"

namespace {

/// Boxes of 1 m: `left` and `right` overlap by 0.1 m, `apart` stands alone; `low` is 0.2 m deep in the ground, and
/// `sunk` 0.3 m in a fixed block.
constexpr const char* boxes_that_overlap = R"(
shoal: 1
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
  - {name: block, fixed: true, position_m: [20, 0, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}
  - {name: left, position_m: [0, 0, 5], parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]}
  - {name: right, position_m: [0.9, 0, 5], parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]}
  - {name: apart, position_m: [5, 0, 5], parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]}
  - {name: low, position_m: [10, 0, 0.3], parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]}
  - {name: sunk, position_m: [20.7, 0, 5], parts: [{shape: box, size_m: [1, 1, 9.1], mass_kg: 1}]}
)";

class Overlap : public testing::Test {
 protected:
  std::pair<std::string, double> of(const std::string& name) const {
    return world_.physics().deepest_overlap(world_.find_object(name)->group());
  }
  void expect(const std::string& name, const std::string& other, double depth_m) const {
    const auto [found, depth] = of(name);
    EXPECT_EQ(found, other) << name;
    EXPECT_NEAR(depth, depth_m, 1e-6) << name;
  }
  void expect_all() const {
    expect("left", "right", 0.1);
    expect("right", "left", 0.1);
    expect("apart", "", 0);
    expect("low", "ground", 0.2);
    expect("sunk", "block", 0.3);
  }

  sim::LoadedWorld loaded_ = sim::load_world_text(boxes_that_overlap, "boxes.yaml");
  sim::InProcessBus bus_;
  sim::World world_{loaded_.config, bus_};
};

TEST_F(Overlap, IsTheSameWhenRequestedAgain) {
  for (int i = 0; i < 3; ++i) expect_all();
}

TEST_F(Overlap, IsThatOfTheNewPosesAfterAStep) {
  expect_all();
  world_.step();
  const auto first = of("left");
  EXPECT_EQ(first.first, "right");
  EXPECT_EQ(of("left"), first) << "by the index";
}

TEST_F(Overlap, IsFoundWhereStepsHaveBroughtTheOthers) {
  expect_all();
  for (int i = 0; i < 50; ++i) world_.step();
  const sim::Pose X_WA = world_.find_object("apart")->base().X_WB();
  EXPECT_LT(X_WA.translation().z(), 4.5) << "it has fallen";
  const sim::ObjectConfig box = loaded_.config.objects[4];
  world_.editor().add_object(box, "guest", sim::make_pose({5.9, 0, X_WA.translation().z()}, {0, 0, 0}));
  world_.editor().add_object(box, "second", sim::make_pose({5, 0.8, X_WA.translation().z()}, {0, 0, 0}));
  expect("guest", "apart", 0.1);
  expect("second", "apart", 0.2);
  // And moves between steps.
  world_.editor().move_object("apart", sim::make_pose({5, -9, 5}, {0, 0, 0}));
  world_.editor().remove_object("second");
  expect("guest", "", 0);
}

TEST_F(Overlap, EndsWithTheRemovalOfTheOther) {
  expect_all();
  world_.editor().remove_object("right");
  for (int i = 0; i < 2; ++i) expect("left", "", 0);
  world_.editor().remove_object("block");
  for (int i = 0; i < 2; ++i) expect("sunk", "", 0);
}

}  // namespace
