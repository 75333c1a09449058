// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/marine_radar.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "devices/common/named_vehicle.hpp"
#include "devices/common/radio_horizon.hpp"
#include "devices/ranging/ray_casting.hpp"
#include "devices/ranging/sonar_return.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/radar_sector_t.hpp"

namespace devices {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr double silence_dBm = -1000;  // of a cell that is not received, below every floor
constexpr double fan_density = 5;      // of the rays of the fan at the horizon, see fan_elevation_rad()
const double sinh_of_density = std::sinh(fan_density);
constexpr double max_values = 4e6;  // of a sector

/// Whether the world or its file has an object of this name.
bool is_object(const sim::World& world, const std::string& name) {
  const auto& all = world.config().objects;
  return world.find_object(name) != nullptr || std::any_of(all.begin(), all.end(), [&](const auto& object) {
           return object.count > 1 ? name.starts_with(object.name) : name == object.name;
         });
}

}  // namespace

void MarineRadar::Params::read(sim::ParamReader& in) {
  // Antenna and image.
  in.read("rotation_rpm", rotation_rpm, sim::between(0.1, 600), "turns of the antenna in a minute, clockwise");
  in.read("spokes", spokes, sim::between(1, 16384), "directions in a turn");
  in.read("range_cells", range_cells, sim::between(1, 8192), "steps in range of a spoke");
  in.read("range_min_m", range_min_m, sim::at_least(0),
          "blind range: nothing nearer is received, because the receiver is off while it transmits");
  in.read("range_max_m", range_max_m, sim::above_to(0, 150000), "range scale: end of the last cell");
  radar.read(in);
  // Rays.
  in.read("beam_rays", beam_rays, sim::between(1, 50), "columns of rays over twice the width of the beam");
  in.read("elevation_rays", elevation_rays, sim::between(2, 1000),
          "rays of a column, over twice the height of the beam, densest at the horizon");
  in.read("target_rays", target_rays, sim::between(1, 50),
          "rays across a vehicle or object no wider than twice the beam, and as many over its height");
  // Echoes.
  in.read("target_dB", target_dB, sim::between(-60, 60),
          "radar cross section of vehicles and objects over their projected area; 0: as a large metal sphere");
  in.read("land_dB", land_dB, sim::between(-60, 60), "the same of planes and terrains: gamma of the land");
  in.read_list("rcs", rcs, "rcs", "radar cross sections of single vehicles and objects, in place of 'target_dB'");
  in.read("sea_state", sea_state, sim::between(0, 6),
          "sea state for the echo of the sea; unset: that of the waves of the world, without waves of its wind");
  in.read(
      "clutter_shape", clutter_shape, sim::between(0.05, 1000),
      "shape of the K distribution of the echo of the sea, small: spiky; unset: Rayleigh, its limit for large ones");
  // Output.
  in.read("floor_dBm", floor_dBm, sim::any_number(), "level of the value 0");
  in.read("dynamic_range_dB", dynamic_range_dB, sim::between(1, 200), "from the value 0 to the value 255");
  in.read("level_noise", level_noise, "further error of each level, dB");
  in.read("sees_own_vehicle", sees_own_vehicle, "its own vehicle stops rays: blind sectors behind masts");
  in.read_references("see_through", see_through, "category", "categories of parts that radar passes through");
  if (in.describing()) return;
  // Limits that depend on several keys.
  if (range_min_m >= range_max_m)
    in.error("range_min_m",
             fmt::format("'range_min_m' must be < range_max_m, got {:g} and {:g}", range_min_m, range_max_m));
  const RayFactor factors[] = {
      {"spokes", double(spokes)}, {"beam_rays", double(beam_rays)}, {"elevation_rays", double(elevation_rays)}};
  check_rays(in, factors);
  const double rate_hz = rate_hz_of(in, default_rate_hz);
  const double values = rate_hz > 0 ? std::ceil(spokes * rotation_rpm / 60 / rate_hz) * range_cells : 0;
  if (values > max_values)
    in.error("range_cells", fmt::format("the spokes between two reports must have at most {:.0f} cells, got {:.0f}",
                                        max_values, values));
}

MarineRadar::MarineRadar(const Params& params, const sim::DeviceContext& context)
    : world_(context.world), own_group_(context.vehicle.group()), level_noise_(context, params) {
  for (const RadarCrossSection& entry : params.rcs)
    if (named_vehicle(world_, entry.name) == nullptr && !is_object(world_, entry.name))
      sim::throw_config_error(context.config.place, "device '" + context.full_name() + "'",
                              "'rcs' names what is neither a vehicle nor an object: '" + entry.name + "'");
  change(params);
}

void MarineRadar::change(const Params& params) {
  params_ = params;
  level_noise_.change(params);
  echo_mWm2_ = params.radar.echo_constant_mWm2();
  sea_state_ = params.sea_state ? *params.sea_state : sea_state_of(world_.medium());
  resolution_m_ = std::max(params.radar.pulse_m(), params.cell_m());
  target_factor_ = std::pow(10, params.target_dB / 10);
  land_factor_ = std::pow(10, params.land_dB / 10);
  column_widths_rad_.clear();
  for (int column = 0; column < params.beam_rays; ++column) {
    const double response = beam_response(fan_offset_rad(column), params.radar.horizontal_rad);
    column_widths_rad_.push_back(response * response * 2 * params.radar.horizontal_rad / params.beam_rays);
  }
  filter_ =
      make_ray_filter(world_.physics(), sim::RayKind::any, params.see_through, own_group_, params.sees_own_vehicle);
  targets_.forget();
  clear();
}

void MarineRadar::clear() {
  spokes_.clear();
  echo_mW_.clear();
  clutter_mW_.clear();
  reported_ = false;
}

std::optional<sim::FieldOfView> MarineRadar::field_of_view() const {
  sim::FieldOfView view{sim::FieldOfView::Kind::fan, params_.range_max_m, params_.range_min_m};
  view.from_rad = -std::numbers::pi;
  view.to_rad = std::numbers::pi;
  return view;
}

std::int64_t MarineRadar::rays() const {
  const double spokes = params_.spokes * params_.rotation_rpm / 60 * world_.physics().step_s();
  return static_cast<std::int64_t>(std::ceil(spokes)) * params_.beam_rays * params_.elevation_rays;
}

void MarineRadar::sweep(const sim::SweepContext& context) {
  // Spokes from before a pause, such as a time without power, are not reported.
  if (reported_ || context.from != swept_to_) clear();
  swept_to_ = context.now;
  targets_.update(context.world, own_group_, params_.rcs);
  const std::int64_t turn_us = std::llround(60e6 / params_.rotation_rpm);
  const auto time_of = [&](std::int64_t turn, std::int64_t spoke) {
    return sim::Time{turn * turn_us + spoke * turn_us / params_.spokes};
  };
  std::int64_t turn = context.from.count() / turn_us;
  std::int64_t spoke = context.from.count() % turn_us * params_.spokes / turn_us;
  for (; time_of(turn, spoke) <= context.now; ++spoke) {
    if (spoke == params_.spokes) spoke = 0, ++turn;
    if (time_of(turn, spoke) > context.from) add_spoke(context, time_of(turn, spoke), static_cast<int>(spoke));
  }
}

void MarineRadar::add_spoke(const sim::SweepContext& context, sim::Time at, int number) {
  spokes_.push_back({at, sim::wrap_angle(-two_pi * number / params_.spokes)});
  const auto cells = static_cast<std::size_t>(params_.range_cells);
  echo_mW_.resize(spokes_.size() * cells, 0);
  clutter_mW_.resize(spokes_.size() * cells, 0);
  RadarLook look{context.X_WS_at(at)};
  const sim::Vector3d p_W = look.X_WS.translation();
  if (world_.medium().has_water() && world_.medium().in_water(p_W)) return;
  const double azimuth_rad = spokes_.back().azimuth_rad;
  const sim::Vector3d axis_W = look.X_WS.linear() * sim::Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0);
  look.heading_rad = std::atan2(axis_W.y(), axis_W.x());
  look.surface_m = world_.medium().still_surface_m();
  look.height_m = p_W.z() - look.surface_m;
  samples_.clear();
  rays_.clear();
  cast_fan(look, number);
  aim_at_targets(look);
  if (hits_.size() < rays_.size()) hits_.resize(rays_.size());
  context.world.scene().cast(rays_, filter_, std::span(hits_).first(rays_.size()));
  add_echoes(look);
  if (world_.medium().has_water() && look.height_m > 0) add_clutter(look);
}

/// Returns the azimuth of a column of the fan from the axis of the beam.
double MarineRadar::fan_offset_rad(int column) const {
  return (column + 0.5 - 0.5 * params_.beam_rays) * 2 * params_.radar.horizontal_rad / params_.beam_rays;
}

/// Returns the elevation at a place from 0, the bottom of the fan, to its number of rays: by sinh the rays are 15 times
/// as dense at the horizon as evenly spread ones, where a wall of 2 m has a height of 0.1 degrees at 1 km.
double MarineRadar::fan_elevation_rad(double place) const {
  const double u = 2 * place / params_.elevation_rays - 1;
  const double elevation_rad = params_.radar.vertical_rad * std::sinh(fan_density * u) / sinh_of_density;
  return std::clamp(elevation_rad, -std::numbers::pi / 2, std::numbers::pi / 2);
}

void MarineRadar::cast_fan(const RadarLook& look, int number) {
  const double width_rad = 2 * params_.radar.horizontal_rad / params_.beam_rays;
  shifts_.clear();
  for (int column = 0; column < params_.beam_rays; ++column) {
    // The golden ratio spreads the lowest rays of all columns evenly between two rays.
    const double turns = (static_cast<double>(number) * params_.beam_rays + column) * std::numbers::phi;
    const double shift = turns - std::floor(turns);
    shifts_.push_back(shift);
    for (int i = 0; i < params_.elevation_rays; ++i) {
      const double low_rad = fan_elevation_rad(i + shift - 0.5), high_rad = fan_elevation_rad(i + shift + 0.5);
      const double solid_angle_sr = width_rad * (std::sin(high_rad) - std::sin(low_rad));
      add_ray(look, {fan_offset_rad(column), solid_angle_sr, width_rad, high_rad - low_rad, 0, -1},
              fan_elevation_rad(i + shift));
    }
  }
}

void MarineRadar::aim_at_targets(const RadarLook& look) {
  const double width_rad = params_.radar.horizontal_rad;
  aimed_.assign(targets_.all().size(), 0);
  nearest_m_.assign(targets_.all().size(), 0);
  for (std::size_t i = 0; i < targets_.all().size(); ++i) {
    const RadarTarget& target = targets_.all()[i];
    if (target.land || !target.may_be_within(look, width_rad, params_.range_max_m)) continue;
    const auto outline = target.outline(look);
    aimed_[i] = !outline || outline->left_rad - outline->right_rad <= 2 * width_rad;
    if (!outline || !aimed_[i]) continue;
    nearest_m_[i] = outline->near_m;
    const int n = params_.target_rays;
    const double step_rad = (outline->left_rad - outline->right_rad) / n;
    const double height_rad = (outline->top_rad - outline->bottom_rad) / n;
    for (int column = 0; column < n; ++column)
      for (int row = 0; row < n; ++row) {
        const double elevation_rad = outline->bottom_rad + (row + 0.5) * height_rad;
        const double solid_angle_sr = step_rad * 2 * std::cos(elevation_rad) * std::sin(height_rad / 2);
        add_ray(look,
                {outline->right_rad + (column + 0.5) * step_rad, solid_angle_sr, step_rad, height_rad, 0,
                 static_cast<int>(i)},
                elevation_rad);
      }
  }
}

void MarineRadar::add_ray(const RadarLook& look, Sample sample, double elevation_rad) {
  const double c = std::cos(elevation_rad), heading_rad = look.heading_rad + sample.offset_rad;
  const sim::Vector3d direction_W(c * std::cos(heading_rad), c * std::sin(heading_rad), std::sin(elevation_rad));
  double range_max_m = params_.range_max_m;
  if (direction_W.z() < 0) range_max_m = std::min(range_max_m, std::max(look.height_m, 1e-3) / -direction_W.z());
  sample.gain = gain(look, sample.offset_rad, direction_W);
  samples_.push_back(sample);
  rays_.push_back({look.X_WS.translation(), direction_W, range_max_m});
}

double MarineRadar::gain(const RadarLook& look, double offset_rad, const sim::Vector3d& direction_W) const {
  const double elevation_rad = std::asin(std::clamp(look.X_WS.linear().col(2).dot(direction_W), -1.0, 1.0));
  const double one_way = beam_response(offset_rad, params_.radar.horizontal_rad) *
                         beam_response(elevation_rad, params_.radar.vertical_rad);
  return one_way * one_way;
}

double MarineRadar::cross_section_m2(const RadarLook& look, std::size_t ray) const {
  const sim::RayHit& hit = hits_[ray];
  const Sample& sample = samples_[ray];
  if (!hit.hit() || hit.range_m < params_.range_min_m) return 0;
  const double height_m = look.height_m + hit.range_m * rays_[ray].direction_W.z();
  if (height_m < height_below_horizon_m(hit.range_m, look.height_m)) return 0;
  const int number = target_at(ray);
  const bool aimed = number >= 0 && aimed_[static_cast<std::size_t>(number)];
  if (sample.target >= 0 ? number != sample.target : aimed) return 0;
  const RadarTarget* const target = number >= 0 ? &targets_.all()[static_cast<std::size_t>(number)] : nullptr;
  if (aimed && target->rcs_m2) return shares_m2_[static_cast<std::size_t>(number)];
  const double factor = target != nullptr && target->land ? land_factor_ : target_factor_;
  return sample.solid_angle_sr * hit.range_m * hit.range_m * factor;
}

/// Returns the target that a ray hits; -1: none.
int MarineRadar::target_at(std::size_t ray) const {
  const int part = hits_[ray].part;
  return part < 0 ? -1 : targets_.of_group(world_.physics().parts()[static_cast<std::size_t>(part)].group);
}

/// Divides given cross sections among the rays that hit the target or what hides it.
void MarineRadar::share_cross_sections() {
  shares_m2_.assign(targets_.all().size(), 0);
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const int number = samples_[i].target;
    if (number < 0) continue;
    const auto target = static_cast<std::size_t>(number);
    if (target_at(i) == number || hits_[i].range_m < nearest_m_[target]) ++shares_m2_[target];
  }
  for (std::size_t i = 0; i < shares_m2_.size(); ++i)
    if (const auto& rcs_m2 = targets_.all()[i].rcs_m2) shares_m2_[i] = *rcs_m2 / std::max(shares_m2_[i], 1.0);
}

void MarineRadar::add_echoes(const RadarLook& look) {
  share_cross_sections();
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const double area_m2 = cross_section_m2(look, i);
    if (area_m2 == 0) continue;
    const sim::RayHit& hit = hits_[i];
    const sim::Vector3d& direction_W = rays_[i].direction_W;
    // The extent in range of the surface in the solid angle of the ray; not more than at 3 degrees.
    const sim::Vector3d left_W = sim::Vector3d(-direction_W.y(), direction_W.x(), 0);
    const sim::Vector3d up_W = direction_W.cross(left_W).normalized();
    const double cosine = std::max(std::abs(hit.normal_W.dot(direction_W)), 0.05);
    const double slope = std::abs(hit.normal_W.dot(left_W)) * samples_[i].width_rad +
                         std::abs(hit.normal_W.dot(up_W)) * samples_[i].height_rad;
    add_echo(hit.range_m, echo_mWm2_ * samples_[i].gain * area_m2 / std::pow(hit.range_m, 4),
             hit.range_m * slope / cosine);
  }
}

/// Adds an echo to the last spoke.  One that is shorter than the resolution has its power in each cell inside of it.
void MarineRadar::add_echo(double range_m, double power_mW, double extent_m) {
  const double length_m = std::max(extent_m, resolution_m_), cell_m = params_.cell_m();
  const double from = (range_m - length_m / 2) / cell_m, to = (range_m + length_m / 2) / cell_m;
  const int first = static_cast<int>(std::max(std::floor(from), 0.0));
  const int last = static_cast<int>(std::min(std::floor(to), params_.range_cells - 1.0));
  float* const row = echo_mW_.data() + echo_mW_.size() - static_cast<std::size_t>(params_.range_cells);
  for (int cell = first; cell <= last; ++cell) {
    const double share = std::min<double>(cell + 1, to) - std::max<double>(cell, from);
    row[cell] += static_cast<float>(power_mW * resolution_m_ / length_m * share);
  }
}

/// Adds the mean echo of the sea to the last spoke, where nothing hides it.
void MarineRadar::add_clutter(const RadarLook& look) {
  const auto cells = static_cast<std::size_t>(params_.range_cells);
  float* const row = clutter_mW_.data() + clutter_mW_.size() - cells;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double range_m = cell_range_m(cell);
    const double grazing_rad = sea_grazing_rad(range_m, look.height_m);
    if (blind(cell) || range_m <= look.height_m || grazing_rad <= 0) continue;
    const double down_rad = -std::asin(look.height_m / range_m);
    const double area_m2 = range_m * open_width_rad(range_m, down_rad) * resolution_m_ / std::cos(down_rad);
    if (area_m2 == 0) continue;
    const sim::Vector3d direction_W = std::cos(down_rad) * look.ahead_W() + std::sin(down_rad) * sim::Vector3d::UnitZ();
    const double reflectivity =
        sea_reflectivity(grazing_rad, params_.radar.frequency_GHz, sea_state_, params_.radar.polarization);
    row[cell] =
        static_cast<float>(echo_mWm2_ * gain(look, 0, direction_W) * reflectivity * area_m2 / std::pow(range_m, 4));
  }
}

double MarineRadar::open_width_rad(double range_m, double down_rad) const {
  // The inverse of fan_elevation_rad() finds the ray of each column that goes there.
  const double u = std::asinh(down_rad / params_.radar.vertical_rad * sinh_of_density) / fan_density;
  double width_rad = 0;
  for (std::size_t column = 0; column < shifts_.size(); ++column) {
    const double place = std::floor((u + 1) / 2 * params_.elevation_rays - shifts_[column] + 0.5);
    if (place >= 0 && place < params_.elevation_rays) {
      const std::size_t ray =
          column * static_cast<std::size_t>(params_.elevation_rays) + static_cast<std::size_t>(place);
      if (hits_[ray].range_m < range_m) continue;
    }
    width_rad += column_widths_rad_[column];
  }
  return width_rad;
}

// The spokes were measured in sweep().
void MarineRadar::measure(const sim::SenseContext& context) {
  sampled_at_ = context.now;
  reported_ = true;
  digest_.renew();
  levels_dBm_.resize(echo_mW_.size());
  for (std::size_t i = 0; i < levels_dBm_.size(); ++i) {
    const double power_mW = double{echo_mW_[i]} + clutter_mW_[i];
    levels_dBm_[i] = power_mW > 0 && !blind(i) ? 10 * std::log10(power_mW) : silence_dBm;
  }
  quantize();
}

void MarineRadar::disturb(double dt_s, sim::Random& random) {
  const double noise_mW = params_.radar.noise_mW();
  for (std::size_t i = 0; i < levels_dBm_.size(); ++i) {
    double clutter_mW = clutter_mW_[i];
    if (params_.clutter_shape && clutter_mW > 0) clutter_mW *= clutter_texture(*params_.clutter_shape, random);
    levels_dBm_[i] = blind(i) ? silence_dBm : 10 * std::log10(detected_mW(echo_mW_[i], clutter_mW + noise_mW, random));
  }
  level_noise_.apply(std::span<double>(levels_dBm_), dt_s, random);
  quantize();
}

void MarineRadar::quantize() {
  pixels_.resize(levels_dBm_.size());
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const double count = std::round((levels_dBm_[i] - params_.floor_dBm) / params_.dB_per_count());
    pixels_[i] = static_cast<std::uint8_t>(std::clamp(count, 0.0, 255.0));
  }
}

void MarineRadar::visit_state(sim::StateArchive& archive) {
  archive(level_noise_, reported_, swept_to_);
  // Reported spokes are published; a hash is sufficient.
  if (reported_) return digest_.visit(archive, pixels_);
  archive(spokes_, echo_mW_, clutter_mW_);
  if (!archive.restoring()) return;
  digest_.renew();
  const std::size_t values = spokes_.size() * static_cast<std::size_t>(params_.range_cells);
  const auto positive = [](float power_mW) { return power_mW >= 0; };
  bool possible = echo_mW_.size() == values && clutter_mW_.size() == values && swept_to_ >= sim::Time{0} &&
                  std::all_of(echo_mW_.begin(), echo_mW_.end(), positive) &&
                  std::all_of(clutter_mW_.begin(), clutter_mW_.end(), positive);
  for (const Spoke& spoke : spokes_) possible = possible && spoke.at >= sim::Time{0} && spoke.at <= swept_to_;
  if (!possible) archive.fail("impossible spokes of a radar");
}

bool fill(const MarineRadar& radar, shoal::radar_sector_t& message) {
  const MarineRadar::Params& params = radar.params();
  message.nspokes = static_cast<std::int32_t>(radar.spokes().size());
  message.ncells = params.range_cells;
  message.range_min_m = static_cast<float>(params.range_min_m);
  message.range_max_m = static_cast<float>(params.range_max_m);
  message.floor_dBm = static_cast<float>(params.floor_dBm);
  message.dB_per_count = static_cast<float>(params.dB_per_count());
  message.time_offsets_us.clear();
  message.azimuths_rad.clear();
  for (const MarineRadar::Spoke& spoke : radar.spokes()) {
    message.time_offsets_us.push_back(static_cast<std::int32_t>((spoke.at - radar.sampled_at()).count()));
    message.azimuths_rad.push_back(static_cast<float>(spoke.azimuth_rad));
  }
  message.size = static_cast<std::int32_t>(radar.pixels().size());
  message.data.assign(radar.pixels().begin(), radar.pixels().end());
  return message.nspokes > 0;
}

SHOAL_SENSOR("marine_radar", MarineRadar, shoal::radar_sector_t);

}  // namespace devices
