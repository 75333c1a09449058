// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/choice_words.hpp"

namespace sim {

/// Shapes of parts.  What differs by shape asks by a switch without default, so that the compiler names the places
/// that a new shape has to fill in: ODE's geom and mass (sim/ode/part_shape.cpp), what water sees
/// (sim/hydrodynamics/immersed_piece.cpp), wheels on the ground, outlines in plots.
enum class PartShape { box, sphere, capsule, cylinder, plane, mesh, terrain };

inline constexpr ChoiceWords<PartShape> part_shape_words{
    {"box", PartShape::box},           {"sphere", PartShape::sphere}, {"capsule", PartShape::capsule},
    {"cylinder", PartShape::cylinder}, {"plane", PartShape::plane},   {"mesh", PartShape::mesh},
    {"terrain", PartShape::terrain}};

/// What is known of a shape without its sizes.
struct ShapeInfo {
  std::vector<std::string_view> keys;  ///< of a part of this shape alone
  std::string_view required_key;       ///< one of `keys`; empty: all have defaults
  bool solid;                          ///< encloses a volume: has mass, displaces water and may move
  bool round;                          ///< turning about its z axis does not change it
  Vector3d drag_coefficient;           ///< in water, along x, y and z
};

const ShapeInfo& shape_info(PartShape shape);

/// Keys of parts that make sense for some shapes only, in the order in which mistakes are reported.
const std::vector<const char*>& keys_of_some_shapes();
bool has_key(PartShape shape, std::string_view key);

}  // namespace sim
