// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "tests/sim/physics/small_worlds.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using namespace small_worlds;
using Space = PhysicsConfig::Space;

std::uint64_t hash_of(const PhysicsWorld& world) {
  return test::state_hash_of(world);
}

/// What a ray along +x at height z hits.
std::optional<sim::RayHit> look(const PhysicsWorld& world, double z_m) {
  return world.scene().cast({-10, 0, z_m}, {1, 0, 0}, 100, {});
}

class RemovalInEachSpace : public testing::TestWithParam<Space> {
 protected:
  std::unique_ptr<PhysicsWorld> make() const {
    PhysicsConfig config;
    config.space = GetParam();
    auto world = make_world(config, {slippery()});
    add_ground(*world);
    return world;
  }
};

TEST_P(RemovalInEachSpace, RaysPassWhereAPartWas) {
  const auto world = make();
  const sim::Body& near = add(*world, body("near", {box({1, 1, 1}, 1)}), translation(0, 0, 0.5));
  const sim::Body& wall = add(*world, body("wall", {box({1, 1, 1}, 0)}), translation(3, 0, 0.5), Motion::fixed);
  add(*world, body("far", {box({1, 1, 1}, 1)}), translation(6, 0, 0.5));
  EXPECT_NEAR(look(*world, 0.5)->range_m, 9.5, 1e-9);
  world->remove_group(near.group());
  EXPECT_NEAR(look(*world, 0.5)->range_m, 12.5, 1e-9);
  world->remove_group(wall.group());
  EXPECT_NEAR(look(*world, 0.5)->range_m, 15.5, 1e-9);
  std::vector<sim::RayHit> seen(1);
  world->scene().cast_fan({translation(-10, 0, 0.5), 0, 0.1, 1, 100}, {}, seen);
  EXPECT_NEAR(seen[0].range_m, 15.5, 1e-9);
}

TEST_P(RemovalInEachSpace, ContactsVanishAndWhatStoodOnItFalls) {
  const auto world = make();
  const sim::Body& shelf = add(*world, body("shelf", {box({1, 1, 1}, 0)}), translation(0, 0, 0.5), Motion::fixed);
  const sim::Body& ball = add(*world, body("ball", {sphere(0.25, 1)}), translation(0, 0, 1.25));
  for (int i = 0; i < 50; ++i) world->step(i);
  EXPECT_EQ(world->last_step().contacts, 1);
  world->remove_group(shelf.group());
  world->step(50);
  EXPECT_EQ(world->last_step().contacts, 0);
  EXPECT_EQ(world->last_step().max_island_rows, 0);
  for (int i = 51; i < 150; ++i) world->step(i);
  EXPECT_NEAR(ball.X_WB().translation().z(), 0.25, 0.002);
}

TEST_P(RemovalInEachSpace, OfThePlaneLetsEverythingFallThrough) {
  const auto world = make();
  const sim::Body& ball = add(*world, body("ball", {sphere(0.25, 1)}), translation(0, 0, 0.25));
  world->remove_group(0);
  for (int i = 0; i < 100; ++i) world->step(i);
  EXPECT_LT(ball.X_WB().translation().z(), -4);
  EXPECT_FALSE(world->scene().cast({0, 0, 5}, {0, 0, -1}, 4.9, {}).has_value());
}

TEST_P(RemovalInEachSpace, OfWholeRoversInTheMidstOfADriveGivesTheSameBitsEachTime) {
  const auto run = [&] {
    const auto world = make();
    std::vector<std::uint64_t> hashes;
    std::vector<int> groups;
    for (int i = 0; i < 300; ++i) {
      if (i % 10 == 0) {
        // On top of each other at times: contacts between rovers come and go as well.
        Rover rover = add_rover(*world, "r" + std::to_string(i), translation(0.3 * (i / 10 % 4), 0.25 * (i % 3), 0.01));
        rover.left->set_motor(5, 5);
        groups.push_back(rover.chassis->group());
      }
      if (i % 10 == 5 && groups.size() > 4) {
        const auto at = groups.begin() + i / 10 % 4;
        world->remove_group(*at);
        groups.erase(at);
      }
      world->step(i);
      hashes.push_back(hash_of(*world));
    }
    return hashes;
  };
  EXPECT_EQ(run(), run());
}

INSTANTIATE_TEST_SUITE_P(Spaces, RemovalInEachSpace,
                         testing::Values(Space::sap, Space::quadtree, Space::hash, Space::simple));

TEST(Removal, ResultsDoNotDependOnTheSpaceWhenNumbersAreUsedAgain) {
  const auto run = [](Space space) {
    PhysicsConfig config;
    config.space = space;
    const auto world = make_world(config, {slippery()});
    add_ground(*world);
    for (int i = 0; i < 8; ++i) add_rover(*world, "r" + std::to_string(i), translation(0.45 * i, 0, 0));
    for (int i = 0; i < 200; ++i) {
      if (i % 20 == 10) world->remove_group(1 + i / 20 % 8);
      if (i % 20 == 15) add_rover(*world, "n" + std::to_string(i), translation(0.45 * (i / 20 % 8), 0.1, 0.3));
      world->step(i);
    }
    return hash_of(*world);
  };
  const std::uint64_t expected = run(Space::sap);
  for (const auto& [word, space] : PhysicsConfig::space_words) EXPECT_EQ(run(space), expected) << word;
}

TEST(Removal, LeavesEmptyPlacesThatTheNextGroupTakesLowestFirst) {
  const auto world = make_world({}, {slippery()});
  const Rover first = add_rover(*world, "first", translation(0, 0, 0));
  add_rover(*world, "second", translation(2, 0, 0));
  const Rover third = add_rover(*world, "third", translation(4, 0, 0));
  const int bodies_of_first = first.chassis->number(), group_of_first = first.chassis->group();
  world->remove_group(third.chassis->group());
  world->remove_group(group_of_first);
  EXPECT_EQ(world->bodies()[0], nullptr);
  EXPECT_EQ(world->joints()[1], nullptr);
  EXPECT_EQ(world->parts()[2].group, -1);
  EXPECT_EQ(world->parts()[4].group, 1);
  EXPECT_EQ(world->group_name(0), "");
  const Rover fourth = add_rover(*world, "fourth", translation(0, 0, 0));
  EXPECT_EQ(fourth.chassis->group(), group_of_first);
  EXPECT_EQ(fourth.chassis->number(), bodies_of_first);
  EXPECT_EQ(world->group_name(0), "fourth");
  EXPECT_EQ(world->parts()[0].name, "fourth/chassis/1");
}

TEST(Removal, OfAGroupThatIsNotThereIsAnError) {
  const auto world = make_world();
  const int group = add_ground(*world).group();
  EXPECT_THROW(world->remove_group(group + 1), std::out_of_range);
  EXPECT_THROW(world->remove_group(-1), std::out_of_range);
  world->remove_group(group);
  EXPECT_THROW(world->remove_group(group), std::out_of_range);
  EXPECT_THROW(world->watch_contacts(group), std::out_of_range);
}

TEST(Removal, WorksBeforeTheGroupIsClosed) {
  const auto world = make_world();
  for (const Motion motion : {Motion::free, Motion::fixed}) {
    const int group = world->add_group("open");
    world->add_body(group, body("box", {box({1, 1, 1}, 1)}), translation(0, 0, 0.5), motion);
    world->remove_group(group);
    EXPECT_FALSE(look(*world, 0.5).has_value());
    world->step(0);
  }
}

TEST(Removal, OfThousandRoversOneAfterTheOtherLeavesTheSizesOfOne) {
  const auto world = make_world({}, {slippery()});
  add_ground(*world);
  for (int i = 0; i < 1000; ++i) {
    const Rover rover = add_rover(*world, "rover", translation(0, 0, 0));
    world->watch_contacts(rover.chassis->group());
    rover.left->measure_load();
    world->step(i);
    EXPECT_EQ(world->last_step().contacts, 3);
    EXPECT_EQ(world->contacts().size(), 3u);
    world->remove_group(rover.chassis->group());
    EXPECT_TRUE(world->contacts().empty());
  }
  EXPECT_EQ(world->bodies().size(), 4u);
  EXPECT_EQ(world->joints().size(), 2u);
  EXPECT_EQ(world->parts().size(), 5u);
  EXPECT_EQ(add_rover(*world, "rover", translation(0, 0, 0)).chassis->group(), 1);
}

TEST(Removal, OfOtherIslandsDoesNotChangeTheMotionOfARover) {
  const auto run = [](bool others) {
    const auto world = make_world({}, {slippery()});
    add_ground(*world);
    Rover rover = add_rover(*world, "rover", translation(0, 0, 0));
    rover.left->set_motor(5, 5);
    for (int i = 0; i < 100; ++i) {
      if (others && i % 10 == 3) add_rover(*world, "other", translation(20, 20, 0));
      if (others && i % 10 == 8) world->remove_group(2);
      world->step(i);
    }
    return rover.chassis->X_WB().matrix();
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(Removal, OfTheLargestIslandLowersTheRowCount) {
  const auto world = make_world();
  PhysicsConfig config;
  Rover rover = add_rover(*world, "rover", translation(0, 0, 5));
  add(*world, body("box", {box({1, 1, 1}, 1)}), translation(3, 0, 5));
  world->step(0);
  EXPECT_EQ(world->last_step().max_island_rows, 12);  // two hinges
  world->remove_group(rover.chassis->group());
  world->step(1);
  EXPECT_EQ(world->last_step().max_island_rows, 0);
}

TEST(Removal, IsSeenInTheHash) {
  const auto world = make_world();
  add(*world, body("a", {box({1, 1, 1}, 1)}), translation(0, 0, 0.5));
  const std::uint64_t before = hash_of(*world);
  const sim::Body& b = add(*world, body("b", {box({1, 1, 1}, 1)}), translation(3, 0, 0.5));
  world->remove_group(b.group());
  EXPECT_NE(hash_of(*world), before);
}

TEST(LateSurfaces, LoseAgainstThoseOfTheConstructorAndKeepNumbers) {
  // A box on a plane that tilts by 0.3 rad slides below a friction of tan 0.3 = 0.31.
  const auto slides = [](const std::string& material, const std::vector<ContactConfig>& late) {
    const auto world = make_world({}, {slippery()});
    sim::PartConfig floor = plane();
    floor.material = "slippery";
    const Pose X_W = sim::make_pose({0, 0, 0}, {0, 0.3, 0});
    add(*world, body("ground", {material == "ice" ? plane() : floor}), X_W, Motion::fixed);
    const int number = world->parts()[0].material;
    world->add_surfaces({{"ice"}, {"slippery"}, {"ice"}}, late);
    EXPECT_EQ(world->parts()[0].material, number);
    sim::PartConfig part = box({0.5, 0.5, 0.5}, 1);
    part.material = "ice";
    const sim::Body& crate = add(*world, body("crate", {part}), X_W * translation(0, 0, 0.25));
    const double start_x = crate.X_WB().translation().x();
    for (int i = 0; i < 50; ++i) world->step(i);
    return crate.X_WB().translation().x() - start_x > 0.1;
  };
  ContactConfig icy;
  icy.between = {"any", "ice"};
  icy.friction = 0.05;
  EXPECT_FALSE(slides("ice", {}));
  EXPECT_TRUE(slides("ice", {icy}));
  ContactConfig rough = icy;
  rough.friction = 2;
  EXPECT_FALSE(slides("ice", {icy, rough}));
  // `any, slippery` of the constructor stands after `any, ice`.
  EXPECT_TRUE(slides("slippery", {rough}));
}

TEST(LateCategories, GetBitsOfTheirOwnUpToThirtyOne) {
  const auto world = make_world();
  world->add_categories({"glass", "solid", "glass"});
  EXPECT_EQ(world->category_bit("solid"), 1u);
  EXPECT_EQ(world->category_bit("glass"), 2u);
  std::vector<std::string> many;
  for (int i = 0; i < 30; ++i) many.push_back("c" + std::to_string(i));
  EXPECT_THROW(world->add_categories(many), std::length_error);
  EXPECT_THROW(world->category_bit("c0"), std::out_of_range);
  many.pop_back();
  world->add_categories(many);
  EXPECT_EQ(world->category_bit("c28"), 1u << 30);
}

TEST(Gravity, OfTheMoonIsTakenFromTheNextStepOnAndSeenInTheHash) {
  const auto world = make_world();
  const sim::Body& stone = add(*world, body("stone", {box({1, 1, 1}, 1)}), translation(0, 0, 100));
  const std::uint64_t before = hash_of(*world);
  world->set_gravity(1.62);
  EXPECT_NE(hash_of(*world), before);
  for (int i = 0; i < 100; ++i) world->step(i);
  EXPECT_NEAR(stone.v_WB_W().z(), -1.62, 1e-9);
  const auto other = make_world();
  other->set_gravity(PhysicsConfig{}.gravity_mps2);
  EXPECT_EQ(hash_of(*other), hash_of(*make_world()));
}

TEST(MoveGroup, TakesAVehicleAlongWithJointsAndVelocities) {
  PhysicsConfig config;
  config.gravity_mps2 = 0;
  const auto world = make_world(config, {slippery()});
  Rover rover = add_rover(*world, "rover", translation(1, 0, 5));
  rover.left->set_motor(5, 5);
  rover.chassis->set_velocity_W({1, 0, 0}, {0, 0, 0});
  for (int i = 0; i < 100; ++i) world->step(i);
  const double angle_rad = rover.left->position();
  const Vector3d v_W = rover.chassis->v_WB_W();
  const Pose X_move_W = sim::make_pose({10, 20, 30}, {0.3, 0.2, 1.5}), X_WB = rover.chassis->X_WB();
  world->move_group(rover.chassis->group(), X_move_W, true);
  EXPECT_TRUE(rover.chassis->X_WB().isApprox(X_move_W * X_WB, 1e-12));
  EXPECT_TRUE(rover.chassis->v_WB_W().isApprox(X_move_W.linear() * v_W, 1e-12));
  EXPECT_EQ(rover.left->position(), angle_rad);
  world->step(100);
  EXPECT_NEAR(rover.left->position(), angle_rad + 0.05, 1e-6);
  EXPECT_NEAR(rover.left->velocity(), 5, 1e-6);
  world->move_group(rover.chassis->group(), X_move_W);
  EXPECT_EQ(rover.chassis->v_WB_W(), Vector3d(0, 0, 0));
}

TEST(MoveGroup, TakesTheWorldsSideOfAJointAlong) {
  for (const JointType type :
       {JointType::hinge, JointType::universal, JointType::slider, JointType::fixed, JointType::ball}) {
    PhysicsConfig config;
    config.gravity_mps2 = 0;
    const auto world = make_world(config);
    const int group = world->add_group("arm");
    sim::Body& arm = world->add_body(group, body("arm", {box({1, 0.1, 0.1}, 1)}, {0.5, 0, 0}), Pose::Identity());
    JointConfig pivot = joint("pivot", type, {0, 0, 0}, Vector3d::UnitX());
    pivot.axis2.axis = Vector3d::UnitZ();
    sim::Joint& joint = world->add_joint(group, pivot, arm, nullptr, Pose::Identity());
    world->close_group(group);
    joint.set_motor(1, 100);
    for (int i = 0; i < 50; ++i) world->step(i);
    const Pose X_move_W = sim::make_pose({10, 20, 30}, {0.3, 0.2, 1.5}), X_WB = arm.X_WB();
    const double position = joint.position();
    world->move_group(group, X_move_W, true);
    joint.set_motor(0, 100);
    for (int i = 0; i < 50; ++i) world->step(i);
    EXPECT_NEAR(joint.position(), position, 1e-9) << word_of(sim::joint_type_words, type);
    EXPECT_TRUE(arm.X_WB().isApprox(X_move_W * X_WB, 1e-9)) << word_of(sim::joint_type_words, type);
  }
}

}  // namespace
