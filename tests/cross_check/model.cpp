// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cross_check/model.hpp"

namespace cross_check {

Vector3d Solid::inertia_kgm2() const {
  switch (shape) {
    case Shape::box: {
      const Vector3d squares = size_m.cwiseProduct(size_m);
      return mass_kg / 12 * (Vector3d::Constant(squares.sum()) - squares);
    }
    case Shape::sphere:
      return Vector3d::Constant(0.4 * mass_kg * radius_m * radius_m);
    case Shape::cylinder:
      break;
  }
  const double across = mass_kg / 12 * (3 * radius_m * radius_m + length_m * length_m);
  return {across, across, 0.5 * mass_kg * radius_m * radius_m};
}

Solid box(const Vector3d& size_m, double mass_kg) {
  return {.shape = Solid::Shape::box, .size_m = size_m, .mass_kg = mass_kg};
}

Solid sphere(double radius_m, double mass_kg) {
  return {.shape = Solid::Shape::sphere, .radius_m = radius_m, .mass_kg = mass_kg};
}

Solid cylinder(double radius_m, double length_m, double mass_kg) {
  return {.shape = Solid::Shape::cylinder, .radius_m = radius_m, .length_m = length_m, .mass_kg = mass_kg};
}

}  // namespace cross_check
