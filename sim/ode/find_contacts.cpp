// SPDX-License-Identifier: BSD-3-Clause
#include "sim/ode/find_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "sim/ode/ode_math.hpp"

namespace sim {
namespace {

/// Whether ODE puts the contacts of a sphere with such a geom on or near the surface of that.
bool attracts_contacts(dGeomID geom) {
  switch (dGeomGetClass(geom)) {
    case dBoxClass:
    case dCapsuleClass:
    case dCylinderClass:
    case dTriMeshClass:
      return true;
    default:
      return false;
  }
}

/// Puts contacts on a sphere, where they are with planes and terrains.  Deep ones are of bodies that were put into each
/// other, and stay.
void put_on_sphere(dGeomID sphere, dContactGeom& contact) {
  constexpr dReal deep = 0.2;
  const dReal radius = dGeomSphereGetRadius(sphere);
  if (contact.depth > deep * radius) return;
  const dReal* const center = dGeomGetPosition(sphere);
  // The normal points into the first geom.
  const dReal reach = contact.g1 == sphere ? -radius : radius;
  for (int i = 0; i < 3; ++i) contact.pos[i] = center[i] + reach * contact.normal[i];
}

}  // namespace

int find_contacts(dGeomID first, dGeomID second, int max_contacts, dContactGeom* contacts, int skip_bytes) {
  static std::mutex meshes;
  std::unique_lock<std::mutex> lock(meshes, std::defer_lock);
  // ODE keeps temporal data of triangle meshes in the geoms, so collisions with them are not thread-safe.
  if (dGeomGetClass(first) == dTriMeshClass || dGeomGetClass(second) == dTriMeshClass) lock.lock();
  const int count = dCollide(first, second, max_contacts, contacts, skip_bytes);
  const bool is_first = dGeomGetClass(first) == dSphereClass;
  const dGeomID sphere = is_first ? first : second;
  if (dGeomGetClass(sphere) == dSphereClass && attracts_contacts(is_first ? second : first))
    for (int i = 0; i < count; ++i)
      put_on_sphere(sphere, *reinterpret_cast<dContactGeom*>(reinterpret_cast<char*>(contacts) + i * skip_bytes));
  return count;
}

namespace {

/// A cylinder, or a capsule without its caps.
struct Tread {
  Vector3d center_W, axis_W;
  double radius_m, half_width_m;

  double along_m(const dContactGeom& contact) const { return axis_W.dot(to_eigen(contact.pos) - center_W); }
  /// 1 on the tread, 0 from 45 degrees on towards the flat sides.
  double share_of_tread(const dContactGeom& contact) const {
    const double cosine = axis_W.dot(to_eigen(contact.normal));
    return std::max(0.0, 1 - 2 * cosine * cosine);
  }
  /// Whether two contacts have about one normal, and are on one line along the axis.
  bool on_one_line(const dContactGeom& a, const dContactGeom& b) const {
    if (to_eigen(a.normal).dot(to_eigen(b.normal)) < 0.98) return false;
    const Vector3d between_W = to_eigen(b.pos) - to_eigen(a.pos);
    return (between_W - axis_W.dot(between_W) * axis_W).norm() < 0.2 * radius_m;
  }
};

Tread tread_of(dGeomID geom) {
  dReal radius_m, length_m;
  if (dGeomGetClass(geom) == dCapsuleClass)
    dGeomCapsuleGetParams(geom, &radius_m, &length_m);
  else
    dGeomCylinderGetParams(geom, &radius_m, &length_m);
  const dReal* R = dGeomGetRotation(geom);
  return {to_eigen(dGeomGetPosition(geom)), {R[2], R[6], R[10]}, radius_m, length_m / 2};
}

/// Replaces the contacts on a line of the tread.  Returns how many are left, 1 or 2, at the front.
int put_on_middle(const Tread& tread, double crown_m, std::span<dContact> line) {
  const auto crowned = [&](dContactGeom contact) {
    const double part = std::min(1.0, std::abs(tread.along_m(contact)) / tread.half_width_m);
    contact.depth -= crown_m * part * part * tread.share_of_tread(contact);
    return contact;
  };
  const auto [first, last] = std::minmax_element(line.begin(), line.end(), [&](const dContact& a, const dContact& b) {
    return tread.along_m(a.geom) < tread.along_m(b.geom);
  });
  const dContactGeom ends[] = {first->geom, last->geom};
  const dContactGeom& deeper = ends[ends[0].depth < ends[1].depth ? 1 : 0];
  const double from_m = tread.along_m(ends[0]), width_m = tread.along_m(ends[1]) - from_m;
  if (width_m < 0.01 * tread.half_width_m) {
    line[0].geom = crowned(deeper);
    return 1;
  }
  // The middle of the line, or where the ground bulges.
  dContactGeom middle = deeper;
  Vector3d normal_W = to_eigen(ends[0].normal) + to_eigen(ends[1].normal);
  normal_W.normalize();
  for (int i = 0; i < 3; ++i) {
    middle.pos[i] = (ends[0].pos[i] + ends[1].pos[i]) / 2;
    middle.normal[i] = normal_W[i];
  }
  middle.depth = (ends[0].depth + ends[1].depth) / 2;
  double max_m = 1e-6;
  for (const dContact& contact : line) {
    const double part = (tread.along_m(contact.geom) - from_m) / width_m;
    const double bulge_m = contact.geom.depth - (1 - part) * ends[0].depth - part * ends[1].depth;
    if (!(bulge_m > max_m)) continue;
    max_m = bulge_m;
    middle = contact.geom;
  }
  const bool tilts = deeper.depth > middle.depth + crown_m / 2;
  line[0].geom = crowned(middle);
  line[1].geom = crowned(deeper);
  return tilts ? 2 : 1;
}

}  // namespace

bool turns_about_its_axis(dGeomID geom, const Vector3d& at_W, const Vector3d& axis_W) {
  const int geom_class = dGeomGetClass(geom);
  if (geom_class != dCylinderClass && geom_class != dCapsuleClass) return false;
  const Tread tread = tread_of(geom);
  const Vector3d axis = axis_W.normalized();
  return std::abs(axis.dot(tread.axis_W)) > 0.999 && axis.cross(tread.center_W - at_W).norm() < 0.05 * tread.radius_m &&
         tread.half_width_m > 0;
}

int put_wheel_on_its_middle(dGeomID wheel, double layer_m, std::span<dContact> contacts) {
  const Tread tread = tread_of(wheel);
  const double crown_m = layer_m / 2;
  std::size_t kept = 0;
  for (std::size_t i = 0, end = 0; i < contacts.size(); i = end) {
    end = i + 1;
    int count = 1;
    if (tread.share_of_tread(contacts[i].geom) > 0) {
      // Gather those on its line.
      for (std::size_t j = end; j < contacts.size(); ++j)
        if (tread.on_one_line(contacts[i].geom, contacts[j].geom)) std::swap(contacts[end++].geom, contacts[j].geom);
      count = put_on_middle(tread, crown_m, contacts.subspan(i, end - i));
    }
    for (int k = 0; k < count; ++k)
      if (const dContactGeom contact = contacts[i + static_cast<std::size_t>(k)].geom; contact.depth >= 0)
        contacts[kept++].geom = contact;
  }
  return static_cast<int>(kept);
}

}  // namespace sim
