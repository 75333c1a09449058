// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/physics_config.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

namespace {

using sim::Vector3d;

/// Reads YAML into a T; what is wrong with it goes to `errors`, a line each.
template <typename T>
T read(const std::string& yaml, std::vector<std::string>* errors = nullptr) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::parse_config_text(yaml, "worlds/test.yaml", diagnostics);
  sim::ParamReader in(node, "", diagnostics);
  in.declare("material", "default");
  in.declare("material", "rubber");
  in.declare("category", "solid");
  for (const char* body : {"chassis", "wheel", "world"}) in.declare("body", body);
  T value;
  value.read(in);
  in.finish();
  if (errors)
    *errors = diagnostics.lines();
  else
    EXPECT_EQ(diagnostics.lines(), std::vector<std::string>{});
  return value;
}

template <typename T>
std::string error_of(const std::string& yaml) {
  std::vector<std::string> errors;
  read<T>(yaml, &errors);
  return errors.empty() ? "no error" : errors.front();
}

TEST(PhysicsConfig, IsRead) {
  const auto config = read<sim::PhysicsConfig>("{step_s: 0.002, solver: quick, space: quadtree}");
  EXPECT_EQ(config.step_s, 0.002);
  EXPECT_EQ(config.solver, sim::PhysicsConfig::Solver::quick);
  EXPECT_EQ(config.space, sim::PhysicsConfig::Space::quadtree);
  EXPECT_EQ(config.gravity_mps2, 9.80665);
}

TEST(PhysicsConfig, StepIsAWholeNumberOfMicroseconds) {
  EXPECT_EQ(error_of<sim::PhysicsConfig>("{step_s: 0.0033333333}"),
            "worlds/test.yaml:1:10: 'step_s' must be a whole number of microseconds, got 0.0033333333 s");
  EXPECT_NE(error_of<sim::PhysicsConfig>("{step_s: 0}"), "no error");
  EXPECT_NE(error_of<sim::PhysicsConfig>("{step_s: 1e-7}"), "no error");
  EXPECT_EQ(error_of<sim::PhysicsConfig>("{step_s: 0.000001}"), "no error");
}

TEST(PartConfig, KnowsWhereItWasWritten) {
  const auto part = read<sim::PartConfig>("shape: sphere\nradius_m: 0.2\nrpy_deg: [90, 0, 0]\nmaterial: rubber\n");
  EXPECT_EQ(part.place.line, 1);
  EXPECT_EQ(part.directory, "worlds");
  EXPECT_NEAR(part.rpy_rad.x(), std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(part.material, "rubber");
}

TEST(PartConfig, ContradictionsAreErrors) {
  EXPECT_EQ(error_of<sim::PartConfig>("{mass_kg: 1, density_kgpm3: 1}"),
            "worlds/test.yaml:1:29: give 'mass_kg' or 'density_kgpm3', not both");
  EXPECT_NE(error_of<sim::PartConfig>("{size_m: [1, 0, 1]}"), "no error");
  EXPECT_NE(error_of<sim::PartConfig>("{mass_kg: -1}"), "no error");
  EXPECT_EQ(error_of<sim::PartConfig>("{shape: sphere, size_m: [1, 1, 1]}"),
            "worlds/test.yaml:1:25: 'size_m' does not apply to shape sphere");
  EXPECT_EQ(error_of<sim::PartConfig>("{shape: plane, mass_kg: 1}"),
            "worlds/test.yaml:1:25: 'mass_kg' does not apply to shape plane");
  EXPECT_NE(error_of<sim::PartConfig>("{shape: mesh}").find("a part of shape mesh needs the key 'mesh'"),
            std::string::npos);
  EXPECT_NE(error_of<sim::PartConfig>("{color: red}").find("'color' must look like #rrggbb"), std::string::npos);
  EXPECT_NE(error_of<sim::PartConfig>("{material: rubbre}"), "no error");
}

TEST(ContactConfig, NamesTwoMaterials) {
  EXPECT_EQ(read<sim::ContactConfig>("{between: [rubber, any], friction: 1.2}").friction, 1.2);
  EXPECT_NE(error_of<sim::ContactConfig>("{between: [rubber]}").find("must name two materials, got 1"),
            std::string::npos);
  EXPECT_NE(error_of<sim::ContactConfig>("{between: [rubber, ice]}"), "no error");
  EXPECT_NE(error_of<sim::ContactConfig>("{friction: 1}"), "no error");
}

TEST(JointConfig, KeysOfTheFirstAxisAreItsOwn) {
  const auto joint = read<sim::JointConfig>(
      "{name: front, type: hinge2, bodies: [chassis, wheel], axis: [0, 0, 2], low_stop: -0.5, "
      "axis2: {axis: [0, 1, 0], motor_max_force: 3}}");
  EXPECT_EQ(joint.axis1.axis, Vector3d(0, 0, 2));
  EXPECT_EQ(joint.axis1.low_stop, -0.5);
  EXPECT_EQ(joint.axis2.motor_max_force, 3);
}

TEST(JointConfig, MistakesAreErrors) {
  const auto error = [](const std::string& rest) {
    return error_of<sim::JointConfig>("{name: left, bodies: [chassis, wheel], " + rest + "}");
  };
  EXPECT_NE(error("axis: [0, 0, 0]").find("'axis' must not be zero"), std::string::npos);
  EXPECT_NE(error("low_stop: 1, high_stop: 0").find("'low_stop' must not be above 'high_stop'"), std::string::npos);
  EXPECT_NE(error("low_stop: -13").find("between -4 pi and 4 pi, got -13"), std::string::npos);
  EXPECT_EQ(error("low_stop: -12.5, high_stop: 12.5").find("stops of"), std::string::npos);
  EXPECT_NE(error("type: ball, motor: true, high_stop: 4").find("between -pi and pi, got 4"), std::string::npos);
  EXPECT_NE(error("type: universal, axis2: {axis: [0, 0, -1]}").find("must not be parallel"), std::string::npos);
  EXPECT_NE(error("axis2: {axis: [0, 1, 0]}").find("has no second axis"), std::string::npos);
  EXPECT_NE(error_of<sim::JointConfig>("{name: left, bodies: [wheel]}").find("must name two bodies, got 1"),
            std::string::npos);
  EXPECT_NE(error_of<sim::JointConfig>("{name: left, bodies: [world, wheel]}").find("only be the second"),
            std::string::npos);
  EXPECT_NE(error_of<sim::JointConfig>("{name: left, bodies: [wheel, wheel]}").find("two different bodies"),
            std::string::npos);
  EXPECT_NE(error_of<sim::JointConfig>("{name: left, bodies: [chassis, wheeel]}"), "no error");
}

TEST(PhysicsConfig, EveryKeyIsDescribed) {
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  sim::BodyConfig body;
  body.read(in);
  sim::JointConfig joint;
  joint.read(in);
  sim::ContactConfig contact;
  contact.read(in);
  for (const sim::ParamInfo& info : table) EXPECT_FALSE(info.meaning.empty()) << info.key;
  EXPECT_GT(table.size(), 20u);
}

}  // namespace
