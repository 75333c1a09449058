// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/water_light.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sim/base/processor.hpp"
#include "sim/camera/optics.hpp"

namespace sim {

namespace {

// The functions below have no branches, so that the compiler makes vector loops over rays.
#define SHOAL_INLINE [[gnu::always_inline]] inline

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr auto refractive_index = static_cast<float>(water_index);
constexpr float reflected_at_right_angle = 0.021F;  ///< ((n - 1) / (n + 1))^2
constexpr float farthest_m = 1e4F;                  ///< path in water after which nothing is left

SHOAL_INLINE float larger(float a, float b) {
  return a > b ? a : b;
}
SHOAL_INLINE float smaller(float a, float b) {
  return a < b ? a : b;
}

/// e^x for x <= 0 to 0.1 %: 2^n by the exponent of a float, times a polynomial for the rest.
SHOAL_INLINE float exponential(float x) {
  const float turns = larger(x * 1.442695F, -125.0F);
  const int whole = static_cast<int>(turns) - 1;
  const float rest = turns - static_cast<float>(whole);  // 0 to 1
  const float power = 1 + rest * (0.695976F + rest * (0.226173F + rest * 0.0780245F));
  return std::bit_cast<float>((whole + 127) << 23) * power;
}

/// Share of light that the surface reflects (Schlick 1994).
SHOAL_INLINE float reflected(float cosine) {
  const float rest = 1 - smaller(larger(cosine, 0), 1);
  const float square = rest * rest;
  return reflected_at_right_angle + (1 - reflected_at_right_angle) * square * square * rest;
}

/// Constants of an image, one element for each color.
struct Constants {
  float attenuation[3], downward[3], at_surface[3], at_eye[3], sun[3], to_sun[3];
  float wind_slope, eye_depth_m;
  float mirrored_deep[3];  // light that the surface reflects from deep water

  Constants(const WaterLight& water, const SkyLight& sky);
};

/// Daylight that the water scatters into a ray: integral of scattering times what is left of the light, over the path.
/// `source`: per meter at its start.
SHOAL_INLINE float veil(const Constants& water, int color, float source, float down, float path_m) {
  const float rate = larger(water.attenuation[color] + down * water.downward[color], 1e-4F);
  return source * (1 - exponential(-rate * path_m)) / rate;
}

SHOAL_INLINE float share_after(const Constants& water, int color, float path_m) {
  return exponential(-water.attenuation[color] * path_m);
}

Constants::Constants(const WaterLight& water, const SkyLight& sky)
    : wind_slope(water.wind_slope), eye_depth_m(water.eye_depth_m) {
  for (int i = 0; i < 3; ++i) {
    attenuation[i] = water.attenuation[i];
    downward[i] = water.downward[i];
    at_surface[i] = water.at_surface[i];
    at_eye[i] = water.at_eye[i];
    sun[i] = water.sun[i];
    to_sun[i] = sky.to_sun_W()[i];
  }
  for (int i = 0; i < 3; ++i) mirrored_deep[i] = veil(*this, i, at_surface[i], 1, farthest_m);
}

/// Vector of unit length.
struct Unit {
  float x, y, z;
};

SHOAL_INLINE Unit unit(float x, float y, float z) {
  const float inverse = 1 / std::sqrt(x * x + y * y + z * z);
  return {x * inverse, y * inverse, z * inverse};
}
SHOAL_INLINE float dot(const Unit& a, const Unit& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
SHOAL_INLINE float cosine_to_sun(const Constants& water, const Unit& direction) {
  return dot(direction, {water.to_sun[0], water.to_sun[1], water.to_sun[2]});
}

/// Dims the light of what is seen by the depth at which it is: less daylight reaches it there.
SHOAL_INLINE void dim_by_depth(const Constants& water, WaterRays& rays) {
  for (int i = 0; i < WaterRays::size; ++i) {
    const float range_m = rays.range_m[i] < infinity ? rays.range_m[i] : 0;
    const float deep_m = larger(water.eye_depth_m - range_m * rays.direction_W[2][i], 0);
    const float depth_m = rays.range_m[i] < infinity ? deep_m : 0;
    for (int color = 0; color < 3; ++color) {
      const float share = exponential(-water.downward[color] * depth_m);
      rays.light[color][i] *= depth_m > 0 ? share : 1;
    }
  }
}

/// Lights the rays of a camera above the water.
SHOAL_INLINE void light_above(const Constants& water, const SkyLight& sky, WaterRays& rays) {
  dim_by_depth(water, rays);
  for (int i = 0; i < WaterRays::size; ++i) {
    // Reflection of the sky.
    const Unit direction{rays.direction_W[0][i], rays.direction_W[1][i], rays.direction_W[2][i]};
    const Unit normal = unit(-rays.slope_x[i], -rays.slope_y[i], 1);
    const float toward = larger(-dot(normal, direction), 0.02F);
    const float mirrored = reflected(toward);
    const Unit mirror = unit(direction.x + 2 * toward * normal.x, direction.y + 2 * toward * normal.y,
                             larger(direction.z + 2 * toward * normal.z, 0.02F));
    float sky_light[3];
    sky.from(mirror.z, cosine_to_sun(water, mirror), sky_light);
    // Image of the sun, spread by waves that are too small to be seen.
    const Unit half = unit(water.to_sun[0] - direction.x, water.to_sun[1] - direction.y, water.to_sun[2] - direction.z);
    const float cosine = larger(dot(half, normal), 0.05F), square = cosine * cosine;
    const float rough = water.wind_slope + rays.rough[i];
    const float facets = exponential(smaller((1 - 1 / square) / rough, 0)) / (rough * square * square);
    const float glint = smaller(4.0F, 0.25F * facets * reflected(cosine_to_sun(water, half)) / larger(toward, 0.2F));
    // Light that comes out of the water.
    const bool wet = rays.crossing_m[i] < rays.range_m[i];
    const float path_m = wet ? smaller(rays.range_m[i] - rays.crossing_m[i], farthest_m) : 0;
    const float down = larger(-direction.z, 0);
    for (int color = 0; color < 3; ++color) {
      const float out = veil(water, color, water.at_surface[color], down, path_m) +
                        share_after(water, color, path_m) * rays.light[color][i];
      const float sum = water.sun[color] * glint + (1 - mirrored) * out + mirrored * sky_light[color];
      rays.light[color][i] = wet ? sum : rays.light[color][i];
    }
  }
}

/// Lights the rays of a camera under water.
SHOAL_INLINE void light_below(const Constants& water, const SkyLight& sky, WaterRays& rays) {
  dim_by_depth(water, rays);
  for (int i = 0; i < WaterRays::size; ++i) {
    // The surface from below.  Snell's window: the sky within 48 degrees of the zenith; outside of it the surface
    // mirrors the water.
    const Unit direction{rays.direction_W[0][i], rays.direction_W[1][i], rays.direction_W[2][i]};
    const Unit up = unit(-rays.slope_x[i], -rays.slope_y[i], 1);
    const float toward = larger(dot(up, direction), 0);
    const float square = 1 - refractive_index * refractive_index * (1 - toward * toward);
    const float root = std::sqrt(larger(square, 0)), bend = refractive_index * toward - root;
    const float mirrored = square > 0 ? reflected(root) : 1;
    const float mirror_down = larger(2 * toward * up.z - direction.z, 0);
    const Unit refracted =
        unit(refractive_index * direction.x - bend * up.x, refractive_index * direction.y - bend * up.y,
             refractive_index * direction.z - bend * up.z);
    float sky_light[3];
    sky.from(refracted.z, cosine_to_sun(water, refracted), sky_light);
    // The water up to the surface, or up to what is seen in it.
    const bool leaves = rays.crossing_m[i] < rays.range_m[i];
    const float path_m = smaller(leaves ? rays.crossing_m[i] : rays.range_m[i], farthest_m);
    const bool is_sky = leaves && !(rays.range_m[i] < infinity);
    for (int color = 0; color < 3; ++color) {
      const float own = veil(water, color, water.at_eye[color], -direction.z, path_m);
      const float deep = veil(water, color, water.at_surface[color], mirror_down, farthest_m);
      const float mirror = square > 0 ? water.mirrored_deep[color] : deep;
      const float beyond = is_sky ? sky_light[color] : rays.light[color][i];
      const float seen = leaves ? mirrored * mirror + (1 - mirrored) * beyond : beyond;
      rays.light[color][i] = own + share_after(water, color, path_m) * seen;
    }
  }
}

SHOAL_INLINE void light_all(const WaterLight& water, const SkyLight& sky, WaterRays& rays) {
  // Copies, which the compiler knows not to change while it writes the light.
  const Constants constants(water, sky);
  const std::array copy{sky};
  if (water.is_under)
    light_below(constants, copy[0], rays);
  else
    light_above(constants, copy[0], rays);
}

/// Adds what lamps light up, seen through the water.  Light of lamps above the water has the same way there and back.
SHOAL_INLINE void show_lit(const float (&attenuation)[3], bool is_under, WaterRays& rays) {
  for (int color = 0; color < 3; ++color)
    for (int i = 0; i < WaterRays::size; ++i) {
      const bool leaves = rays.crossing_m[i] < rays.range_m[i];
      const float wet_m = is_under ? rays.range_m[i] : rays.range_m[i] - rays.crossing_m[i];
      const float path_m = smaller(is_under ? wet_m : leaves ? 2 * wet_m : 0, farthest_m);
      const float seen = exponential(-attenuation[color] * path_m) * rays.lit[color][i];
      rays.light[color][i] += is_under && leaves ? 0 : seen;
    }
}

/// Path of each ray as an angle seen from a lamp.
struct LampPath {
  WaterRays::Values along_m;    ///< to the point nearest to the lamp
  WaterRays::Values off_m;      ///< of that point from the lamp
  WaterRays::Values first_tan;  ///< tangent of the angle in the middle of the first part
  WaterRays::Values turn_tan;   ///< tangent of a part
  WaterRays::Values turn;       ///< a part, rad
};

constexpr int lamp_parts = 8;

/// Tangent of half of an angle of less than a right one.
SHOAL_INLINE float half_angle(float tangent) {
  return tangent / (1 + std::sqrt(1 + tangent * tangent));
}

SHOAL_INLINE void find_path(const LampLight& lamp, const WaterRays& rays, LampPath& path) {
  static_assert(lamp_parts == 8);
  constexpr float nearest_m = 0.02F;
  const float x = lamp.position_W.x(), y = lamp.position_W.y(), z = lamp.position_W.z();
  const float squared = lamp.position_W.squaredNorm();
  for (int i = 0; i < WaterRays::size; ++i) {
    const float along_m = x * rays.direction_W[0][i] + y * rays.direction_W[1][i] + z * rays.direction_W[2][i];
    const float off_m = std::sqrt(larger(squared - along_m * along_m, nearest_m * nearest_m));
    const float end_m = smaller(smaller(rays.crossing_m[i], rays.range_m[i]), farthest_m);
    // The whole angle is halved, down to that of half a part.
    const float first = -along_m / off_m, last = (end_m - along_m) / off_m;
    const float secants = std::sqrt((1 + first * first) * (1 + last * last));
    const float half = (last - first) / larger(secants + 1 + first * last, 1e-6F * secants);
    const float part = half_angle(half_angle(half)), shift = half_angle(part), square = part * part;
    path.along_m[i] = along_m, path.off_m[i] = off_m;
    path.turn[i] = part * (1 + square * (-1.0F / 3 + square * (0.2F + square * (-1.0F / 7 + square / 9))));
    path.turn_tan[i] = part;
    path.first_tan[i] = (first + shift) / (1 - first * shift);
  }
}

/// Adds what the water scatters of the light of a lamp.
SHOAL_INLINE void scatter(const WaterLight& water, const LampLight& lamp, const LampPath& path, WaterRays& rays) {
  constexpr float g = 0.924F;
  constexpr float equally = 0.25F;  ///< pi times the phase function of equal scattering
  const float x = lamp.position_W.x(), y = lamp.position_W.y(), z = lamp.position_W.z();
  const float axis_x = lamp.axis_W.x(), axis_y = lamp.axis_W.y(), axis_z = lamp.axis_W.z(), spread = lamp.spread;
  float attenuation[3], particles[3], molecules[3];
  for (int color = 0; color < 3; ++color) {
    attenuation[color] = water.attenuation[color];
    particles[color] = lamp.color[color] * water.particles[color];
    molecules[color] = lamp.color[color] * water.molecules[color];
  }
  WaterRays::Values sum[3] = {}, tangent;
  for (int i = 0; i < WaterRays::size; ++i) tangent[i] = path.first_tan[i];
  for (int part = 0; part < lamp_parts; ++part)
    for (int i = 0; i < WaterRays::size; ++i) {
      const float t = tangent[i], secant = std::sqrt(1 + t * t);
      const float range_m = path.along_m[i] + path.off_m[i] * t, distance_m = path.off_m[i] * secant;
      // From the lamp to the point; it scatters back against the direction of the ray.
      const float inverse = 1 / distance_m;
      const float cosine_axis =
          inverse * (axis_x * (range_m * rays.direction_W[0][i] - x) + axis_y * (range_m * rays.direction_W[1][i] - y) +
                     axis_z * (range_m * rays.direction_W[2][i] - z));
      const float cosine = -t / secant;
      const float base = 1 + g * g - 2 * g * cosine;
      const float forward = equally * (1 - g * g) / (base * std::sqrt(base));
      const float strength = exponential(smaller(spread * (cosine_axis - 1), 0)) * path.turn[i] / path.off_m[i];
      for (int color = 0; color < 3; ++color)
        sum[color][i] += strength * (particles[color] * forward + molecules[color] * equally) *
                         exponential(-attenuation[color] * (range_m + distance_m));
      tangent[i] = (t + path.turn_tan[i]) / (1 - t * path.turn_tan[i]);
    }
  for (int color = 0; color < 3; ++color)
    for (int i = 0; i < WaterRays::size; ++i) rays.light[color][i] += sum[color][i];
}

SHOAL_INLINE void lamps_all(const WaterLight& water, std::span<const LampLight> lamps, WaterRays& rays) {
  const float attenuation[3] = {water.attenuation[0], water.attenuation[1], water.attenuation[2]};
  show_lit(attenuation, water.is_under, rays);
  if (!water.is_under) return;
  LampPath path;
  for (const LampLight& lamp : lamps) {
    find_path(lamp, rays, path);
    scatter(water, lamp, path, rays);
  }
}

#undef SHOAL_INLINE

void lamps_baseline(const WaterLight& water, std::span<const LampLight> lamps, WaterRays& rays) {
  lamps_all(water, lamps, rays);
}

SHOAL_AVX2 void lamps_avx2(const WaterLight& water, std::span<const LampLight> lamps, WaterRays& rays) {
  lamps_all(water, lamps, rays);
}

void light_baseline(const WaterLight& water, const SkyLight& sky, WaterRays& rays) {
  light_all(water, sky, rays);
}

SHOAL_AVX2 void light_avx2(const WaterLight& water, const SkyLight& sky, WaterRays& rays) {
  light_all(water, sky, rays);
}

}  // namespace

LinearColor daylight_at(const WaterLight& water, float depth_m) {
  LinearColor share = LinearColor::Ones();
  for (int i = 0; i < 3 && depth_m > 0; ++i) share[i] = exponential(-water.downward[i] * depth_m);
  return share;
}

void light_water(const WaterLight& water, const SkyLight& sky, WaterRays& rays) {
  static const auto best = has_avx2() ? light_avx2 : light_baseline;
  best(water, sky, rays);
}

void light_lamps(const WaterLight& water, std::span<const LampLight> lamps, WaterRays& rays) {
  static const auto best = has_avx2() ? lamps_avx2 : lamps_baseline;
  best(water, lamps, rays);
}

}  // namespace sim
