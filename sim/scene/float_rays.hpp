#pragma once

#include <embree3/rtcore.h>

#include <bit>
#include <cmath>

#include "sim/scene/ray_shape.hpp"

namespace sim {

/// A packet of rays in single precision, as Embree wants it, to find what a ray may hit.  Each ray starts where it
/// enters the sphere around all there is to hit, so that no number is larger than that sphere.
class FloatRays {
 public:
  /// How far a float ray may be from the true one, as a part of the radius.  Its origin and its direction are rounded
  /// (2^-24 each, over up to two radii), and the tests of Embree's boxes add a few roundings more: about 15 in all.
  static constexpr double rounding = 1e-6;

  /// For the rays of `lanes` (bits); a lone one is not packed.
  FloatRays(double radius_m, unsigned lanes)
      : count_(std::has_single_bit(lanes) ? 1 : RayPacket::size),
        margin_m_(static_cast<float>(2 * rounding * radius_m)),
        square_radius_m2_(radius_m * radius_m) {
    // Besides the mask: where Embree has no packets of eight it ignores the mask.
    for (unsigned i = 0; i < count_; ++i) {
      valid_[i] = 0;
      RTCRayN_tnear(rays(), count_, i) = RTCRayN_time(rays(), count_, i) = 0;
      RTCRayN_tfar(rays(), count_, i) = -1;
      RTCRayN_mask(rays(), count_, i) = ~0u;
      RTCRayN_flags(rays(), count_, i) = 0;
    }
  }

  /// Takes over a ray that starts at x, y, z from the centre of the sphere.  It is left out when it passes the sphere
  /// or ends before.
  void aim(int lane, double x, double y, double z, double vx, double vy, double vz, double range_m) {
    double start_m = 0;
    const double square = x * x + y * y + z * z;
    if (square > square_radius_m2_) {
      const double along = -(x * vx + y * vy + z * vz);
      const double px = x + along * vx, py = y + along * vy, pz = z + along * vz;
      const double rest = square_radius_m2_ - (px * px + py * py + pz * pz);
      if (!(along > 0 && rest >= 0)) return;
      const double half = std::sqrt(rest);
      start_m = along - half;
      x = px - half * vx, y = py - half * vy, z = pz - half * vz;
    }
    // A little earlier: the rounded origin must not lie behind a surface that the true one is in front of.
    start_m -= margin_m_;
    x -= margin_m_ * vx, y -= margin_m_ * vy, z -= margin_m_ * vz;
    start_m_[lane] = start_m;
    const float limit = limit_m(lane, range_m);
    // Written so that NaN is left out.
    if (!(limit >= 0 && square + vx * vx + vy * vy + vz * vz < 1e300)) return;
    const unsigned i = count_ == 1 ? 0 : static_cast<unsigned>(lane);
    RTCRayN_org_x(rays(), count_, i) = static_cast<float>(x);
    RTCRayN_org_y(rays(), count_, i) = static_cast<float>(y);
    RTCRayN_org_z(rays(), count_, i) = static_cast<float>(z);
    RTCRayN_dir_x(rays(), count_, i) = static_cast<float>(vx);
    RTCRayN_dir_y(rays(), count_, i) = static_cast<float>(vy);
    RTCRayN_dir_z(rays(), count_, i) = static_cast<float>(vz);
    RTCRayN_tfar(rays(), count_, i) = limit;
    RTCRayN_id(rays(), count_, i) = static_cast<unsigned>(lane);
    valid_[i] = -1;
    any_ = true;
  }

  /// Embree's tfar of a ray whose nearest hit is at `range_m`: long enough for all that could be nearer.
  float limit_m(int lane, double range_m) const {
    return static_cast<float>(range_m - start_m_[lane]) * (1 + 0x1p-21f) + margin_m_;
  }

  /// `context` starts a struct of the caller's, which the callbacks get.
  void intersect(RTCScene scene, RTCIntersectContext& context) {
    if (!any_) return;
    static const bool coh = getenv("COH");
    if (coh) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    if (count_ == 1)
      rtcIntersect1(scene, &context, reinterpret_cast<RTCRayHit*>(data_));
    else
      rtcIntersect8(valid_, scene, &context, reinterpret_cast<RTCRayHit8*>(data_));
  }
  void find_occluded(RTCScene scene, RTCIntersectContext& context) {
    if (!any_) return;
    if (count_ == 1)
      rtcOccluded1(scene, &context, reinterpret_cast<RTCRay*>(data_));
    else
      rtcOccluded8(valid_, scene, &context, reinterpret_cast<RTCRay8*>(data_));
  }

 private:
  RTCRayN* rays() { return reinterpret_cast<RTCRayN*>(data_); }

  alignas(64) float data_[sizeof(RTCRayHit8) / sizeof(float)];
  alignas(64) int valid_[RayPacket::size];
  double start_m_[RayPacket::size];
  unsigned count_;
  bool any_ = false;
  float margin_m_;
  double square_radius_m2_;
};

}  // namespace sim
