// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/rays/ray_legs.hpp"

namespace sim {

namespace {

/// atanh(x) / x.
double atanh_over(double x) {
  if (std::abs(x) > 0.03) return std::atanh(x) / x;
  const double y = x * x;
  return 1 + y * (1.0 / 3 + y * (1.0 / 5 + y * (1.0 / 7 + y / 9)));
}

/// Point of a ray.
struct RayPoint {
  double z_m, c_mps, s;
  std::size_t layer;
};

/// Visits the arcs of a ray upwards from a point, until it turns or reaches the surface.  `arc` gets thickness, speed
/// and sine of both ends; `turn` the gradient and the sine.  Returns whether it turned.
template <typename Arc, typename Turn>
bool rise(const SoundProfile& profile, double xi, RayPoint at, const Arc& arc, const Turn& turn) {
  const SoundProfile::Knot* const knots = profile.knots().data();
  for (std::size_t layer = at.layer + 1; layer-- > 0;) {
    const SoundProfile::Knot& top = knots[layer];
    if (top.depth_m >= at.z_m) continue;
    if (xi * top.speed_mps > 1) {
      turn(profile.gradient(layer), at.s);
      return true;
    }
    const double s = ray_sine(xi, top.speed_mps);
    arc(at.z_m - top.depth_m, at.c_mps, at.s, top.speed_mps, s);
    at.z_m = top.depth_m;
    at.c_mps = top.speed_mps;
    at.s = s;
  }
  return false;
}

/// The same downwards to another point, whose sine is not used.
template <typename Arc, typename Turn>
bool sink(const SoundProfile& profile, double xi, RayPoint at, const RayPoint& to, const Arc& arc, const Turn& turn) {
  const SoundProfile::Knot* const knots = profile.knots().data();
  for (std::size_t layer = at.layer; layer <= to.layer; ++layer) {
    const bool ends = layer == to.layer;
    const double low_m = ends ? to.z_m : knots[layer + 1].depth_m;
    const double low_mps = ends ? to.c_mps : knots[layer + 1].speed_mps;
    if (low_m <= at.z_m) continue;
    if (xi * low_mps > 1) {
      turn(profile.gradient(layer), at.s);
      return true;
    }
    const double s = ray_sine(xi, low_mps);
    arc(low_m - at.z_m, at.c_mps, at.s, low_mps, s);
    at.z_m = low_m;
    at.c_mps = low_mps;
    at.s = s;
  }
  return false;
}

RayPoint upper_of(const RayDepths& depths, double xi) {
  return {depths.upper_m, depths.upper_mps, ray_sine(xi, depths.upper_mps), depths.upper_layer};
}
RayPoint lower_of(const RayDepths& depths, double xi) {
  return {depths.lower_m, depths.lower_mps, ray_sine(xi, depths.lower_mps), depths.lower_layer};
}
RayPoint water_of(const RayDepths& depths) {
  return {depths.water_m, depths.water_mps, 0, depths.water_layer};
}

}  // namespace

double arc_time_s(double xi, double thick_m, double c1_mps, double s1, double c2_mps, double s2) {
  // The time is atanh((s1 - s2) / (1 - s1 s2)) / g, here without differences of nearly equal numbers.
  const double a = xi * c1_mps;
  const double sum = c1_mps + c2_mps, steep = 1 + s1 * s2;
  const double q_s = thick_m * sum * steep /
                     (std::max(s1 + s2, 1e-300) * (c1_mps * c1_mps + c2_mps * c2_mps - a * a * c2_mps * c2_mps));
  const double x = (c2_mps - c1_mps) / thick_m * q_s;
  return q_s * atanh_over(x);
}

double turn_time_s(double gradient, double s) {
  return std::atanh(s) / std::max(std::abs(gradient), 1e-300);
}

RayDepths::RayDepths(const SoundProfile& profile, double upper, double lower, double water, bool bottom)
    : upper_m(upper),
      lower_m(lower),
      water_m(water),
      has_bottom(bottom),
      upper_layer(profile.layer_of(upper)),
      lower_layer(profile.layer_of(lower)),
      water_layer(profile.layer_of(water)),
      upper_mps(profile.speed_mps(upper)),
      lower_mps(profile.speed_mps(lower)),
      water_mps(profile.speed_mps(water)),
      highest_between_mps(profile.highest_mps(upper, lower)),
      highest_mps(profile.highest_mps(0, water)) {}

RayReach reach_between(const SoundProfile& profile, const RayDepths& depths, double xi) {
  RayReach reach;
  sink(
      profile, xi, upper_of(depths, xi), lower_of(depths, xi),
      [&](double thick_m, double c1, double s1, double c2, double s2) {
        reach += arc_reach(xi, thick_m, c1, s1, c2, s2);
      },
      [](double, double) {});
  return reach;
}

RayLegs ray_legs(const SoundProfile& profile, const RayDepths& depths, double xi) {
  RayLegs legs;
  RayReach* leg = &legs.above;
  const auto arc = [&](double thick_m, double c1, double s1, double c2, double s2) {
    *leg += arc_reach(xi, thick_m, c1, s1, c2, s2);
  };
  const auto turn = [&](double g, double s) { *leg += turn_reach(xi, g, s); };
  if (!rise(profile, xi, upper_of(depths, xi), arc, turn)) legs.upper_end = RayEnd::surface;
  leg = &legs.between;
  sink(profile, xi, upper_of(depths, xi), lower_of(depths, xi), arc, turn);
  leg = &legs.below;
  if (!sink(profile, xi, lower_of(depths, xi), water_of(depths), arc, turn))
    legs.lower_end = depths.has_bottom ? RayEnd::bottom : RayEnd::lost;
  return legs;
}

RayTimes ray_times(const SoundProfile& profile, const RayDepths& depths, double xi) {
  RayTimes times;
  double* leg = &times.above_s;
  const auto arc = [&](double thick_m, double c1, double s1, double c2, double s2) {
    *leg += arc_time_s(xi, thick_m, c1, s1, c2, s2);
  };
  const auto turn = [&](double g, double s) { *leg += turn_time_s(g, s); };
  rise(profile, xi, upper_of(depths, xi), arc, turn);
  leg = &times.between_s;
  sink(profile, xi, upper_of(depths, xi), lower_of(depths, xi), arc, turn);
  leg = &times.below_s;
  sink(profile, xi, lower_of(depths, xi), water_of(depths), arc, turn);
  return times;
}

}  // namespace sim
