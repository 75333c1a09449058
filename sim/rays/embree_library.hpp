// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <embree3/rtcore.h>

#include <memory>

namespace sim {

struct EmbreeSceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct EmbreeGeometryDeleter {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using EmbreeSceneHandle = std::unique_ptr<RTCSceneTy, EmbreeSceneDeleter>;
using EmbreeGeometryHandle = std::unique_ptr<RTCGeometryTy, EmbreeGeometryDeleter>;

/// Embree device of this process.  It is restricted to AVX2 where available: other instruction sets round hits on
/// triangles differently.
RTCDevice embree_device();
/// Throws std::runtime_error with Embree's message when a call of this thread failed.
void check_embree();
/// Builds a scene on the calling thread alone, so that a step does not wait for busy worker threads.
void commit_alone(RTCScene scene);

}  // namespace sim
