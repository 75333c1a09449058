// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/part_shape.hpp"

#include <algorithm>

namespace sim {

namespace {

constexpr std::string_view keys_of_solids[] = {"mass_kg", "displaces", "drag_coefficient", "added_mass_coefficient",
                                               "density_kgpm3"};

}  // namespace

const ShapeInfo& shape_info(PartShape shape) {
  // Drag: Hoerner, Fluid-Dynamic Drag (1965), chapter 3: sphere and cylinders below the critical Reynolds number, cube.
  static const ShapeInfo box{{"size_m"}, {}, true, false, Vector3d::Constant(1.05)};
  static const ShapeInfo sphere{{"radius_m"}, {}, true, true, Vector3d::Constant(0.47)};
  static const ShapeInfo capsule{{"radius_m", "length_m"}, {}, true, true, {1.1, 1.1, 0.3}};
  static const ShapeInfo cylinder{{"radius_m", "length_m"}, {}, true, true, {1.1, 1.1, 0.8}};
  static const ShapeInfo plane{{}, {}, false, false, Vector3d::Zero()};
  static const ShapeInfo mesh{{"mesh", "scale"}, "mesh", true, false, Vector3d::Ones()};
  static const ShapeInfo terrain{{"terrain"}, "terrain", false, false, Vector3d::Zero()};
  switch (shape) {
    case PartShape::box:
      return box;
    case PartShape::sphere:
      return sphere;
    case PartShape::capsule:
      return capsule;
    case PartShape::cylinder:
      return cylinder;
    case PartShape::plane:
      return plane;
    case PartShape::mesh:
      return mesh;
    case PartShape::terrain:
      break;
  }
  return terrain;
}

const std::vector<const char*>& keys_of_some_shapes() {
  static const std::vector<const char*> keys = {"size_m",
                                                "radius_m",
                                                "length_m",
                                                "mesh",
                                                "scale",
                                                "terrain",
                                                "mass_kg",
                                                "displaces",
                                                "drag_coefficient",
                                                "added_mass_coefficient",
                                                "density_kgpm3"};
  return keys;
}

bool has_key(PartShape shape, std::string_view key) {
  const ShapeInfo& info = shape_info(shape);
  const bool of_solids =
      std::find(std::begin(keys_of_solids), std::end(keys_of_solids), key) != std::end(keys_of_solids);
  return of_solids ? info.solid : std::find(info.keys.begin(), info.keys.end(), key) != info.keys.end();
}

}  // namespace sim
