// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <memory>

namespace sim {

/// Starts ODE once per process, and turns its errors into exceptions (PhysicsFault) instead of abort().  Call before
/// any other use of ODE; further calls are cheap.
void start_ode();
/// Number of messages of ODE in this thread.  In a step there is one kind: the exact solver gave up on an island, whose
/// forces are then incomplete.
std::int64_t ode_messages();

struct WorldDeleter {
  void operator()(dWorldID world) const { dWorldDestroy(world); }
};
struct SpaceDeleter {
  void operator()(dSpaceID space) const { dSpaceDestroy(space); }
};
struct GeomDeleter {
  void operator()(dGeomID geom) const { dGeomDestroy(geom); }
};
struct JointGroupDeleter {
  void operator()(dJointGroupID group) const { dJointGroupDestroy(group); }
};
struct TriMeshDataDeleter {
  void operator()(dTriMeshDataID data) const { dGeomTriMeshDataDestroy(data); }
};
struct HeightfieldDataDeleter {
  void operator()(dHeightfieldDataID data) const { dGeomHeightfieldDataDestroy(data); }
};
using WorldHandle = std::unique_ptr<dxWorld, WorldDeleter>;
using SpaceHandle = std::unique_ptr<dxSpace, SpaceDeleter>;
using GeomHandle = std::unique_ptr<dxGeom, GeomDeleter>;
using JointGroupHandle = std::unique_ptr<dxJointGroup, JointGroupDeleter>;
using TriMeshDataHandle = std::unique_ptr<dxTriMeshData, TriMeshDataDeleter>;
using HeightfieldDataHandle = std::unique_ptr<dxHeightfieldData, HeightfieldDataDeleter>;

}  // namespace sim
