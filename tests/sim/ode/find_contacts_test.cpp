// SPDX-License-Identifier: BSD-3-Clause
#include "sim/ode/find_contacts.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "sim/ode/ode_library.hpp"
#include "sim/ode/ode_math.hpp"
#include "tests/sim/ode/find_contacts_fixture.hpp"

namespace {

using namespace find_contacts_fixture;

TEST(FindContacts, FindsTheDepthOfASphereInATriangle) {
  // Its center is 0.45 m above the plane, and its radius 0.5 m.
  EXPECT_NEAR(sum_of_depths(100), 100 * 0.05, 1e-9);
}

using sim::Vector3d;

constexpr double tread_radius_m = 0.1, tread_half_m = 0.03, surface_layer_m = 0.0005;

/// A cylinder with its axis along y over the origin.
sim::GeomHandle lying_cylinder() {
  sim::start_ode();
  sim::GeomHandle geom(dCreateCylinder(nullptr, tread_radius_m, 2 * tread_half_m));
  dMatrix3 R;
  dRFromAxisAndAngle(R, 1, 0, 0, -std::numbers::pi / 2);
  dGeomSetRotation(geom.get(), R);
  dGeomSetPosition(geom.get(), 0, 0, tread_radius_m);
  return geom;
}

dContact contact_at(const Vector3d& p_W, double depth_m, const Vector3d& normal_W = Vector3d::UnitZ()) {
  dContact contact{};
  for (int i = 0; i < 3; ++i) {
    contact.geom.pos[i] = p_W[i];
    contact.geom.normal[i] = normal_W.normalized()[i];
  }
  contact.geom.depth = depth_m;
  return contact;
}

std::vector<dContact> on_the_middle(std::vector<dContact> contacts) {
  const sim::GeomHandle wheel = lying_cylinder();
  contacts.resize(static_cast<std::size_t>(sim::put_wheel_on_its_middle(wheel.get(), surface_layer_m, contacts)));
  return contacts;
}

double y_m(const dContact& contact) {
  return contact.geom.pos[1];
}

TEST(WheelContacts, OfALevelWheelAreOneInTheMiddle) {
  const auto contacts = on_the_middle({contact_at({0, -0.03, 0}, 0.0005), contact_at({0, 0.03, 0}, 0.0005)});
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(y_m(contacts[0]), 0, 1e-15);
  EXPECT_DOUBLE_EQ(contacts[0].geom.depth, 0.0005);
}

/// Tilted by d m on each side of the middle: the rim bears when it is deeper by more than the crown of 0.25 mm.
TEST(WheelContacts, OfATiltedWheelAreItsMiddleAndItsLowerRim) {
  const auto tilted_by = [](double d_m) {
    return on_the_middle({contact_at({0, -0.03, 0}, 0.0005 - d_m), contact_at({0, 0.03, 0}, 0.0005 + d_m)});
  };
  EXPECT_EQ(tilted_by(0.0001).size(), 1u);
  const auto contacts = tilted_by(0.0004);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_NEAR(y_m(contacts[0]), 0, 1e-15);
  EXPECT_NEAR(contacts[0].geom.depth, 0.0005, 1e-15);
  EXPECT_NEAR(y_m(contacts[1]), 0.03, 1e-15);
  EXPECT_NEAR(contacts[1].geom.depth, 0.0009 - 0.00025, 1e-15);
}

TEST(WheelContacts, OfARimAloneStayThere) {
  const auto contacts = on_the_middle({contact_at({0, 0.03, 0}, 0.0009)});
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(y_m(contacts[0]), 0.03, 1e-15);
  EXPECT_NEAR(contacts[0].geom.depth, 0.00065, 1e-15);
  EXPECT_EQ(on_the_middle({contact_at({0, 0.03, 0}, 0.0002)}).size(), 0u) << "not as deep as the crown";
}

/// A box under the left part of a wheel.
TEST(WheelContacts, AreInTheMiddleOfThePartThatIsSupported) {
  const auto contacts = on_the_middle({contact_at({0, 0.01, 0}, 0.0005), contact_at({0, 0.03, 0}, 0.0005)});
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(y_m(contacts[0]), 0.02, 1e-15);
}

TEST(WheelContacts, OfManyTrianglesAreOneInTheMiddle) {
  std::vector<dContact> contacts;
  for (const double at_m : {0.03, -0.01, 0.01, -0.03, 0.01, 0.0})
    contacts.push_back(contact_at({0.001, at_m, 0}, 0.0005));
  EXPECT_EQ(on_the_middle(contacts).size(), 1u);
}

TEST(WheelContacts, AreWhereTheGroundBulges) {
  const auto contacts = on_the_middle(
      {contact_at({0, -0.03, 0}, 0.0001), contact_at({0, 0.012, 0}, 0.0006), contact_at({0, 0.03, 0}, 0.0001)});
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(y_m(contacts[0]), 0.012, 1e-15);
}

TEST(WheelContacts, WithGroundAndAWallAreOneForEach) {
  const Vector3d back = -Vector3d::UnitX();
  const auto contacts = on_the_middle({contact_at({0, -0.03, 0}, 0.0005), contact_at({0.1, -0.03, 0.1}, 0.0005, back),
                                       contact_at({0, 0.03, 0}, 0.0005), contact_at({0.1, 0.03, 0.1}, 0.0005, back)});
  ASSERT_EQ(contacts.size(), 2u);
  for (const dContact& contact : contacts) EXPECT_NEAR(y_m(contact), 0, 1e-15);
  EXPECT_NE(contacts[0].geom.normal[2], contacts[1].geom.normal[2]);
}

TEST(WheelContacts, OfAFlatSideAreLeftAsTheyAre) {
  std::vector<dContact> side;
  for (const double x_m : {-0.1, 0.1}) side.push_back(contact_at({x_m, 0.03, 0.1}, 1e-6, -Vector3d::UnitY()));
  const auto contacts = on_the_middle(side);
  ASSERT_EQ(contacts.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(contacts[i].geom.depth, 1e-6);
    EXPECT_EQ(contacts[i].geom.pos[0], side[i].geom.pos[0]);
  }
}

TEST(WheelContacts, AreThoseOfWhatTurnsAboutItsOwnAxis) {
  const sim::GeomHandle wheel = lying_cylinder();
  const Vector3d middle_W(0, 0, tread_radius_m), y = Vector3d::UnitY();
  EXPECT_TRUE(sim::turns_about_its_axis(wheel.get(), middle_W, y));
  EXPECT_TRUE(sim::turns_about_its_axis(wheel.get(), middle_W + 0.3 * y, -2 * y)) << "an anchor beside it";
  EXPECT_FALSE(sim::turns_about_its_axis(wheel.get(), middle_W, Vector3d::UnitX())) << "a lever";
  EXPECT_FALSE(sim::turns_about_its_axis(wheel.get(), Vector3d::Zero(), y)) << "a cam";
  const sim::GeomHandle ball(dCreateSphere(nullptr, 0.1));
  EXPECT_FALSE(sim::turns_about_its_axis(ball.get(), Vector3d::Zero(), y));
}

}  // namespace
