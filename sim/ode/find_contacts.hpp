// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

namespace sim {

/// Finds the contacts of two geoms like dCollide(), for worlds in several threads.  ODE has one collider of meshes for
/// all worlds of a process; pairs with a mesh wait for each other.  No geom may be used by two threads at once.
///
/// The contacts of a sphere are on the sphere.  ODE puts those with boxes and meshes on their surface, so that a wheel
/// would roll on its radius less its depth in the ground, up to half of the surface layer.
int find_contacts(dGeomID first, dGeomID second, int max_contacts, dContactGeom* contacts, int skip_bytes);

}  // namespace sim
