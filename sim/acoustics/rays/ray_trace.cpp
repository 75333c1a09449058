// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/rays/ray_trace.hpp"

#include <algorithm>
#include <cmath>

#include "sim/acoustics/rays/ray_legs.hpp"

namespace sim {

RayTrace trace_ray(const SoundProfile& profile, double source_m, double launch_rad, double water_m, double step_m,
                   int steps) {
  RayTrace trace;
  trace.launch_rad = launch_rad;
  const double bottom_m = std::min(water_m, profile.deepest_m());
  double z_m = std::clamp(source_m, 0.0, bottom_m), r_m = 0;
  const double xi = std::cos(launch_rad) / profile.speed_mps(z_m);
  bool down = launch_rad < 0;
  int next = 0;
  std::size_t layer = profile.layer_of(z_m);
  if (!down && layer > 0 && z_m == profile.knots()[layer].depth_m) --layer;
  // Layer by layer: the arc from z_m to the border of the layer, or to its turning point and back.
  while (next <= steps) {
    const auto& knots = profile.knots();
    const double g = profile.gradient(layer), c = profile.speed_mps(z_m), s = ray_sine(xi, c);
    const double top_m = knots[layer].depth_m, low_m = std::min(knots[layer + 1].depth_m, bottom_m);
    const double edge_m = down ? low_m : top_m;
    const double edge_mps = knots[layer].speed_mps + g * (edge_m - top_m);
    const bool turns = xi * edge_mps > 1 || (s == 0 && (g > 0) == down);
    const double turn_m = turns ? turn_reach(xi, g, s).r_m : 0;
    const double length_m =
        turns ? 2 * turn_m : arc_reach(xi, std::abs(edge_m - z_m), c, s, edge_mps, ray_sine(xi, edge_mps)).r_m;
    // Depth along the arc: the sine changes by xi g for each meter of range.
    for (; next <= steps && next * step_m <= r_m + length_m; ++next) {
      const double dr_m = next * step_m - r_m, slope = (down ? 1 : -1) * g * xi;
      const double sine = std::clamp(s - slope * dr_m, -1.0, 1.0), mean = (s + sine) / 2;
      const double c_there = std::sqrt(1 - sine * sine) / xi;
      trace.depth_m.push_back(z_m + (down ? 1 : -1) * dr_m * 2 * mean / (xi * (c + c_there)));
    }
    r_m += length_m;
    if (!(length_m > 0) && next * step_m > r_m && turns) break;
    if (turns) {
      down = !down;
      continue;
    }
    z_m = edge_m;
    if (down && edge_m >= bottom_m) {
      if (bottom_m >= profile.deepest_m()) break;
      ++trace.bottom_bounces;
      down = false;
    } else if (!down && layer == 0) {
      ++trace.surface_bounces;
      down = true;
    } else {
      layer += down ? 1 : -1;
    }
  }
  return trace;
}

RayPlace ray_place(const SoundProfile& profile, double source_m, double launch_rad, double time_s) {
  const auto& knots = profile.knots();
  RayPlace at{0, std::clamp(source_m, 0.0, profile.deepest_m())};
  const double xi = std::cos(launch_rad) / profile.speed_mps(at.depth_m);
  // A vertical ray has no xi.
  const bool steep = xi * profile.speed_mps(at.depth_m) < 1e-9;
  bool down = launch_rad < 0;
  std::size_t layer = profile.layer_of(at.depth_m);
  if (!down && layer > 0 && at.depth_m == knots[layer].depth_m) --layer;
  double left_s = time_s;
  while (left_s > 0) {
    const double c = profile.speed_mps(at.depth_m), g = profile.gradient(layer), along = down ? g : -g;
    const double s = steep ? 1 : ray_sine(xi, c);
    const double edge_m = down ? knots[layer + 1].depth_m : knots[layer].depth_m;
    const double edge_mps = down ? knots[layer + 1].speed_mps : knots[layer].speed_mps;
    const bool turns = !steep && along > 0 && (xi * edge_mps > 1 || s == 0);
    const double thick_m = std::abs(edge_m - at.depth_m);
    const double in_layer_s = turns ? 2 * turn_time_s(g, s)
                              : thick_m == 0
                                  ? 0
                                  : arc_time_s(xi, thick_m, c, s, edge_mps, steep ? 1 : ray_sine(xi, edge_mps));
    if (left_s < in_layer_s) {
      // atanh of the sine changes by the gradient along the ray times the time.
      if (steep || std::abs(g) < 1e-9) {
        at.range_m += c * std::sqrt(1 - s * s) * left_s;
        at.depth_m += (down ? 1 : -1) * c * s * left_s;
      } else {
        const double later = std::tanh(std::atanh(s) - along * left_s);
        at.range_m += (s - later) / (xi * along);
        at.depth_m += (std::sqrt(1 - later * later) / xi - c) / g;
      }
      return at;
    }
    left_s -= in_layer_s;
    if (turns) {
      at.range_m += 2 * turn_reach(xi, g, s).r_m;
      down = !down;
      // Above a turning point in the uppermost part of a layer lies the layer from which the ray came.
      if (!down && at.depth_m == knots[layer].depth_m && layer > 0)
        --layer;
      else if (down && at.depth_m == knots[layer + 1].depth_m && layer + 1 < profile.layers())
        ++layer;
      if (s == 0 && in_layer_s == 0) break;
      continue;
    }
    if (!steep && thick_m > 0) at.range_m += arc_reach(xi, thick_m, c, s, edge_mps, ray_sine(xi, edge_mps)).r_m;
    at.depth_m = edge_m;
    if (!down && layer == 0)
      down = true;
    else if (down && layer + 1 == profile.layers())
      break;
    else
      layer += down ? 1 : -1;
  }
  return at;
}

}  // namespace sim
