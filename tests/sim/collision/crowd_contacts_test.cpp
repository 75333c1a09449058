// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/crowd_contacts.hpp"

#include <gtest/gtest.h>

#include "sim/ode/ode_math.hpp"

namespace {

using sim::Matrix3d;
using sim::Vector3d;

constexpr double step_s = 0.01;

/// Bodies on the x axis, each its own vehicle, and contacts between them.
class Crowd {
 public:
  Crowd() : world_((sim::start_ode(), dWorldCreate())), contacts_({step_s, 0.2, 0, 0, 1}) {}

  dBodyID add(double x_m, double v_x_mps, double mass_kg) {
    const dBodyID body = dBodyCreate(world_.get());
    dBodySetPosition(body, x_m, 0, 0);
    dBodySetLinearVel(body, v_x_mps, 0, 0);
    contacts_.add_body(body, mass_kg, Matrix3d::Identity(), vehicles_++);
    return body;
  }
  /// A contact half way between two bodies, with the first one on the right.
  void touch(sim::Collider::Between& between, dBodyID right, dBodyID left) {
    between = {};
    between.contact.geom.normal[0] = 1;  // out of the second body
    for (int i = 0; i < 3; ++i)
      between.contact.geom.pos[i] = (dBodyGetPosition(right)[i] + dBodyGetPosition(left)[i]) / 2;
    between.bodies[0] = right;
    between.bodies[1] = left;
    between.joint = dJointCreateContact(world_.get(), group_.get(), &between.contact);
    contacts_.add_contact(between);
  }
  void solve() { contacts_.solve(); }

 private:
  sim::WorldHandle world_;
  sim::JointGroupHandle group_{dJointGroupCreate(0)};
  sim::CrowdContacts contacts_;
  int vehicles_ = 0;
};

TEST(CrowdContacts, StopTwoVehiclesThatMeet) {
  Crowd crowd;
  const dBodyID left = crowd.add(-1, 2, 3), right = crowd.add(1, -2, 3);
  sim::Collider::Between between;
  crowd.touch(between, right, left);
  crowd.solve();
  // 3 kg that lose 2 m/s in 10 ms.
  EXPECT_NEAR(dBodyGetForce(right)[0], 600, 1e-9);
  EXPECT_NEAR(dBodyGetForce(left)[0], -600, 1e-9);
}

TEST(CrowdContacts, DoNotPull) {
  Crowd crowd;
  const dBodyID left = crowd.add(-1, -2, 3), right = crowd.add(1, 2, 3);
  sim::Collider::Between between;
  crowd.touch(between, right, left);
  crowd.solve();
  EXPECT_EQ(dBodyGetForce(right)[0], 0);
}

TEST(CrowdContacts, GiveUnequalVehiclesTheirCommonVelocity) {
  Crowd crowd;
  const dBodyID left = crowd.add(-1, 4, 1), right = crowd.add(1, 0, 3);
  sim::Collider::Between between;
  crowd.touch(between, right, left);
  crowd.solve();
  // Both continue at 1 m/s: the momentum is 4 N s, the mass 4 kg.
  EXPECT_NEAR(dBodyGetForce(right)[0] * step_s / 3, 1, 1e-12);
  EXPECT_NEAR(4 + dBodyGetForce(left)[0] * step_s / 1, 1, 1e-12);
}

TEST(CrowdContacts, IncludeTheForcesThatWereAddedBefore) {
  Crowd crowd;
  const dBodyID left = crowd.add(-1, 2, 3), right = crowd.add(1, -2, 3);
  sim::Collider::Between between;
  crowd.touch(between, right, left);
  dBodyAddForce(left, 100, 0, 0);
  crowd.solve();
  // The left one would be 100 N * 10 ms / 3 kg = 1/3 m/s faster; each changes by 2 + 1/6 m/s.
  EXPECT_NEAR(dBodyGetForce(right)[0], 3 * (2 + 1.0 / 6) / step_s, 1e-9);
}

TEST(CrowdContacts, CannotSolveWhatLiesOnAVehicle) {
  dContact contact = {};
  contact.geom.normal[0] = 1;
  EXPECT_TRUE(sim::CrowdContacts::can_solve(contact));
  contact.geom.normal[2] = 0.31;
  EXPECT_FALSE(sim::CrowdContacts::can_solve(contact));
  contact.geom.normal[2] = 0;
  contact.surface.mode = dContactRolling;
  EXPECT_FALSE(sim::CrowdContacts::can_solve(contact));
}

}  // namespace
