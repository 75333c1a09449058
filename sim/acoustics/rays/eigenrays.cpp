// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/rays/eigenrays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/acoustics/rays/caustic.hpp"

namespace sim {

namespace {

/// Share of an interval that is left out at its ends, where derivatives are infinite.
constexpr double margin = 1e-5;
/// Layers of less difference in speed are those of a smooth profile, and their borders are not kinks of it.
constexpr double thin_mps = 1;
/// Most reversals at each end of one ray.
constexpr int max_cycles = 200;

/// Place in an interval of xi: the range as a function of `v` in [0, 1] has finite derivatives at both ends.
double xi_at(double low, double high, double v) {
  return low + (high - low) * (1 - std::cos(std::numbers::pi * v)) / 2;
}
double xi_by_v(double low, double high, double v) {
  return (high - low) * std::numbers::pi / 2 * std::sin(std::numbers::pi * v);
}

/// Nodes of the table: v, and xi and its derivative by v in an interval from 0 to 1.
struct Nodes {
  std::array<double, Eigenrays::nodes> v, xi, by_v;
};
const Nodes& nodes_of_table() {
  static const Nodes made = [] {
    Nodes nodes;
    for (std::size_t i = 0; i < nodes.v.size(); ++i) {
      nodes.v[i] = margin + (1 - 2 * margin) * static_cast<double>(i) / (Eigenrays::nodes - 1);
      nodes.xi[i] = xi_at(0, 1, nodes.v[i]);
      nodes.by_v[i] = xi_by_v(0, 1, nodes.v[i]);
    }
    return nodes;
  }();
  return made;
}
double xi_of_node(double low, double high, int node) {
  return low + (high - low) * nodes_of_table().xi[static_cast<std::size_t>(node)];
}

/// Ways in which a ray leaves the upper point and arrives at the lower one.
enum class Family { down_down, up_up, up_down, down_up };
constexpr std::array families{Family::down_down, Family::up_up, Family::up_down, Family::down_up};

/// Reach, or time, of a family after `cycles` full swings.
template <typename Part>
Part sum_of(Family family, int cycles, const Part& above, const Part& between, const Part& below) {
  const Part whole = above + between + below;
  Part sum = 2.0 * cycles * whole;
  switch (family) {
    case Family::down_down:
      return sum + between;
    case Family::up_up:
      return sum - between;
    case Family::up_down:
      return sum + 2.0 * above + between;
    case Family::down_up:
      break;
  }
  return sum + 2.0 * below + between;
}
RayReach reach_of(Family family, int cycles, const RayLegs& legs) {
  return sum_of(family, cycles, legs.above, legs.between, legs.below);
}

}  // namespace

Eigenrays::Eigenrays(SoundProfile profile) : profile_(std::move(profile)) {
  std::vector<double> speeds;
  for (const SoundProfile::Knot& knot : profile_.knots()) speeds.push_back(knot.speed_mps);
  std::sort(speeds.begin(), speeds.end());
  speeds.erase(std::unique(speeds.begin(), speeds.end()), speeds.end());
  for (std::size_t i = 1; i < speeds.size(); ++i) intervals_.push_back(tabulate(speeds[i - 1], speeds[i]));
}

Eigenrays::Interval Eigenrays::tabulate(double low_mps, double high_mps) const {
  const auto& knots = profile_.knots();
  const std::size_t count = knots.size();
  Interval made;
  made.low_mps = low_mps;
  made.high_mps = high_mps;
  made.last.assign(count, -1);
  made.first.assign(count, -1);
  made.from_end.resize(count * nodes);
  made.whole.resize(count * nodes);
  const double middle = 2 / (low_mps + high_mps);
  // Which knots a ray connects is the same in the whole interval.
  for (std::size_t k = 0; k < count; ++k)
    if (middle * knots[k].speed_mps < 1)
      made.first[k] = k > 0 && made.first[k - 1] >= 0 ? made.first[k - 1] : static_cast<std::int32_t>(k);
  for (std::size_t k = count; k-- > 0;)
    if (made.first[k] >= 0)
      made.last[k] = k + 1 < count && made.last[k + 1] >= 0 ? made.last[k + 1] : static_cast<std::int32_t>(k);
  for (int node = 0; node < nodes; ++node) {
    const double xi = xi_of_node(1 / high_mps, 1 / low_mps, node);
    made.xi[static_cast<std::size_t>(node)] = xi;
    RayReach* const from_end = made.from_end.data() + static_cast<std::size_t>(node) * count;
    RayReach* const whole = made.whole.data() + static_cast<std::size_t>(node) * count;
    double above_s = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (made.first[k] < 0) continue;
      const double c = knots[k].speed_mps, s = ray_sine(xi, c);
      if (k > 0 && made.first[k - 1] >= 0)
        from_end[k] = from_end[k - 1] +
                      arc_reach(xi, knots[k].depth_m - knots[k - 1].depth_m, knots[k - 1].speed_mps, above_s, c, s);
      else if (k > 0)
        from_end[k] = turn_reach(xi, profile_.gradient(k - 1), s);
      whole[k] = from_end[k];
      if (k + 1 < count && made.first[k + 1] < 0) whole[k] += turn_reach(xi, profile_.gradient(k), s);
      above_s = s;
    }
  }
  return made;
}

/// As ray_legs(), from the table.
RayLegs Eigenrays::legs_of(const Interval& interval, int node, const RayDepths& depths) const {
  const auto& knots = profile_.knots();
  const double xi = interval.xi[static_cast<std::size_t>(node)];
  const RayReach* const from_end = interval.from_end.data() + static_cast<std::size_t>(node) * knots.size();
  const RayReach* const whole = interval.whole.data() + static_cast<std::size_t>(node) * knots.size();
  const auto arc_from_knot = [&](std::size_t knot, double z_m, double c, double s) {
    const SoundProfile::Knot& top = knots[knot];
    return z_m > top.depth_m ? arc_reach(xi, z_m - top.depth_m, top.speed_mps, ray_sine(xi, top.speed_mps), c, s)
                             : RayReach{};
  };
  /// From the upper end to a depth; `knot`: one that the ray passes.
  const auto down_to = [&](double z_m, std::size_t layer, double c, std::size_t& knot) {
    const double s = ray_sine(xi, c);
    if (interval.first[layer] < 0) {
      knot = layer + 1;
      return turn_reach(xi, profile_.gradient(layer), s);
    }
    knot = layer;
    return from_end[layer] + arc_from_knot(layer, z_m, c, s);
  };
  RayLegs legs;
  std::size_t upper_knot = 0, lower_knot = 0;
  legs.above = down_to(depths.upper_m, depths.upper_layer, depths.upper_mps, upper_knot);
  const RayReach to_lower = down_to(depths.lower_m, depths.lower_layer, depths.lower_mps, lower_knot);
  legs.between = to_lower - legs.above;
  if (interval.first[upper_knot] == 0) legs.upper_end = RayEnd::surface;
  // The lower end: before the bottom, in its layer, or at it.
  const std::size_t deep = depths.water_layer;
  const auto last = static_cast<std::size_t>(std::max(interval.last[lower_knot], 0));
  const bool passes_knot = interval.first[deep] >= 0 && lower_knot <= deep && last >= deep;
  const bool in_its_layer = depths.lower_layer == deep;
  if (!passes_knot && !in_its_layer) {
    legs.below = whole[last] - to_lower;
    return legs;
  }
  const double water_s = ray_sine(xi, depths.water_mps);
  if (xi * depths.water_mps < 1) {
    legs.lower_end = depths.has_bottom ? RayEnd::bottom : RayEnd::lost;
    if (in_its_layer)
      legs.below = arc_reach(xi, depths.water_m - depths.lower_m, depths.lower_mps, ray_sine(xi, depths.lower_mps),
                             depths.water_mps, water_s);
    else
      legs.below = from_end[deep] + arc_from_knot(deep, depths.water_m, depths.water_mps, water_s) - to_lower;
  } else if (in_its_layer) {
    legs.below = turn_reach(xi, profile_.gradient(deep), ray_sine(xi, depths.lower_mps));
  } else {
    legs.below =
        from_end[deep] + turn_reach(xi, profile_.gradient(deep), ray_sine(xi, knots[deep].speed_mps)) - to_lower;
  }
  return legs;
}

/// One search.
struct Eigenrays::Search {
  const Eigenrays& rays;
  const RayQuery& query;
  const RayDepths& depths;
  bool source_is_upper;
  std::vector<SoundRay>& out;
  std::vector<RayRoot> roots{};

  const SoundProfile& profile() const { return rays.profile_; }
  void add(double xi, Family family, int cycles);
  /// Number of bounces of a family, or nothing when it is impossible or has too many.
  bool allowed(Family family, int cycles, const RayLegs& legs) const;
  void search_piece(double low, double high, const std::array<RayLegs, nodes>& legs);
  void search_extreme(double low, double high, std::size_t node, const RayReach& a, const RayReach& b, Family family,
                      int cycles);
  void solve(double low, double high, double v1, double v2, double f1, Family family, int cycles);
  void search_steep(double fastest_mps, Family family, int cycles);
  void search_bounces();
  /// Width in xi of the thin layer in which a ray turns; 0: of another one.
  double thin_layer(double xi) const;
  /// Derivative of the reach: about a ray that turns in a thin layer, whose borders are kinks, the mean over some.
  double slope_about(double xi, Family family, int cycles, const RayLegs& legs) const;
  /// Whether rays of an interval of xi can have few enough bounces.
  bool may_turn(const Interval& interval) const;
};

bool Eigenrays::Search::allowed(Family family, int cycles, const RayLegs& legs) const {
  const int upper = cycles + (family == Family::up_down), lower = cycles + (family == Family::down_up);
  if (family == Family::up_up && cycles == 0) return false;
  int bounces = 0;
  if (legs.upper_end == RayEnd::surface) bounces += upper;
  if (legs.lower_end == RayEnd::bottom) bounces += lower;
  if (legs.lower_end == RayEnd::lost && lower > 0) return false;
  return bounces <= query.max_bounces;
}

bool Eigenrays::Search::may_turn(const Interval& interval) const {
  if (query.max_bounces > 0) return true;
  // Either end is a turning point.
  const auto upper = depths.upper_layer + (interval.first[depths.upper_layer] < 0);
  const auto lower = depths.lower_layer + (interval.first[depths.lower_layer] < 0);
  if (interval.first[upper] != 0) return true;
  return interval.last[lower] < 0 || static_cast<std::size_t>(interval.last[lower]) <= depths.water_layer;
}

void Eigenrays::Search::add(double xi, Family family, int cycles) {
  const RayLegs legs = ray_legs(profile(), depths, xi);
  const RayTimes times = ray_times(profile(), depths, xi);
  const RayReach reach = reach_of(family, cycles, legs);
  SoundRay ray;
  // Fermat: the time of the ray that is this much longer.
  ray.travel_time_s =
      sum_of(family, cycles, times.above_s, times.between_s, times.below_s) + xi * (query.range_m - reach.r_m);
  const int upper = cycles + (family == Family::up_down), lower = cycles + (family == Family::down_up);
  (legs.upper_end == RayEnd::surface ? ray.surface_bounces : ray.turns) += upper;
  (legs.lower_end == RayEnd::bottom ? ray.bottom_bounces : ray.turns) += lower;
  const auto angle = [&](double c_mps) { return std::atan2(ray_sine(xi, c_mps), xi * c_mps); };
  if (ray.surface_bounces > 0) ray.surface_grazing_rad = angle(profile().speed_mps(0));
  if (ray.bottom_bounces > 0) ray.bottom_grazing_rad = angle(depths.water_mps);
  // Directions at the two points; backwards when the source is the lower one.
  const bool leaves_up = family == Family::up_up || family == Family::up_down;
  const bool arrives_up = family == Family::up_up || family == Family::down_up;
  const double at_upper = leaves_up ? angle(depths.upper_mps) : -angle(depths.upper_mps);
  const double at_lower = arrives_up ? angle(depths.lower_mps) : -angle(depths.lower_mps);
  ray.launch_rad = source_is_upper ? at_upper : -at_lower;
  ray.arrival_rad = source_is_upper ? at_lower : -at_upper;
  const double slope = ray.turns > 0 ? slope_about(xi, family, cycles, legs) : reach.by_xi;
  // Each leg between two turning points has a caustic, and the last one when the range grows again with xi.
  ray.caustics = std::max(0, ray.turns - (slope < 0));
  const double tube = std::abs(reach.by_xi) * ray_sine(xi, depths.upper_mps) * ray_sine(xi, depths.lower_mps);
  // For a vertical ray the ratio of xi and the range is a derivative.
  const bool vertical = xi * depths.highest_mps < 1e-6;
  const double xi_by_range = vertical ? 1 / reach.by_xi : xi / query.range_m;
  ray.power_per_m2 = xi_by_range * depths.upper_mps * depths.lower_mps / std::max(tube, 1e-300);
  out.push_back(ray);
  roots.push_back(
      {static_cast<int>(family), cycles, xi, slope, ray.power_per_m2 * std::abs(reach.by_xi), thin_layer(xi)});
}

double Eigenrays::Search::thin_layer(double xi) const {
  const auto after = std::upper_bound(rays.intervals_.begin(), rays.intervals_.end(), 1 / xi,
                                      [](double mps, const Interval& each) { return mps < each.low_mps; });
  if (after == rays.intervals_.begin()) return 0;
  const double width_mps = std::prev(after)->high_mps - std::prev(after)->low_mps;
  return width_mps > thin_mps ? 0 : width_mps * xi * xi;
}

double Eigenrays::Search::slope_about(double xi, Family family, int cycles, const RayLegs& legs) const {
  const double exact = reach_of(family, cycles, legs).by_xi;
  const double far = thin_layer(xi);
  if (far == 0 || xi + far > 1 / depths.highest_between_mps) return exact;
  const RayLegs less = ray_legs(profile(), depths, xi - far), more = ray_legs(profile(), depths, xi + far);
  for (const RayLegs* each : {&less, &more})
    if (each->upper_end != legs.upper_end || each->lower_end != legs.lower_end) return exact;
  return (reach_of(family, cycles, more).r_m - reach_of(family, cycles, less).r_m) / (2 * far);
}

/// Solves for the one crossing of the range between two places of an interval, by Newton's method in a bracket.
void Eigenrays::Search::solve(double low, double high, double v1, double v2, double f1, Family family, int cycles) {
  double v = (v1 + v2) / 2, xi = 0;
  for (int round = 0; round < 80; ++round) {
    xi = xi_at(low, high, v);
    const RayReach reach = reach_of(family, cycles, ray_legs(profile(), depths, xi));
    const double f = reach.r_m - query.range_m;
    if (std::abs(f) < 1e-9 * (1 + query.range_m)) break;
    ((f > 0) == (f1 > 0) ? v1 : v2) = v;
    const double next = v - f / (reach.by_xi * xi_by_v(low, high, v));
    const bool inside = next > std::min(v1, v2) && next < std::max(v1, v2);
    const double to = inside ? next : (v1 + v2) / 2;
    if (to == v) break;
    v = to;
  }
  add(xi, family, cycles);
}

/// Searches the crossings between two nodes of an interval on the same side of the range, about an extreme.
void Eigenrays::Search::search_extreme(double low, double high, std::size_t node, const RayReach& a, const RayReach& b,
                                       Family family, int cycles) {
  const Nodes& places = nodes_of_table();
  const double v1 = places.v[node], v2 = places.v[node + 1];
  const double f1 = a.r_m - query.range_m, f2 = b.r_m - query.range_m;
  const double d1 = a.by_xi * (high - low) * places.by_v[node], d2 = b.by_xi * (high - low) * places.by_v[node + 1];
  // The tangents bound the extreme where the function bends one way.
  const double bound = f1 + d1 * ((f2 - f1 + d1 * v1 - d2 * v2) / (d1 - d2) - v1);
  if ((bound > 0) == (f1 > 0)) return;
  // Bisect for the extreme by its derivative.
  double left = v1, right = v2;
  for (int round = 0; round < 50; ++round) {
    const double v = (left + right) / 2;
    const RayReach reach = reach_of(family, cycles, ray_legs(profile(), depths, xi_at(low, high, v)));
    if ((reach.r_m > query.range_m) != (f1 > 0)) {
      solve(low, high, v1, v, f1, family, cycles);
      solve(low, high, v2, v, f2, family, cycles);
      return;
    }
    ((reach.by_xi > 0) == (d1 > 0) ? left : right) = v;
  }
}

void Eigenrays::Search::search_piece(double low, double high, const std::array<RayLegs, nodes>& legs) {
  const Nodes& places = nodes_of_table();
  for (const Family family : families) {
    const bool swings = family == Family::down_down || family == Family::up_up;
    for (int cycles = swings ? 1 : 0; cycles < max_cycles && allowed(family, cycles, legs[nodes / 2]); ++cycles) {
      std::array<RayReach, nodes> reach;
      double nearest_m = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < reach.size(); ++i) {
        reach[i] = reach_of(family, cycles, legs[i]);
        nearest_m = std::min(nearest_m, reach[i].r_m);
      }
      for (std::size_t i = 0; i + 1 < reach.size(); ++i) {
        const bool beyond = reach[i].r_m > query.range_m;
        if (beyond != (reach[i + 1].r_m > query.range_m))
          solve(low, high, places.v[i], places.v[i + 1], reach[i].r_m - query.range_m, family, cycles);
        else if (beyond ? reach[i].by_xi < 0 && reach[i + 1].by_xi > 0 : reach[i].by_xi > 0 && reach[i + 1].by_xi < 0)
          search_extreme(low, high, i, reach[i], reach[i + 1], family, cycles);
      }
      if (nearest_m > 1.5 * query.range_m) break;  // and more so after another cycle
    }
  }
}

/// Searches the ray without a turning point of one family.  Its range falls with the sine of its angle in the fastest
/// water on its way, from that of the ray which is horizontal there to 0.
void Eigenrays::Search::search_steep(double fastest_mps, Family family, int cycles) {
  const RayReach heights{depths.upper_m, 0}, between{depths.lower_m - depths.upper_m, 0},
      below{depths.water_m - depths.lower_m, 0};
  const double height_m = sum_of(family, cycles, heights, between, below).r_m;
  double xi = 0;
  const auto miss = [&](double sine, double& by_sine) {
    const double cosine = std::sqrt((1 - sine) * (1 + sine));
    xi = cosine / fastest_mps;
    const RayReach reach = cycles == 0 && family == Family::down_down
                               ? reach_between(profile(), depths, xi)
                               : reach_of(family, cycles, ray_legs(profile(), depths, xi));
    by_sine = -reach.by_xi * sine / std::max(cosine * fastest_mps, 1e-300);
    return reach.r_m - query.range_m;
  };
  // In slower water the ray is steeper, so the straight line bounds the sine.
  double by_sine = 0, low = 1e-12, high = height_m / std::hypot(height_m, query.range_m);
  if (high <= low || miss(low, by_sine) <= 0) return;
  double sine = high;
  for (int round = 0; round < 80; ++round) {
    const double f = miss(sine, by_sine);
    if (std::abs(f) < 1e-10 * (1 + query.range_m)) break;
    (f > 0 ? low : high) = sine;
    const double next = sine - f / by_sine;
    const double to = next > low && next < high ? next : (low + high) / 2;
    if (to == sine) break;
    sine = to;
  }
  add(xi, family, cycles);
}

/// Searches the rays that are reversed by surface and bottom only.
void Eigenrays::Search::search_bounces() {
  const RayLegs steep = ray_legs(profile(), depths, 0.5 / depths.highest_mps);
  for (const Family family : families) {
    const bool swings = family == Family::down_down || family == Family::up_up;
    for (int cycles = swings ? 1 : 0; allowed(family, cycles, steep); ++cycles)
      search_steep(depths.highest_mps, family, cycles);
  }
}

void Eigenrays::find(const RayQuery& query, std::vector<SoundRay>& rays) const {
  rays.clear();
  const bool has_bottom = query.water_m < profile_.deepest_m();
  const double water_m = std::max(0.0, std::min(query.water_m, profile_.deepest_m()));
  const double source_m = std::clamp(query.source_m, 0.0, water_m);
  const double receiver_m = std::clamp(query.receiver_m, 0.0, water_m);
  const RayDepths depths(profile_, std::min(source_m, receiver_m), std::max(source_m, receiver_m), water_m, has_bottom);
  Search search{*this, query, depths, source_m <= receiver_m, rays};
  // A horizontal ray in water of one speed, or to the same place.
  const bool level = depths.lower_m - depths.upper_m < 1e-9;
  if (level && (std::abs(profile_.gradient(depths.upper_layer)) < 1e-12 || query.range_m < 1e-6)) {
    SoundRay ray;
    ray.travel_time_s = query.range_m / depths.upper_mps;
    ray.power_per_m2 = 1 / std::max(query.range_m * query.range_m, 1e-12);
    rays.push_back(ray);
    const double xi = 1 / depths.upper_mps;
    search.roots.push_back({static_cast<int>(Family::down_down), 0, xi, -1, 0, search.thin_layer(xi)});
  }
  // The direct ray.
  if (!level) search.search_steep(depths.highest_between_mps, Family::down_down, 0);
  if (query.max_bounces > 0 && water_m > 0) search.search_bounces();
  // Rays with turning points: intervals of xi between those that are horizontal at the points and at the fastest water.
  const double slow = depths.highest_between_mps, fast = depths.highest_mps;
  for (const Interval& interval : intervals_) {
    const double low_mps = std::max(interval.low_mps, slow), high_mps = std::min(interval.high_mps, fast);
    if (low_mps >= high_mps) continue;
    if (!search.may_turn(interval)) continue;
    std::array<RayLegs, nodes> legs;
    const bool cut = depths.water_mps > low_mps && depths.water_mps < high_mps;
    if (!cut && low_mps == interval.low_mps && high_mps == interval.high_mps) {
      for (int node = 0; node < nodes; ++node) legs[static_cast<std::size_t>(node)] = legs_of(interval, node, depths);
      search.search_piece(1 / high_mps, 1 / low_mps, legs);
      continue;
    }
    const std::array<double, 3> edges{low_mps, cut ? depths.water_mps : high_mps, high_mps};
    for (std::size_t part = 0; part < 2; ++part) {
      if (edges[part] >= edges[part + 1]) continue;
      const double low = 1 / edges[part + 1], high = 1 / edges[part];
      for (int node = 0; node < nodes; ++node)
        legs[static_cast<std::size_t>(node)] = ray_legs(profile_, depths, xi_of_node(low, high, node));
      search.search_piece(low, high, legs);
    }
  }
  if (rays.size() > 1) {
    merge_false_rays(rays, search.roots);
    pair_twins(rays, search.roots);
  }
  std::stable_sort(rays.begin(), rays.end(),
                   [](const SoundRay& a, const SoundRay& b) { return a.travel_time_s < b.travel_time_s; });
}

}  // namespace sim
