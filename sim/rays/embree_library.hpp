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

/// The device of this process.  It is bound to AVX2 where there is AVX2: another instruction set rounds hits on
/// triangles another way.
RTCDevice embree_device();
/// Throws std::runtime_error with Embree's text when a call of this thread failed.
void check_embree();
/// Builds on the calling thread alone, so that a step does not wait for workers that are busy elsewhere.
void commit_alone(RTCScene scene);

}  // namespace sim
