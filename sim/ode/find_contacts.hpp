// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <span>

#include "sim/base/math.hpp"

namespace sim {

/// Finds the contacts of two geoms like dCollide(), for worlds in several threads.  ODE has one collider of meshes for
/// all worlds of a process; pairs with a mesh wait for each other.  No geom may be used by two threads at once.
///
/// The contacts of a sphere are on the sphere.  ODE puts those with boxes and meshes on their surface, so that a wheel
/// would roll on its radius less its depth in the ground, up to half of the surface layer.
int find_contacts(dGeomID first, dGeomID second, int max_contacts, dContactGeom* contacts, int skip_bytes);

/// Whether a geom is a cylinder or capsule that turns about its own axis: about a line through `at_W` along `axis_W`.
bool turns_about_its_axis(dGeomID geom, const Vector3d& at_W, const Vector3d& axis_W);

/// Moves the contacts of a wheel, a cylinder or capsule that turns about its axis, with one other geom from its rims to
/// its middle, and returns their new number, at most the old one.
///
/// ODE's contacts of a cylinder on its side are on both rims, equally deep.  How its load is shared between them is
/// then undetermined, the solver gives all of it to one of them, and friction acts there: the wheel turns a vehicle as
/// if it stood on that rim.  Here the tread is slightly crowned: on level ground a wheel stands on its middle, and on a
/// rim, which is lower by half of the surface layer `layer_m`, only when it tilts by more than the crown; a roller
/// does not tip over.  In detail, contacts with about one normal along one line of the tread become one in the middle
/// of the line, where a deeper one between its ends is not, and one at the deeper end if that is then the deeper of
/// both, or nearly so.  Contacts of the flat sides are left as they are.
int put_wheel_on_its_middle(dGeomID wheel, double layer_m, std::span<dContact> contacts);

}  // namespace sim
