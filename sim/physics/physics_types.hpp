// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/scene/material.hpp"

// What PhysicsWorld tells about its content and its steps.

namespace sim {

/// Part of a body as created.
struct PartInfo {
  std::string name;
  int group = -1;    ///< -1: the part was removed, and the other members are invalid
  int body = -1;     ///< number in PhysicsWorld::bodies()
  int material = 0;  ///< see PhysicsWorld::material
  std::uint32_t category = 1;
  Pose X_BP = Pose::Identity();  ///< of the part in its body
  std::optional<Color> color;    ///< own color; else that of the material
  bool plane = false;            ///< infinite
};

/// Numbers of a group and of its bodies, parts and joints, in order of creation.
struct GroupNumbers {
  int group = -1;
  std::vector<int> bodies, parts, joints;
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(group, bodies, parts, joints);
  }
};

/// Poses at the creation of a joint to the world: the zero of its position in ODE.
struct JointPlace {
  Pose X_WV = Pose::Identity();
  Pose X_WC = Pose::Identity();  ///< of the moving body
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(X_WV, X_WC);
  }
};

/// Amount of work in the last step; deterministic.
struct StepCounts {
  int contacts = 0;
  int max_island_rows = 0;
  bool quick = false;  ///< some island was stepped as a crowd or by QuickStep
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(contacts, max_island_rows, quick);
  }
};

/// Island: bodies that the solver treats together.
struct IslandInfo {
  int rows = 0;                     ///< constraint rows
  std::vector<std::string> bodies;  ///< by number; at most the first 1000
  std::size_t body_count = 0;
};

/// Body that moved further than its own size in a step.
struct Leap {
  int body = -1;  ///< number
  double moved_m = 0;
  double size_m = 0;  ///< of its parts, along its motion
};

}  // namespace sim
