// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/float_rays.hpp"

#include <cstdint>
#include <limits>

namespace sim {

/// Sets all lanes without branches, so that the compiler makes vector loops over lanes.
[[gnu::always_inline]] inline void FloatRays::aim_all(FloatRays& out, const double (&from)[3][RayPacket::size],
                                                      const double (&direction)[3][RayPacket::size],
                                                      const double (&range_m)[RayPacket::size], unsigned lanes) {
  constexpr int n = RayPacket::size;
  const double margin_m = out.margin_m_, square_radius_m2 = out.square_radius_m2_;
  // Start of each ray, as in set_start.
  double start_m[n], over[n];
  for (int i = 0; i < n; ++i) {
    const double x = from[0][i], y = from[1][i], z = from[2][i];
    over[i] = x * x + y * y + z * z - square_radius_m2;
    start_m[i] = -margin_m;
  }
  double farthest = over[0];
  for (int i = 1; i < n; ++i) farthest = over[i] <= farthest ? farthest : over[i];
  if (!(farthest <= 0))
    for (int i = 0; i < n; ++i) {
      const double x = from[0][i], y = from[1][i], z = from[2][i];
      const double vx = direction[0][i], vy = direction[1][i], vz = direction[2][i];
      const double along = -(x * vx + y * vy + z * vz);
      const double px = x + along * vx, py = y + along * vy, pz = z + along * vz;
      const double rest = square_radius_m2 - (px * px + py * py + pz * pz);
      const double enter = along - std::sqrt(rest > 0 ? rest : 0) - margin_m;
      const double outside = ((along > 0) & (rest >= 0)) ? enter : std::numeric_limits<double>::quiet_NaN();
      start_m[i] = over[i] <= 0 ? -margin_m : outside;
    }
  // Round to single precision, and drop invalid rays.
  float origin[3][n], ray_direction[3][n], limit_m[n];
  std::uint32_t good[n];  // all bits or none
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < n; ++i) {
      origin[axis][i] = static_cast<float>(from[axis][i] + start_m[i] * direction[axis][i]);
      ray_direction[axis][i] = static_cast<float>(direction[axis][i]);
    }
  for (int i = 0; i < n; ++i)
    limit_m[i] = static_cast<float>(range_m[i] - start_m[i]) * (1 + 0x1p-21f) + static_cast<float>(margin_m);
  for (int i = 0; i < n; ++i) {
    // The condition is false for NaN.
    const float sum =
        origin[0][i] + origin[1][i] + origin[2][i] + ray_direction[0][i] + ray_direction[1][i] + ray_direction[2][i];
    const std::uint32_t finite = std::abs(sum) < std::numeric_limits<float>::infinity() ? ~0u : 0;
    const std::uint32_t ahead = limit_m[i] >= 0 ? ~0u : 0;
    good[i] = finite & ahead & (0u - (lanes >> i & 1u));
  }
  // Fill all lanes with valid numbers: Embree checks even masked lanes, and without packets of eight it ignores the
  // mask.
  RTCRay8& rays = *reinterpret_cast<RTCRay8*>(out.data_);
  const auto fill = [&](float(&to)[n], const float(&value)[n], float otherwise) {
    for (int i = 0; i < n; ++i) to[i] = good[i] != 0 ? value[i] : otherwise;
  };
  fill(rays.org_x, origin[0], 0);
  fill(rays.org_y, origin[1], 0);
  fill(rays.org_z, origin[2], 0);
  fill(rays.dir_x, ray_direction[0], 1);
  fill(rays.dir_y, ray_direction[1], 0);
  fill(rays.dir_z, ray_direction[2], 0);
  fill(rays.tfar, limit_m, -1);
  unsigned(&geometry)[n] = reinterpret_cast<RTCRayHit8*>(out.data_)->hit.geomID;
  for (int i = 0; i < n; ++i) geometry[i] = RTC_INVALID_GEOMETRY_ID;
  for (int i = 0; i < n; ++i) {
    rays.tnear[i] = rays.time[i] = 0;
    rays.mask[i] = ~0u;
    rays.id[i] = static_cast<unsigned>(i);
    rays.flags[i] = 0;
    out.valid_[i] = static_cast<int>(good[i]);
    out.start_m_[i] = start_m[i];
  }
}

void FloatRays::aim_all_baseline(FloatRays& out, const double (&from)[3][RayPacket::size],
                                 const double (&direction)[3][RayPacket::size],
                                 const double (&range_m)[RayPacket::size], unsigned lanes) {
  aim_all(out, from, direction, range_m, lanes);
}

SHOAL_AVX2 void FloatRays::aim_all_avx2(FloatRays& out, const double (&from)[3][RayPacket::size],
                                        const double (&direction)[3][RayPacket::size],
                                        const double (&range_m)[RayPacket::size], unsigned lanes) {
  aim_all(out, from, direction, range_m, lanes);
}

}  // namespace sim
