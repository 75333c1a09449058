// SPDX-License-Identifier: BSD-3-Clause
#include "sim/ode/find_contacts.hpp"

#include <mutex>

namespace sim {

int find_contacts(dGeomID first, dGeomID second, int max_contacts, dContactGeom* contacts, int skip_bytes) {
  static std::mutex meshes;
  std::unique_lock<std::mutex> lock(meshes, std::defer_lock);
  if (dGeomGetClass(first) == dTriMeshClass || dGeomGetClass(second) == dTriMeshClass) lock.lock();
  return dCollide(first, second, max_contacts, contacts, skip_bytes);
}

}  // namespace sim
