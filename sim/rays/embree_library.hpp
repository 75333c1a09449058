// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

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

/// Query of rays in a scene: what versions 3 and 4 of Embree name differently.  Callbacks get its address as
/// `arguments->context`; a struct that has it as its first member gets to the rest by that.
class RayQuery {
 public:
  explicit RayQuery(bool coherent) {
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context_);
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    intersect_.context = occluded_.context = &context_;
    if (coherent) intersect_.flags = occluded_.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
    rtcInitIntersectContext(&context_);
    if (coherent) context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
  }
  RayQuery(const RayQuery&) = delete;
  RayQuery& operator=(const RayQuery&) = delete;

  /// Sets the filter of hits for scenes with `filter_flag`.
  void set_filter(RTCFilterFunctionN filter) {
#if RTC_VERSION_MAJOR >= 4
    intersect_.filter = filter;
    intersect_.flags = static_cast<RTCRayQueryFlags>(intersect_.flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
  }
  static constexpr RTCSceneFlags filter_flag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
    context_.filter = filter;
  }
  static constexpr RTCSceneFlags filter_flag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

#if RTC_VERSION_MAJOR >= 4
  void intersect(RTCScene scene, RTCRayHit& ray) {
    rtcIntersect1(scene, &ray, &intersect_);
  }
  void intersect(RTCScene scene, const int* valid, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &rays, &intersect_);
  }
  void find_occluded(RTCScene scene, RTCRay& ray) {
    rtcOccluded1(scene, &ray, &occluded_);
  }
  void find_occluded(RTCScene scene, const int* valid, RTCRay8& rays) {
    rtcOccluded8(valid, scene, &rays, &occluded_);
  }

 private:
  RTCRayQueryContext context_;  // first: see above
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
#else
  void intersect(RTCScene scene, RTCRayHit& ray) {
    rtcIntersect1(scene, &context_, &ray);
  }
  void intersect(RTCScene scene, const int* valid, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &context_, &rays);
  }
  void find_occluded(RTCScene scene, RTCRay& ray) {
    rtcOccluded1(scene, &context_, &ray);
  }
  void find_occluded(RTCScene scene, const int* valid, RTCRay8& rays) {
    rtcOccluded8(valid, scene, &context_, &rays);
  }

 private:
  RTCIntersectContext context_;
#endif
};

/// Embree device of this process.  It is restricted to AVX2 where available: other instruction sets round hits on
/// triangles differently.
RTCDevice embree_device();
/// Throws std::runtime_error with Embree's message when a call of this thread failed.
void check_embree();
/// Builds a scene on the calling thread alone, so that a step does not wait for busy worker threads.
void commit_alone(RTCScene scene);

}  // namespace sim
