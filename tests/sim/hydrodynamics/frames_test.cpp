// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "shoal/actuator_command_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/hydrodynamics/marine_worlds.hpp"

namespace {

using sim::Vector3d;

/// Numbers of a made-up set in forward-right-down with every coupling, printed in either frame.
class SkewedSet {
 public:
  explicit SkewedSet(bool frd) : sign_(frd ? 1 : -1) {}
  std::string text() const {
    std::ostringstream out;
    out.precision(17);
    out << "{frame: " << (sign_ > 0 ? "frd" : "flu") << ", mass_kg: 20, buoyancy_N: 190"
        << ", center_of_mass_m: " << vector({0.03, -0.01, 0.05})
        << ", center_of_buoyancy_m: " << vector({-0.01, 0.02, -0.04}) << ", inertia_kgm2: " << matrix(3, 2.0, 0.2)
        << ", added_mass: " << matrix(6, 9.0, 0.7) << ", linear_damping: " << matrix(6, 6.0, 0.4)
        << ", quadratic_damping: " << matrix(6, 8.0, 0.3)
        << ", cross_flow: {length_m: 1.2, height_m: 0.2}, hull_lift: {area_m2: 0.1, lift_slope: 1, induced_drag: 2}"
        << ", derivatives: {" << derivative("Y_uv", {1, 0, 1}, -3) << ", " << derivative("M_uw", {4, 0, 2}, -2) << ", "
        << derivative("N_|v|r", {5, 5}, -1.5) << ", " << derivative("Z_q", {2, 4}, -0.7) << ", "
        << derivative("X_rr", {0}, 0.3) << ", " << derivative("M_vv", {4}, -0.2) << ", "
        << derivative("M_ww", {4, 2}, -0.6) << ", " << derivative("K_pr", {3, 3, 5}, 0.4) << "}}";
    return out.str();
  }

 private:
  double flip(int i) const { return i == 0 || i == 3 ? 1 : sign_; }
  std::string vector(const Vector3d& v) const {
    std::ostringstream out;
    out << '[' << v.x() << ", " << sign_ * v.y() << ", " << sign_ * v.z() << ']';
    return out.str();
  }
  std::string matrix(int n, double diagonal, double beside) const {
    std::ostringstream out;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        out << (i + j == 0 ? "[" : ", ")
            << (i == j ? diagonal + i : flip(i) * flip(j) * beside * std::sin(1 + i * j + i + j));
    return out.str() + "]";
  }
  std::string derivative(const std::string& name, std::initializer_list<int> signs, double value) const {
    for (const int i : signs) value *= flip(i);
    return "'" + name + "': " + std::to_string(value);
  }
  double sign_;
};

TEST(Frames, TheSameSetInBothFramesGivesTheSameTrack) {
  const std::string medium = "{water: {}, current: {velocity_mps: [0.2, -0.1, 0.05]}}";
  test::TestWorld down(test::marine_world(SkewedSet(true).text(), medium, "", "0.005")),
      up(test::marine_world(SkewedSet(false).text(), medium, "", "0.005"));
  sim::Body &a = down.world.vehicles()[0]->body("hull"), &b = up.world.vehicles()[0]->body("hull");
  for (sim::Body* body : {&a, &b}) body->set_velocity_W({1.2, 0.3, -0.2}, {0.2, -0.1, 0.3});
  for (int i = 0; i < 2000; ++i) {
    down.world.step();
    up.world.step();
  }
  EXPECT_GT(a.X_WB().translation().head<2>().norm(), 1);
  EXPECT_LT((a.X_WB().matrix() - b.X_WB().matrix()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((a.v_WB_W() - b.v_WB_W()).norm(), 1e-9);
}

std::string remus_in(const Vector3d& current) {
  std::ostringstream out;
  out << "shoal: 1\nphysics: {step_s: 0.005}\nmedium: {water: {}, current: {velocity_mps: [" << current.x() << ", "
      << current.y() << ", " << current.z()
      << "]}}\nvehicles: [{name: auv, file: remus100.yaml, position_m: [0, 0, -50], rpy_deg: [30, -20, 70]}]\n";
  return out.str();
}

TEST(Frames, AUniformCurrentShiftsTheTrackAndNothingElse) {
  const Vector3d current(0.4, -0.3, 0.1);
  test::TestWorld still(remus_in(Vector3d::Zero())), moving(remus_in(current));
  sim::Body &a = still.world.vehicles()[0]->body("hull"), &b = moving.world.vehicles()[0]->body("hull");
  const Vector3d v(0.5, 1, 0.1), w(0.3, 0.1, -0.2);
  a.set_velocity_W(v, w);
  b.set_velocity_W(v + current, w);
  for (test::TestWorld* test : {&still, &moving}) {
    test->send("auv.propeller.cmd", shoal::actuator_command_t{0, 1200});
    test->send("auv.rudder.cmd", shoal::actuator_command_t{0, 0.1});
    test->send("auv.stern_planes.cmd", shoal::actuator_command_t{0, 0.05});
    test->run_for(60);
  }
  EXPECT_GT(a.X_WB().translation().head<2>().norm(), 5);
  // Rounding, which grows over 12,000 steps.
  EXPECT_LT((b.X_WB().translation() - a.X_WB().translation() - 60 * current).norm(), 1e-7);
  EXPECT_LT((b.X_WB().linear() - a.X_WB().linear()).cwiseAbs().maxCoeff(), 1e-8);
}

}  // namespace
