// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <algorithm>

namespace sim {

/// Copy of what a step of ODE changes in a body, to take the step back.
class BodyCopy {
 public:
  explicit BodyCopy(dBodyID body) : body_(body) {
    each([](const dReal* from, dReal* to, int count) { std::copy_n(from, count, to); });
  }
  /// The numbers are written into ODE's memory, because its setters would round them.
  void write_back() {
    each([](const dReal* to, const dReal* from, int count) { std::copy_n(from, count, const_cast<dReal*>(to)); });
    dBodySetPosition(body_, p_[0], p_[1], p_[2]);  // marks the geoms as moved
  }
  dBodyID body() const { return body_; }
  void write_to(dBodyID other) {
    body_ = other;
    write_back();
  }

 private:
  template <class Visit>
  void each(const Visit& visit) {
    visit(dBodyGetPosition(body_), p_, 3);
    visit(dBodyGetQuaternion(body_), q_, 4);
    visit(dBodyGetRotation(body_), R_, 12);
    visit(dBodyGetLinearVel(body_), v_, 3);
    visit(dBodyGetAngularVel(body_), w_, 3);
    visit(dBodyGetForce(body_), force_, 3);
    visit(dBodyGetTorque(body_), torque_, 3);
  }
  dBodyID body_;
  dReal p_[3], q_[4], R_[12], v_[3], w_[3], force_[3], torque_[3];
};

}  // namespace sim
