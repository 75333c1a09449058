// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "sim/base/processor.hpp"
#include "sim/rays/embree_library.hpp"
#include "sim/rays/ray_shape.hpp"

namespace sim {

/// Packet of rays in single precision, in Embree's format, to find what a ray may hit.  Each ray starts where it enters
/// the sphere around all shapes, so that no coordinate is larger than its radius.
class FloatRays {
 public:
  /// Maximum deviation of a float ray from the exact ray, relative to the radius.  Origin and direction are rounded
  /// (2^-24 each, over up to two radii), and Embree's box tests add a few roundings: about 15 in all.
  static constexpr double rounding = 1e-6;

  explicit FloatRays(double radius_m)
      : margin_m_(static_cast<float>(2 * rounding * radius_m)), square_radius_m2_(radius_m * radius_m) {}

  /// Sets the rays of `lanes` (bits), relative to the center of the sphere: x of all lanes, y, z.  The other lanes may
  /// hold any numbers.  Rays that miss the sphere or end before it are dropped.  A single ray is not packed.
  void aim(const double (&from)[3][RayPacket::size], const double (&direction)[3][RayPacket::size],
           const double (&range_m)[RayPacket::size], unsigned lanes) {
    if (std::has_single_bit(lanes)) {
      count_ = 1;
      const int lane = std::countr_zero(lanes);
      set_start(lane, {from[0][lane], from[1][lane], from[2][lane]},
                {direction[0][lane], direction[1][lane], direction[2][lane]});
      fill_one(lane, from, direction, range_m[lane]);
      return;
    }
    count_ = RayPacket::size;
    static const auto best = has_avx2() ? aim_all_avx2 : aim_all_baseline;
    best(*this, from, direction, range_m, lanes);
  }

  /// Returns Embree's tfar of a ray whose nearest hit is at `range_m`: long enough for all hits that could be nearer.
  float limit_m(int lane, double range_m) const {
    return static_cast<float>(range_m - start_m_[lane]) * (1 + 0x1p-21f) + margin_m_;
  }

  /// Difference of tfar below which rounding may exchange the order of two hits.
  float margin_m() const { return margin_m_; }
  double start_m(int lane) const { return start_m_[lane]; }

  /// Nearest hit on a triangle, with its barycentric coordinates.
  struct TriangleHit {
    float tfar = 0, u = 0, v = 0;
    std::uint32_t triangle = 0;
    bool any = false;
  };
  /// Returns the hit that intersect() found without a filter.
  TriangleHit triangle_hit(int lane) const {
    if (count_ == 1) {
      const auto& one = *reinterpret_cast<const RTCRayHit*>(data_);
      return {one.ray.tfar, one.hit.u, one.hit.v, one.hit.primID, one.hit.geomID != RTC_INVALID_GEOMETRY_ID};
    }
    const auto& all = *reinterpret_cast<const RTCRayHit8*>(data_);
    return {all.ray.tfar[lane], all.hit.u[lane], all.hit.v[lane], all.hit.primID[lane],
            all.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID};
  }

  /// Finds hits.
  void intersect(RTCScene scene, RayQuery& query) {
    if (none()) return;
    if (count_ == 1)
      query.intersect(scene, *reinterpret_cast<RTCRayHit*>(data_));
    else
      query.intersect(scene, valid_, *reinterpret_cast<RTCRayHit8*>(data_));
  }
  void find_occluded(RTCScene scene, RayQuery& query) {
    if (none()) return;
    if (count_ == 1)
      query.find_occluded(scene, *reinterpret_cast<RTCRay*>(data_));
    else
      query.find_occluded(scene, valid_, *reinterpret_cast<RTCRay8*>(data_));
  }

 private:
  /// Sets the start of a ray to where it enters the sphere, or slightly before its origin: the rounded origin must not
  /// be behind a surface that the exact one is in front of.  NaN, which Embree skips, when it misses the sphere.
  void set_start(int lane, const Vector3d& from, const Vector3d& direction) {
    start_m_[lane] = -margin_m_;
    if (from.squaredNorm() <= square_radius_m2_) return;
    const double along = -from.dot(direction);
    const double rest = square_radius_m2_ - (from + along * direction).squaredNorm();
    start_m_[lane] = along > 0 && rest >= 0 ? along - std::sqrt(rest) - margin_m_ : std::nan("");
  }
  void fill_one(int lane, const double (&from)[3][RayPacket::size], const double (&direction)[3][RayPacket::size],
                double range_m) {
    // Layout of RTCRay: origin, tnear, direction, time, tfar, mask, id, flags.
    float sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      data_[axis] = static_cast<float>(from[axis][lane] + start_m_[lane] * direction[axis][lane]);
      data_[4 + axis] = static_cast<float>(direction[axis][lane]);
      sum += data_[axis] + data_[4 + axis];
    }
    RTCRay& ray = *reinterpret_cast<RTCRay*>(data_);
    ray.tnear = ray.time = 0;
    ray.tfar = limit_m(lane, range_m);
    ray.mask = ~0u;
    ray.id = static_cast<unsigned>(lane);
    ray.flags = 0;
    reinterpret_cast<RTCRayHit*>(data_)->hit.geomID = RTC_INVALID_GEOMETRY_ID;
    // The condition is false for NaN.
    valid_[0] = ray.tfar >= 0 && std::abs(sum) < std::numeric_limits<float>::infinity() ? -1 : 0;
  }
  using Aim = void(FloatRays& out, const double (&from)[3][RayPacket::size],
                   const double (&direction)[3][RayPacket::size], const double (&range_m)[RayPacket::size],
                   unsigned lanes);
  static Aim aim_all, aim_all_baseline, aim_all_avx2;
  bool none() const {
    int any = 0;
    for (unsigned i = 0; i < count_; ++i) any |= valid_[i];
    return any == 0;
  }

  alignas(64) float data_[sizeof(RTCRayHit8) / sizeof(float)];
  alignas(64) int valid_[RayPacket::size];
  double start_m_[RayPacket::size];
  unsigned count_ = RayPacket::size;
  float margin_m_;
  double square_radius_m2_;
};

}  // namespace sim
