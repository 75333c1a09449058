// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/dvl.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "devices/ranging/ray_casting.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/dvl_t.hpp"
#include "sim/config/presets.hpp"
#include "sim/world/world.hpp"

namespace devices {

const sim::Presets& dvl_presets();  // dvl_presets.yaml

namespace {

/// Normal equations of the least-squares problem b_i . v = value_i over the beams in use.
struct BeamSystem {
  sim::Matrix3d inverse = sim::Matrix3d::Zero();  ///< inverse of the sum of b_i b_i^T
  sim::Vector3d right = sim::Vector3d::Zero();

  sim::Vector3d solution() const { return inverse * right; }
};

/// Returns the normal equations for the beams with use(i) and their values value(i); empty for fewer than three beams.
template <typename Use, typename Value>
std::optional<BeamSystem> beam_system(const std::array<sim::Vector3d, dvl_beams>& beams_S, Use use, Value value) {
  sim::Matrix3d sum = sim::Matrix3d::Zero();
  BeamSystem system;
  int used = 0;
  for (std::size_t i = 0; i < dvl_beams; ++i) {
    if (!use(i)) continue;
    ++used;
    sum += beams_S[i] * beams_S[i].transpose();
    system.right += value(i) * beams_S[i];
  }
  if (used < 3) return {};
  system.inverse = sum.inverse();
  return system;
}

}  // namespace

void Dvl::Params::read(sim::ParamReader& in) {
  dvl_presets().read(in, *this, {}, "preset of a product by its data sheet; the keys below override it");
  // Geometry and detection of beams.
  in.read_deg("beam_angle_deg", beam_angle_rad, sim::between(5, 60), "between each beam and -z");
  in.read_deg("first_azimuth_deg", first_azimuth_rad, sim::between(-360, 360),
              "azimuth of the first beam, from x towards y; the others follow every 90 deg");
  in.read("altitude_min_m", altitude_min_m, sim::at_least(0),
          "minimum distance along -z at which a beam detects the bottom");
  in.read("altitude_max_m", altitude_max_m, sim::above_to(0, 10000),
          "maximum distance along -z at which a beam detects the bottom");
  in.read_deg("incidence_max_deg", incidence_max_rad, sim::above_to(0, 90),
              "maximum angle of incidence, from the normal of the bottom, that returns an echo");
  in.read("beam_dropout", beam_dropout, sim::between(0, 1), "probability that a beam is lost, drawn for each beam");
  // Water track.
  in.read("water_track", water_track, "also measure the velocity relative to a layer of water");
  in.read("layer_from_m", layer_from_m, sim::at_least(0), "start of that layer along -z");
  in.read("layer_to_m", layer_to_m, sim::above(0), "end of that layer along -z");
  // Errors.
  in.read("beam_std_mps", beam_std_mps, sim::at_least(0), "white noise of each beam, standard deviation");
  in.read("beam_std_per_mps", beam_std_per_mps, sim::at_least(0), "its increase per m/s of speed");
  in.read("scale_std", scale_std, sim::at_least(0),
          "standard deviation of a relative error of all velocities, drawn once in a run");
  in.read("assumed_sound_speed_mps", assumed_sound_speed_mps, sim::between(100, 10000),
          "velocities and ranges are off by its ratio to the true speed; unset: the true speed");
  in.read_references("see_through", see_through, "category", "categories of parts that sound passes through");
  in.read("beam_noise", beam_noise, "further error of the velocity along each beam, m/s");
  in.read("velocity_noise", velocity_noise, "error of each component of the velocities, m/s");
  in.read("range_noise", range_noise, "error of the range of each beam, m");
  if (in.describing()) return;
  if (altitude_min_m >= altitude_max_m) in.error("altitude_min_m", "'altitude_min_m' must be < altitude_max_m");
  if (layer_from_m >= layer_to_m) in.error("layer_from_m", "'layer_from_m' must be < layer_to_m");
}

Dvl::Dvl(const Params& params, const sim::DeviceContext& context)
    : physics_(context.world.physics()),
      medium_(context.world.medium()),
      own_group_(context.vehicle.group()),
      beam_fault_(*context.noise_origin(params.beam_noise).fault),
      beam_noise_(context, params, dvl_beams),
      water_beam_noise_(context, params, dvl_beams),
      velocity_noise_(context, params, 3),
      water_velocity_noise_(context, params, 3),
      range_noise_(context, params, dvl_beams) {
  // Drawn once per run: the scale error of an instrument does not change while it runs.
  sim::Random scale(context.world.seed(), context.full_name() + "#scale");
  scale.begin_step(0);
  scale_draw_ = scale.gaussian();
  change(params);
}

void Dvl::change(const Params& params) {
  params_ = params;
  filter_ = make_ray_filter(physics_, sim::RayKind::sound, params.see_through, own_group_, false);
  const double s = std::sin(params.beam_angle_rad), c = std::cos(params.beam_angle_rad);
  for (std::size_t i = 0; i < dvl_beams; ++i) {
    const double azimuth_rad = params.first_azimuth_rad + static_cast<double>(i) * std::numbers::pi / 2;
    beams_S_[i] = {s * std::cos(azimuth_rad), s * std::sin(azimuth_rad), -c};
  }
}

void Dvl::measure(const sim::SenseContext& context) {
  reading_ = {};
  const sim::Vector3d& p_WS = context.X_WS.translation();
  if (!medium_.in_water(p_WS)) return;
  sound_scale_ = params_.assumed_sound_speed_mps ? *params_.assumed_sound_speed_mps / medium_.sound_speed_mps(p_WS) : 1;
  speed_mps_ = context.v_WS_W.norm();
  // Cast one ray per beam.
  const double cosine = std::cos(params_.beam_angle_rad);
  std::array<sim::Ray, dvl_beams> rays_W;
  std::array<sim::RayHit, dvl_beams> hits;
  for (std::size_t i = 0; i < dvl_beams; ++i)
    rays_W[i] = {p_WS, context.X_WS.linear() * beams_S_[i], params_.altitude_max_m / cosine};
  context.world.scene().cast(rays_W, filter_, hits);
  // True measurements of each beam.
  for (std::size_t i = 0; i < dvl_beams; ++i) {
    Beam& beam = reading_.beams[i];
    const sim::RayHit& hit = hits[i];
    const sim::Vector3d& direction_W = rays_W[i].direction_W;
    // The echo needs a hit in water, beyond the minimum altitude and within the maximum angle of incidence.
    const bool echo = hit.hit() && hit.range_m * cosine >= params_.altitude_min_m &&
                      -hit.normal_W.dot(direction_W) >= std::cos(params_.incidence_max_rad) &&
                      medium_.in_water(p_WS + hit.range_m * direction_W);
    beam.sees_bottom = echo;
    beam.range_m = hit.hit() ? hit.range_m : rays_W[i].range_max_m;
    beam.velocity_mps = direction_W.dot(context.v_WS_W);
    if (params_.water_track) listen_to_water(rays_W[i], context.v_WS_W, beam);
  }
  solve();
}

// Mean over three points, at the centers of the thirds of the layer.
void Dvl::listen_to_water(const sim::Ray& ray_W, const sim::Vector3d& v_WS_W, Beam& beam) const {
  const double cosine = std::cos(params_.beam_angle_rad);
  const double thickness_m = params_.layer_to_m - params_.layer_from_m;
  if (beam.range_m * cosine < params_.layer_to_m) return;  // bottom within the layer
  if (!medium_.in_water(ray_W.origin_W + params_.layer_to_m / cosine * ray_W.direction_W)) return;
  sim::Vector3d v_water_W = sim::Vector3d::Zero();
  for (const double share : {1.0 / 6, 3.0 / 6, 5.0 / 6}) {
    const double range_m = (params_.layer_from_m + share * thickness_m) / cosine;
    v_water_W += medium_.water_velocity_W(ray_W.origin_W + range_m * ray_W.direction_W) / 3;
  }
  beam.detects_water = true;
  beam.water_mps = ray_W.direction_W.dot(v_WS_W - v_water_W);
}

double Dvl::expected_beam_std_mps() const {
  return params_.beam_std_mps + params_.beam_std_per_mps * speed_mps_;
}

void Dvl::solve() {
  const auto& beams = reading_.beams;
  reading_.velocity_S.reset();
  reading_.water_velocity_S.reset();
  const auto sees_bottom = [&](std::size_t i) { return beams[i].sees_bottom; };
  const auto over_bottom = beam_system(beams_S_, sees_bottom, [&](std::size_t i) { return beams[i].velocity_mps; });
  if (over_bottom) {
    reading_.velocity_S = over_bottom->solution();
    const double white_mps = params_.beam_noise.gaussian_std;
    reading_.fom_mps = std::sqrt(over_bottom->inverse.trace()) * std::hypot(expected_beam_std_mps(), white_mps);
    // Fit a plane n . p = d to the bottom: range = d / (n . b), so that 1 / range = (n / d) . b is linear in b.
    const auto plane = beam_system(beams_S_, sees_bottom, [&](std::size_t i) { return 1 / beams[i].range_m; });
    reading_.altitude_m = std::clamp(-1 / plane->solution().z(), 0.0, 2 * params_.altitude_max_m);
  }
  // Velocity through the water.
  const auto through_water = beam_system(
      beams_S_, [&](std::size_t i) { return beams[i].detects_water; },
      [&](std::size_t i) { return beams[i].water_mps; });
  if (through_water) reading_.water_velocity_S = through_water->solution();
}

void Dvl::disturb(double dt_s, sim::Random& random) {
  // Scale errors and white noise of each beam.
  const double scale = sound_scale_ * (1 + params_.scale_std * scale_draw_);
  const double white_mps = beam_fault_.factor * expected_beam_std_mps();
  std::array<double, dvl_beams> bottom_mps, water_mps, ranges_m;
  for (std::size_t i = 0; i < dvl_beams; ++i) {
    bottom_mps[i] = reading_.beams[i].velocity_mps * scale + white_mps * random.gaussian();
    water_mps[i] = reading_.beams[i].water_mps * scale + white_mps * random.gaussian();
    ranges_m[i] = reading_.beams[i].range_m * sound_scale_;
  }
  // Configured noise.
  beam_noise_.apply(bottom_mps, dt_s, random);
  water_beam_noise_.apply(water_mps, dt_s, random);
  range_noise_.apply(ranges_m, dt_s, random);
  for (std::size_t i = 0; i < dvl_beams; ++i) {
    Beam& beam = reading_.beams[i];
    // Store the measurements and drop beams at random.
    beam.velocity_mps = bottom_mps[i];
    beam.water_mps = water_mps[i];
    beam.range_m = std::max(ranges_m[i], 1e-3);
    if (random.uniform() < params_.beam_dropout) beam.sees_bottom = false;
    if (random.uniform() < params_.beam_dropout) beam.detects_water = false;
  }
  solve();
  // Advance correlated errors even without lock.
  const auto disturb_velocity = [&](sim::Noise& noise, std::optional<sim::Vector3d>& velocity) {
    sim::Vector3d value = velocity.value_or(sim::Vector3d::Zero());
    noise.apply(std::span<double>(value.data(), 3), dt_s, random);
    if (velocity) velocity = value;
  };
  disturb_velocity(velocity_noise_, reading_.velocity_S);
  disturb_velocity(water_velocity_noise_, reading_.water_velocity_S);
}

void Dvl::visit_state(sim::StateArchive& archive) {
  archive(beam_noise_, water_beam_noise_, velocity_noise_, water_velocity_noise_, range_noise_);
  // Out of the water, errors are scaled with the last values.
  archive(sound_scale_, speed_mps_, reading_);
}

void fill(const Dvl& dvl, shoal::dvl_t& message) {
  const Dvl::Reading& reading = dvl.reading();
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  message.bottom_lock = reading.velocity_S.has_value();
  message.water_lock = reading.water_velocity_S.has_value();
  for (int i = 0; i < 3; ++i) {
    message.velocity_mps[i] = reading.velocity_S ? (*reading.velocity_S)[i] : nothing;
    message.water_velocity_mps[i] = reading.water_velocity_S ? (*reading.water_velocity_S)[i] : nothing;
  }
  message.fom_mps = reading.velocity_S ? reading.fom_mps : nothing;
  message.altitude_m = reading.velocity_S ? reading.altitude_m : nothing;
  for (std::size_t i = 0; i < dvl_beams; ++i) {
    const Dvl::Beam& beam = reading.beams[i];
    message.beam_valid[i] = beam.sees_bottom;
    message.beam_range_m[i] = beam.sees_bottom ? beam.range_m : nothing;
    message.beam_velocity_mps[i] = beam.sees_bottom ? beam.velocity_mps : nothing;
  }
}

SHOAL_SENSOR("dvl", Dvl, shoal::dvl_t);

}  // namespace devices
