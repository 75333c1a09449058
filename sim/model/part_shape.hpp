// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/choice_words.hpp"

namespace sim {

/// Shapes of parts.  Code that depends on the shape uses a switch without default, so that the compiler reports every
/// place to extend for a new shape: ODE's geom and mass (sim/ode/part_shape.cpp), immersed volume
/// (sim/hydrodynamics/immersed_piece.cpp), wheels on the ground, outlines in plots.
enum class PartShape { box, sphere, capsule, cylinder, plane, mesh, terrain };

inline constexpr ChoiceWords<PartShape> part_shape_words{
    {"box", PartShape::box},           {"sphere", PartShape::sphere}, {"capsule", PartShape::capsule},
    {"cylinder", PartShape::cylinder}, {"plane", PartShape::plane},   {"mesh", PartShape::mesh},
    {"terrain", PartShape::terrain}};

/// Properties of a shape that do not depend on its dimensions.
struct ShapeInfo {
  std::vector<std::string_view> keys;  ///< keys specific to this shape
  std::string_view required_key;       ///< one of `keys`; empty: none is required
  bool solid;                          ///< encloses a volume: has mass, displaces water and may move
  bool round;                          ///< rotational symmetry about z
  Vector3d drag_coefficient;           ///< default in water, along x, y and z
};

/// Returns the properties of a shape.
const ShapeInfo& shape_info(PartShape shape);

/// Returns the keys of parts that apply to some shapes only, in the order in which errors are reported.
const std::vector<const char*>& keys_of_some_shapes();
/// Returns true when a key applies to a shape.
bool has_key(PartShape shape, std::string_view key);

}  // namespace sim
