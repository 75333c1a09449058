// SPDX-License-Identifier: BSD-3-Clause
// Groups near each other share an ODE world.  Which ones do must not matter to any bit of their motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/sim/physics/small_worlds.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using namespace small_worlds;

/// Rovers that drive towards each other, push, and are pulled apart again and again; `bar`: a bar that touches nothing,
/// but whose box holds them all, so that they are together all the time.
class Meeting {
 public:
  explicit Meeting(bool bar, PhysicsConfig config = {}) : world_(make_world(config, {slippery()})) {
    add_ground(*world_);
    for (int i = 0; i < 4; ++i)
      rovers_.push_back(add_rover(
          *world_, "rover" + std::to_string(i),
          sim::make_pose({2 + 1.4 * (i % 2), -4 + 0.7 * (i / 2), 0}, {0, 0, i % 2 * std::numbers::pi + 0.05 * i})));
    if (bar)
      add(*world_, body("bar", {box({16, 0.02, 0.02}, 1)}), sim::make_pose({0, 0, 0.2}, {0, 0, std::atan2(1, 1)}),
          Motion::kinematic);
  }

  std::vector<std::uint64_t> run(int steps) {
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < steps; ++i) {
      // Each meets the one in front of it every 160 steps.
      for (std::size_t j = 0; j < rovers_.size(); ++j) {
        const double ahead = (i + 20 * static_cast<int>(j / 2)) / 80 % 2 == 0 ? 8 : -7;
        rovers_[j].left->set_motor(ahead, 5);
        rovers_[j].right->set_motor((j == 1 ? 0.9 : 1) * ahead, 5);
      }
      world_->step(i);
      max_rows_ = std::max(max_rows_, world_->last_step().max_island_rows);
      hashes.push_back(0);
      for (const auto& each : world_->bodies())
        if (each && !each->fixed() && !each->kinematic()) hashes.back() += test::state_hash_of(*each);
    }
    return hashes;
  }
  int max_rows() const { return max_rows_; }
  PhysicsWorld& world() { return *world_; }

 private:
  std::unique_ptr<PhysicsWorld> world_;
  std::vector<Rover> rovers_;
  int max_rows_ = 0;
};

TEST(Shards, DoNotMatterToTheMotionOfWhatMeetsAndParts) {
  for (const auto& [word, solver] : PhysicsConfig::solver_words)
    for (const int quick_above_rows : {30, 1000}) {
      PhysicsConfig config;
      config.solver = solver;
      config.quick_above_rows = quick_above_rows;
      Meeting apart(false, config), together(true, config);
      EXPECT_EQ(apart.run(600), together.run(600)) << word << ", " << quick_above_rows << " rows";
      EXPECT_GT(apart.max_rows(), 30) << "nobody met: the test shows nothing";
    }
}

TEST(Shards, GiveTheSameBitsWithAnyThreads) {
  PhysicsConfig config;
  config.quick_above_rows = 40;
  const std::vector<std::uint64_t> one = Meeting(false, config).run(400);
  for (const int threads : {2, 3, 8}) {
    Meeting meeting(false, config);
    meeting.world().use_threads(threads);
    EXPECT_EQ(meeting.run(400), one) << threads;
  }
}

TEST(Shards, LoseAGroupWithoutLosingTheOthers) {
  // The first rover is the one in whose world the others are.
  Meeting meeting(true);
  meeting.run(30);
  meeting.world().remove_group(1);
  const int again = meeting.world().add_group("another");
  EXPECT_EQ(again, 1);
  meeting.world().add_body(again, body("box", {box({0.3, 0.3, 0.3}, 1)}), translation(5, 5, 0.15));
  meeting.world().close_group(again);
  for (int i = 30; i < 330; ++i) meeting.world().step(i);  // over a separation of the shards
  for (const auto& each : meeting.world().bodies()) {
    if (each && each->group() != 0) {
      EXPECT_LT(std::abs(each->X_WB().translation().z()), 1) << each->name();
    }
  }
}

TEST(Shards, ReportTheSameFaultWithAnyThreads) {
  const auto text_of = [](int threads) -> std::string {
    const auto world = make_world();
    world->use_threads(threads);
    add_ground(*world);
    std::vector<sim::Body*> balls;
    for (int i = 0; i < 40; ++i)
      balls.push_back(&add(*world, body("ball" + std::to_string(i), {sphere(0.1, 1)}), translation(i, 0, 1)));
    for (const int fast : {33, 17, 25}) balls[static_cast<std::size_t>(fast)]->set_velocity_W({0, 0, 1e7}, {0, 0, 0});
    try {
      world->step(0);
    } catch (const sim::PhysicsFault& fault) {
      return fault.what();
    }
    return "no fault";
  };
  const std::string one = text_of(1);
  EXPECT_NE(one.find("ball17"), std::string::npos) << one;
  for (const int threads : {2, 8}) EXPECT_EQ(text_of(threads), one) << threads;
}

}  // namespace
