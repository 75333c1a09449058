// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/laser_return.hpp"

#include <algorithm>
#include <cmath>

#include "devices/ranging/ray_casting.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

/// Angle from normal incidence at which the specular share falls to 1/e, as its sine.
const double gloss_width_sine = std::sin(sim::degrees_to_radians(3.0));
constexpr double dark_reflectivity = 0.1;

}  // namespace

void LaserWeather::read(sim::ParamReader& in) {
  in.read("extinction_per_m", extinction_per_m, sim::between(0, 10), "share of the power lost per meter, each way");
  in.read("false_returns_per_m", false_returns_per_m, sim::between(0, 10),
          "returns from drops per meter of beam; their ranges are exponential with the mean 1 / this");
  in.read("drop_intensity", drop_intensity, sim::at_least(0), "intensity of a return from a drop");
}

void LaserParams::read(sim::ParamReader& in) {
  // Range and its errors.
  in.read("range_min_m", range_min_m, sim::at_least(0),
          "minimum range: closer hits report this, and are not points of a cloud");
  in.read("range_max_m", range_max_m, sim::above(0), "maximum range: a ray that hits nothing reports this");
  in.read("resolution_m", resolution_m, sim::at_least(0), "ranges are rounded to multiples of this; 0: not");
  in.read("range_std_m", range_std_m, sim::at_least(0),
          "standard deviation of the white range noise at zero range ...");
  in.read("range_std_per_m", range_std_per_m, sim::between(0, 1),
          "... and the increase of its standard deviation per meter");
  // Detection and beam.
  in.read_or_word("range_at_10_percent_m", dark_range_m, sim::above(0), {"unlimited"},
                  "largest range at which a surface of reflectivity 0.1 is detected at normal incidence; unlimited: "
                  "every surface is");
  in.read_deg("beam_divergence_deg", beam_divergence_rad, sim::between(0, 30), "full divergence angle of a beam");
  in.read("beam_samples", beam_samples, sim::between(1, 100), "rays that sample a beam; 1: its axis only");
  in.read("merge_m", merge_m, sim::at_least(0),
          "echoes of one beam closer together than this (half a pulse length) merge into one, at their mean weighted "
          "by power");
  in.read_choice("returns", returns, {{"strongest", Returns::strongest}, {"first", Returns::first}},
                 "which of several echoes of a beam is reported");
  // Filter, weather and noise.
  in.read("sees_own_vehicle", sees_own_vehicle, "rays also hit parts of its own vehicle");
  in.read_references("see_through", see_through, "category", "categories of parts that rays pass through");
  in.read("weather", weather, "rain, fog or dust");
  in.read("noise", noise, "error of each range, m");
  if (in.describing()) return;
  if (range_min_m >= range_max_m) in.error("range_min_m", "'range_min_m' must be < range_max_m");
  if (beam_samples > 1 && beam_divergence_rad == 0)
    in.error("beam_samples", "'beam_samples' > 1 needs the key 'beam_divergence_deg'");
}

void LaserReturns::assign(std::size_t beams, double range_m) {
  ranges_m.assign(beams, range_m);
  intensities.assign(beams, 0.0);
  returned.assign(beams, none);
}

void LaserReturns::set_limit(std::size_t beam, std::uint8_t kind, double range_m) {
  ranges_m[beam] = range_m;
  if (!intensities.empty()) intensities[beam] = 0;  // a scanner that needs none has none
  returned[beam] = kind;
}

LaserReceiver::LaserReceiver(const LaserParams& params, const sim::DeviceContext& context)
    : physics_(context.world.physics()),
      own_group_(context.vehicle.group()),
      noise_(context, params),
      fault_(*context.noise_origin(params.noise).fault) {
  change(params);
}

void LaserReceiver::change(const LaserParams& params) {
  params_ = params;
  noise_.change(params);
  filter_ = make_ray_filter(physics_, sim::RayKind::laser, params.see_through, own_group_, params.sees_own_vehicle);
  pattern_ = cone_pattern(params.beam_divergence_rad / 2, params.beam_samples);
}

double LaserReceiver::intensity(const sim::RayHit& hit, const sim::Vector3d& direction_W) const {
  const sim::LaserSurface& surface = physics_.material(hit.material).laser;
  const double cosine = std::clamp(-hit.normal_W.dot(direction_W), 0.0, 1.0);
  double back = (1 - surface.gloss) * cosine;
  if (surface.gloss > 0)
    back += surface.gloss * std::exp(-(1 - cosine * cosine) / (gloss_width_sine * gloss_width_sine));
  const double air = params_.weather.extinction_per_m;
  return surface.reflectivity * back * (air > 0 ? std::exp(-2 * air * hit.range_m) : 1.0);
}

double LaserReceiver::threshold(double range_m) const {
  if (params_.dark_range_m == 0) return 0;
  const double share = range_m / params_.dark_range_m;
  return dark_reflectivity * share * share;
}

void LaserReceiver::receive(const sim::RayHit& hit, const sim::Vector3d& direction_W, LaserReturns& returns,
                            std::size_t i) const {
  returns.set_limit(i, LaserReturns::none, params_.range_max_m);
  if (!hit.hit()) return;
  const double power = intensity(hit, direction_W);
  if (power >= threshold(hit.range_m)) set_return(returns, i, hit.range_m, power);
}

void LaserReceiver::set_return(LaserReturns& returns, std::size_t i, double range_m, double power) const {
  if (range_m < params_.range_min_m) return returns.set_limit(i, LaserReturns::too_near, params_.range_min_m);
  returns.ranges_m[i] = std::min(range_m, params_.range_max_m);
  returns.intensities[i] = power;
  returns.returned[i] = LaserReturns::echo;
}

void LaserReceiver::receive(std::span<const sim::RayHit> hits, std::span<const sim::Ray> rays, LaserReturns& returns,
                            std::size_t i) {
  if (hits.size() == 1) return receive(hits.front(), rays.front().direction_W, returns, i);
  returns.set_limit(i, LaserReturns::none, params_.range_max_m);
  // Echoes of all rays, sorted by range.
  echoes_.clear();
  for (std::size_t k = 0; k < hits.size(); ++k)
    if (hits[k].hit())
      echoes_.push_back({hits[k].range_m, intensity(hits[k], rays[k].direction_W) / static_cast<double>(hits.size())});
  std::sort(echoes_.begin(), echoes_.end(), [](const Echo& a, const Echo& b) { return a.range_m < b.range_m; });
  // Merge close echoes and select the first or strongest one.
  const bool first = params_.returns == LaserParams::Returns::first;
  for (std::size_t from = 0, to = 0; from < echoes_.size(); from = to) {
    double power = 0, moment = 0, sum_m = 0;
    for (; to < echoes_.size() && (to == from || echoes_[to].range_m - echoes_[from].range_m < params_.merge_m); ++to) {
      power += echoes_[to].power;
      moment += echoes_[to].power * echoes_[to].range_m;
      sum_m += echoes_[to].range_m;
    }
    // Use the unweighted mean for black surfaces, which return no power.
    const double mean_m = power > 0 ? moment / power : sum_m / static_cast<double>(to - from);
    const bool has_echo = returns.returned[i] == LaserReturns::echo;
    if (power < threshold(mean_m) || (has_echo && power <= returns.intensities[i])) continue;
    set_return(returns, i, mean_m, power);
    if (first && returns.returned[i] == LaserReturns::echo) return;
  }
}

void LaserReceiver::disturb(LaserReturns& returns, double dt_s, sim::Random& random) {
  std::vector<double>& ranges_m = returns.ranges_m;
  // Returns from drops in front of the target.
  if (params_.weather.false_returns_per_m > 0) {
    for (std::size_t i = 0; i < ranges_m.size(); ++i) {
      const double drop_m = -std::log(random.uniform()) / params_.weather.false_returns_per_m;
      if (drop_m >= ranges_m[i] || drop_m < params_.range_min_m) continue;
      ranges_m[i] = drop_m;
      returns.intensities[i] = params_.weather.drop_intensity;
      returns.returned[i] = LaserReturns::echo;
    }
  }
  // Noise of the ranges.
  if (params_.range_std_m > 0 || params_.range_std_per_m > 0)
    for (double& range_m : ranges_m)
      range_m += fault_.factor * (params_.range_std_m + params_.range_std_per_m * range_m) * random.gaussian();
  noise_.apply(std::span<double>(ranges_m), dt_s, random);
  // Quantization and limits.
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    if (params_.resolution_m > 0) ranges_m[i] = std::round(ranges_m[i] / params_.resolution_m) * params_.resolution_m;
    std::uint8_t kind = returns.returned[i];
    if (kind == LaserReturns::echo && ranges_m[i] < params_.range_min_m) kind = LaserReturns::too_near;
    if (kind == LaserReturns::echo && ranges_m[i] > params_.range_max_m) kind = LaserReturns::none;
    if (kind != LaserReturns::echo)
      returns.set_limit(i, kind, kind == LaserReturns::none ? params_.range_max_m : params_.range_min_m);
  }
}

}  // namespace devices
