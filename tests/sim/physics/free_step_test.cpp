// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/free_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "tests/sim/physics/gravity.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;
using sim::Matrix3d;

struct Turning {
  Eigen::Quaterniond q_WB;
  Vector3d w_B;
};

/// The classical Runge-Kutta method for a rotation without torque.
Turning runge_kutta(Turning at, const Matrix3d& I, double step_s, int steps) {
  const Matrix3d inverse = I.inverse();
  struct Rate {
    Eigen::Vector4d q;
    Vector3d w;
  };
  const auto rate = [&](const Turning& of) {
    const Eigen::Quaterniond dq = of.q_WB * Eigen::Quaterniond(0, of.w_B.x() / 2, of.w_B.y() / 2, of.w_B.z() / 2);
    return Rate{dq.coeffs(), inverse * (I * of.w_B).cross(of.w_B)};
  };
  const auto moved = [](const Turning& of, const Rate& by, double h) {
    return Turning{Eigen::Quaterniond(Eigen::Vector4d(of.q_WB.coeffs() + h * by.q)), of.w_B + h * by.w};
  };
  for (int i = 0; i < steps; ++i) {
    const Rate a = rate(at), b = rate(moved(at, a, step_s / 2)), c = rate(moved(at, b, step_s / 2)),
               d = rate(moved(at, c, step_s));
    const Rate sum{(a.q + 2 * b.q + 2 * c.q + d.q) / 6, (a.w + 2 * b.w + 2 * c.w + d.w) / 6};
    at = moved(at, sum, step_s);
    at.q_WB.normalize();
  }
  return at;
}

/// A brick of three different moments of inertia, far from everything, without gravity.
class TumblingBrick : public testing::Test {
 protected:
  void start(double step_s, const Vector3d& w) {
    world_ = make_world(with_step(step_s, 0));
    brick_ = &add(*world_, body("brick", {box({0.1, 0.4, 1}, 5)}), Pose::Identity());
    brick_->set_velocity_W(Vector3d::Zero(), w);
  }
  Vector3d w_B() const { return brick_->X_WB().linear().transpose() * brick_->w_WB_W(); }
  Vector3d momentum_W() const { return brick_->X_WB().linear() * (brick_->inertia_C_B() * w_B()); }

  std::unique_ptr<PhysicsWorld> world_;
  sim::Body* brick_ = nullptr;
};

TEST_F(TumblingBrick, KeepsItsEnergyAndTheDirectionOfItsMomentum) {
  // 12 000 steps; each rounds to about 1e-16, of which the sum is far below 1e-10.
  start(0.005, {1, 10, 1});
  const Vector3d before_W = momentum_W();
  const double energy = momentum_W().dot(brick_->w_WB_W());
  run_for(*world_, 60);
  EXPECT_LT((momentum_W() - before_W).norm() / before_W.norm(), 1e-10);
  EXPECT_NEAR(momentum_W().dot(brick_->w_WB_W()) / energy, 1, 1e-10);
}

TEST_F(TumblingBrick, FlipsAboutItsMiddleAxisAsOftenAsByRungeKutta) {
  const Vector3d w0(0.01, 5, 0.01);
  start(0.005, w0);
  int flips = 0, expected = 0;
  double last = w0.y();
  Turning reference{Eigen::Quaterniond::Identity(), w0};
  double last_reference = w0.y();
  for (int i = 0; i < 6000; ++i) {  // 30 s
    world_->step(i);
    if (w_B().y() * last < 0) ++flips;
    last = w_B().y();
    reference = runge_kutta(reference, brick_->inertia_C_B(), 0.001, 5);
    if (reference.w_B.y() * last_reference < 0) ++expected;
    last_reference = reference.w_B.y();
  }
  EXPECT_GE(expected, 5);
  EXPECT_EQ(flips, expected);
}

TEST_F(TumblingBrick, ErrorFallsWithTheSquareOfTheStep) {
  const auto error_of = [&](double step_s) {
    const Vector3d w0(1, 4, 2);
    start(step_s, w0);
    run_for(*world_, 2);
    const Turning reference = runge_kutta({Eigen::Quaterniond::Identity(), w0}, brick_->inertia_C_B(), 1e-3, 2000);
    return reference.q_WB.angularDistance(Eigen::Quaterniond(Matrix3d(brick_->X_WB().linear())));
  };
  EXPECT_NEAR(std::log2(error_of(0.02) / error_of(0.01)), 2, 0.2);
}

TEST(FreeStep, FallsOnTheParabolaAtAnyStep) {
  for (const double step_s : {0.001, 0.05}) {
    const auto world = make_world(with_step(step_s, test::g));
    sim::Body& ball = add(*world, body("ball", {sphere(0.1, 2)}), translation(0, 0, 100));
    ball.set_velocity_W({3, 0, 4}, Vector3d::Zero());
    run_for(*world, 2);
    // Of a constant acceleration the mean velocity of each step is exact; the rest is rounding.
    EXPECT_NEAR(ball.X_WB().translation().x(), 6, 1e-10) << step_s;
    EXPECT_NEAR(ball.X_WB().translation().z(), 100 + 8 - test::g * 2, 1e-10) << step_s;
  }
}

TEST(FreeStep, IsTakenOnlyByBodiesThatTouchNothing) {
  const auto world = make_world(with_step(0.001, test::g));
  add_ground(*world);
  sim::Body& ball = add(*world, body("ball", {sphere(0.1, 2)}), translation(0, 0, 0.2));
  world->step(0);
  EXPECT_TRUE(ball.alone());
  for (int i = 1; i < 1000; ++i) world->step(i);
  EXPECT_FALSE(ball.alone());
  EXPECT_NEAR(ball.X_WB().translation().z(), 0.1, 1e-3);
}

TEST(FreeStep, LandsWithoutAJump) {
  // A ball that rolls off an edge, flies and lands: its velocity changes by gravity only until it lands, and its
  // position by its velocity.
  const double h = 0.001;
  const auto world = make_world(with_step(h, test::g));
  add_ground(*world);
  add(*world, body("table", {at(box({1, 1, 1}, 0), {0, 0, 0.5})}), Pose::Identity(), Motion::fixed);
  sim::Body& ball = add(*world, body("ball", {sphere(0.1, 2)}), translation(0.3, 0, 1.1));
  ball.set_velocity_W({1, 0, 0}, {0, 10, 0});
  Vector3d p = ball.X_WB().translation(), v = ball.v_WB_W();
  bool was_alone = false, flew = false, landed = false;
  for (int i = 0; i < 900; ++i) {
    world->step(i);
    const Vector3d p_after = ball.X_WB().translation(), v_after = ball.v_WB_W();
    const Vector3d slowest = v.cwiseMin(v_after), fastest = v.cwiseMax(v_after);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE((p_after - p)[axis], h * slowest[axis] - 1e-9) << i;
      EXPECT_LE((p_after - p)[axis], h * fastest[axis] + 1e-9) << i;
    }
    if (ball.alone()) {  // the velocity of ODE is that half a step earlier
      EXPECT_NEAR((v_after - v).z(), -(was_alone || i == 0 ? 1 : 1.5) * h * test::g, 1e-12) << i;
    }
    flew |= ball.alone();
    landed |= was_alone && !ball.alone();
    was_alone = ball.alone();
    p = p_after;
    v = v_after;
  }
  EXPECT_TRUE(flew);
  EXPECT_TRUE(landed);
}

/// A ball of 0.1 m radius that falls from 1 m over ground of this restitution.
class Bouncing {
 public:
  Bouncing(double restitution, double step_s) {
    sim::ContactConfig contact;
    contact.restitution = restitution;
    world_ = make_world(with_step(step_s), {contact});
    add_ground(*world_);
    ball_ = &add(*world_, body("ball", {sphere(0.1, 2)}), translation(0, 0, 1.1));
  }
  /// Steps on, and returns the greatest height over its rest.
  double highest_m(double time_s) {
    double highest_m = 0;
    const auto steps = std::lround(time_s / world_->step_s());
    for (int i = 0; i < steps; ++i) {
      world_->step(step_number_++);
      highest_m = std::max(highest_m, ball_->X_WB().translation().z() - 0.1);
    }
    return highest_m;
  }

 private:
  std::unique_ptr<PhysicsWorld> world_;
  sim::Body* ball_ = nullptr;
  std::int64_t step_number_ = 0;
};

TEST(FreeStep, ABallThatBouncesWithoutLossKeepsItsHeight) {
  for (const double step_s : {0.001, 0.005, 0.02}) {
    Bouncing ball(1, step_s);
    ball.highest_m(20);
    // 22 bounces.  A contact is found up to v h = 4.4 m/s h late, and each top up to g h^2 / 8 beside a step.
    EXPECT_NEAR(ball.highest_m(2), 1, 4.4 * step_s) << step_s;
  }
}

TEST(FreeStep, ABallThatLosesAFifthOfItsSpeedComesToRest) {
  for (const double step_s : {0.001, 0.005, 0.02}) {
    Bouncing ball(0.8, step_s);
    // 0.8^2 of the height after the first bounce, and a series of 4.1 s until rest.
    ball.highest_m(0.5);
    EXPECT_NEAR(ball.highest_m(0.8), 0.64, 4.4 * step_s) << step_s;
    ball.highest_m(8.7);
    EXPECT_LT(ball.highest_m(1), 0.001) << step_s;
  }
}

TEST(FreeStep, HasOrderTwoUnderATorqueOfTheWorld) {
  // A constant torque about a world axis on a brick that already turns.
  const auto turned = [](double step_s) {
    const auto world = make_world(with_step(step_s, 0));
    sim::Body& brick = add(*world, body("brick", {box({0.1, 0.4, 1}, 5)}), Pose::Identity());
    brick.set_velocity_W(Vector3d::Zero(), {0, 3, 1});
    const int steps = static_cast<int>(std::lround(2 / step_s));
    for (int i = 0; i < steps; ++i) {
      brick.add_torque_W({0, 0, 0.5});
      world->step(i);
    }
    return Eigen::Quaterniond(Matrix3d(brick.X_WB().linear()));
  };
  const Eigen::Quaterniond a = turned(0.02), b = turned(0.01), c = turned(0.005);
  EXPECT_NEAR(std::log2(a.angularDistance(b) / b.angularDistance(c)), 2, 0.2);
}

}  // namespace
