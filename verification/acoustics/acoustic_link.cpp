// SPDX-License-Identifier: BSD-3-Clause
#include "verification/acoustics/acoustic_link.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>
#include <utility>

#include "devices/comms/micromodem_rates.hpp"
#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/acoustics/propagation/multipath.hpp"
#include "sim/acoustics/propagation/propagation.hpp"
#include "sim/acoustics/propagation/sound_path.hpp"
#include "sim/acoustics/rays/ray_tables.hpp"
#include "sim/random/random.hpp"

namespace verification {

namespace {

using sim::Decibels;
using sim::Modulation;
using sim::PowerRatio;

constexpr int draws = 2000;  ///< number of fades and phases for a mean

std::string packet_name(Modulation modulation, double bit_rate_bps, std::int64_t bytes) {
  return fmt::format("{}_{:g}_{}", sim::to_string(modulation), bit_rate_bps, bytes);
}

/// Water along the path, for the echoes.
sim::MultipathMedium water_of(const AcousticLink& link, const LinkBudget& budget,
                              const sim::AcousticsConfig& acoustics) {
  sim::MultipathMedium water;
  water.frequency_Hz = link.centre_Hz;
  if (budget.travel_time_s > 0) water.sound_speed_mps = budget.range_m / budget.travel_time_s;
  water.absorption_dBpkm = budget.absorption_dBpkm;
  water.wind_mps = budget.wind_mps;
  water.spreading = acoustics.spreading;
  return water;
}

/// Sum of rays relative to the first one; `random` as for sim::echoes().
sim::Echoes echoes_of_rays(std::vector<sim::PathGain> gains, const sim::MultipathConfig& multipath,
                           sim::Random* random) {
  const bool drawn = multipath.phases == sim::MultipathConfig::Phases::random;
  if (drawn && random != nullptr) sim::randomize_phases(gains, *random);
  const sim::MultipathSum sum = sim::combine(gains, multipath.window_s);
  sim::Echoes echoes{sum.signal, sum.interference, sum.spread_s, 0};
  if (drawn && random == nullptr) {
    echoes.signal = PowerRatio{};
    for (const sim::PathGain& gain : gains)
      if (gain.delay_s - sum.first_s <= multipath.window_s) echoes.signal += sim::to_power(gain.gain);
  }
  return echoes;
}

/// Effect of the echoes on the direct path; `random` as for sim::echoes().
sim::Echoes echoes_of(const AcousticLink& link, const LinkBudget& budget, const sim::AcousticsConfig& acoustics,
                      const sim::Medium& medium, std::optional<double> water_depth_m, sim::Random* random) {
  if (budget.bent) return echoes_of_rays(budget.ray_gains, *acoustics.multipath, random);
  const sim::MultipathMedium water = water_of(link, budget, acoustics);
  const sim::LinkDepths depths{medium.depth_m(link.from.p_W), medium.depth_m(link.to.p_W),
                               (link.to.p_W - link.from.p_W).head<2>().norm(),
                               acoustics.multipath->water_depth_m.value_or(water_depth_m.value_or(HUGE_VAL))};
  return sim::echoes(*acoustics.multipath, water, depths, random);
}

/// Vector with this elevation in the vertical plane of a link.
sim::Vector3d ray_direction_W(const sim::Vector3d& displacement_W, double elevation_rad) {
  const sim::Vector3d level_W(displacement_W.x(), displacement_W.y(), 0);
  const double level_m = level_W.norm();
  const sim::Vector3d along_W = level_m > 0 ? sim::Vector3d(level_W / level_m) : sim::Vector3d(sim::Vector3d::UnitX());
  return along_W * std::cos(elevation_rad) + sim::Vector3d::UnitZ() * std::sin(elevation_rad);
}

/// Replaces travel time and level of the straight line by those of the rays.  Returns the directions at both ends.
std::pair<sim::Vector3d, sim::Vector3d> bend(LinkBudget& budget, const AcousticLink& link,
                                             const sim::AcousticsConfig& acoustics, const sim::Medium& medium,
                                             std::optional<double> water_depth_m) {
  const sim::Vector3d displacement_W = link.to.p_W - link.from.p_W;
  const double still_m = medium.still_surface_m();
  sim::RayQuery query;
  query.source_m = still_m - link.from.p_W.z();
  query.receiver_m = still_m - link.to.p_W.z();
  query.range_m = displacement_W.head<2>().norm();
  const double depth_m = acoustics.multipath && acoustics.multipath->water_depth_m ? *acoustics.multipath->water_depth_m
                                                                                   : water_depth_m.value_or(HUGE_VAL);
  query.water_m = std::max({depth_m, query.source_m, query.receiver_m, 0.0});
  query.max_bounces = acoustics.multipath ? acoustics.multipath->max_bounces : 0;
  sim::RayTables tables([&](double z_m) { return medium.sound_speed_at_depth_mps(z_m); }, medium.profile_depths_m());
  std::vector<sim::SoundRay> rays;
  tables.of(query.water_m).find(query, rays);
  budget.bent = true;
  budget.shadow = std::none_of(rays.begin(), rays.end(), [](const auto& ray) { return ray.bounces() == 0; });
  budget.ray_gains =
      sim::ray_gains(rays, acoustics.multipath ? &*acoustics.multipath : nullptr, water_of(link, budget, acoustics));
  // The sound that leaks into the shadow, along the straight line.
  if (budget.shadow && acoustics.shadow_loss_dB) {
    sim::SoundRay leak;
    leak.travel_time_s = budget.travel_time_s;
    leak.launch_rad = leak.arrival_rad = std::atan2(displacement_W.z(), query.range_m);
    rays.push_back(leak);
    sim::PathGain gain;
    gain.delay_s = budget.travel_time_s;
    gain.gain = budget.spreading + budget.absorption - Decibels(*acoustics.shadow_loss_dB);
    budget.ray_gains.push_back(gain);
  }
  if (rays.empty()) {
    budget.spreading = sim::to_decibels(PowerRatio{});
    budget.ray_gains.emplace_back();
    return {displacement_W, displacement_W};
  }
  const std::size_t first = sim::first_path(budget.ray_gains);
  const Decibels of_first = budget.ray_gains[first].gain;
  budget.travel_time_s = rays[first].travel_time_s;
  budget.launch_rad = rays[first].launch_rad;
  budget.arrival_rad = rays[first].arrival_rad;
  const double window_s = acoustics.multipath ? acoustics.multipath->window_s : HUGE_VAL;
  for (sim::PathGain& gain : budget.ray_gains) {
    gain.gain -= of_first;
    // Sound of before the first arrival: of the signal, or interference, as in the channel.
    const double early_s = budget.travel_time_s - gain.delay_s;
    if (early_s > 0) gain.delay_s = budget.travel_time_s + (early_s <= window_s ? 0 : window_s + 1e-3);
  }
  budget.spreading = of_first - budget.absorption;
  return {ray_direction_W(displacement_W, budget.launch_rad), ray_direction_W(displacement_W, budget.arrival_rad)};
}

double success_at(const AcousticLink& link, const AcousticPacket& packet, PowerRatio ratio) {
  if (sim::to_decibels(ratio) < link.detection) return 0;
  return sim::packet_success_probability(packet.modulation,
                                         sim::energy_per_bit(ratio, link.bandwidth_Hz, packet.bit_rate_bps),
                                         8 * packet.bytes, link.coding_gain);
}

}  // namespace

std::optional<AcousticPacket> parse_packet(const std::string& text) {
  AcousticPacket packet;
  const std::size_t first = text.find(':'), second = text.find(':', first + 1);
  if (first == std::string::npos || second == std::string::npos) return std::nullopt;
  bool known = false;
  for (const Modulation each : {Modulation::fsk, Modulation::psk, Modulation::dpsk})
    if (text.substr(0, first) == sim::to_string(each)) {
      packet.modulation = each;
      known = true;
    }
  const char *rate = text.data() + first + 1, *bytes = text.data() + second + 1, *end = text.data() + text.size();
  const auto rate_read = std::from_chars(rate, bytes - 1, packet.bit_rate_bps);
  const auto bytes_read = std::from_chars(bytes, end, packet.bytes);
  const bool numbers = rate_read.ec == std::errc{} && rate_read.ptr == bytes - 1 && bytes_read.ec == std::errc{} &&
                       bytes_read.ptr == end;
  if (!known || !numbers || !(packet.bit_rate_bps > 0) || packet.bit_rate_bps > 1e9 || packet.bytes < 0 ||
      packet.bytes > 1'000'000'000)
    return std::nullopt;
  packet.name = packet_name(packet.modulation, packet.bit_rate_bps, packet.bytes);
  return packet;
}

std::vector<AcousticPacket> micromodem_packets() {
  std::vector<AcousticPacket> packets;
  for (const devices::MicromodemRate& rate : devices::micromodem_rates())
    packets.push_back({rate.modulation, rate.bit_rate_bps, rate.frame_bytes,
                       packet_name(rate.modulation, rate.bit_rate_bps, rate.frame_bytes), rate.bandwidth_Hz});
  return packets;
}

bool sound_bends(const sim::AcousticsConfig& acoustics, const sim::Medium& medium) {
  return medium.has_water() && sim::sound_paths(acoustics, medium.has_sound_profile()) == sim::SoundPaths::rays;
}

LinkBudget link_budget(const AcousticLink& link, const sim::AcousticsConfig& acoustics, const sim::Medium& medium,
                       std::optional<double> water_depth_m) {
  LinkBudget budget;
  const sim::Vector3d displacement_W = link.to.p_W - link.from.p_W;
  budget.range_m = displacement_W.norm();
  budget.travel_time_s = sim::travel_time_s(medium, link.from.p_W, link.to.p_W);
  budget.absorption_dBpkm =
      sim::absorption_dBpkm(acoustics.absorption, link.centre_Hz, medium, link.from.p_W, link.to.p_W);
  budget.spreading =
      -sim::spreading_loss(budget.range_m, sim::straight_spreading(acoustics, medium.has_sound_profile()));
  budget.absorption = -sim::absorption_loss(budget.range_m, budget.absorption_dBpkm);
  const sim::AmbientNoise noise = acoustics.noise.with_wind(medium.mean_wind_mps());
  budget.wind_mps = noise.wind_mps;
  // Refraction changes the angles at which the sound leaves and arrives, and with them the gains of both transducers.
  sim::Vector3d leaves_W = displacement_W, arrives_W = displacement_W;
  if (sound_bends(acoustics, medium))
    std::tie(leaves_W, arrives_W) = bend(budget, link, acoustics, medium, water_depth_m);
  const double c_mps = medium.sound_speed_mps(link.to.p_W);
  budget.from_gain =
      sim::directivity_gain(link.from.directivity, link.from.R_WS.transpose() * leaves_W, link.centre_Hz, c_mps);
  budget.to_gain =
      sim::directivity_gain(link.to.directivity, -(link.to.R_WS.transpose() * arrives_W), link.centre_Hz, c_mps);
  budget.level = link.source_level + budget.from_gain + budget.spreading + budget.absorption + budget.to_gain;
  budget.noise_per_Hz = noise.spectral_level(link.centre_Hz / 1000);
  budget.noise_reduction = sim::directivity_index(link.to.directivity, link.centre_Hz, c_mps);
  // A directional receiver receives less of a noise that comes from all sides: by its directivity index (Urick 1983,
  // chapter 3).
  budget.noise = noise.band_level(link.centre_Hz, link.bandwidth_Hz) - budget.noise_reduction;
  budget.snr = budget.level - budget.noise;
  if (acoustics.multipath) {
    const sim::Echoes echoes = echoes_of(link, budget, acoustics, medium, water_depth_m, nullptr);
    budget.echoes = sim::to_decibels(echoes.signal);
    budget.late = budget.level + sim::to_decibels(echoes.late);
    budget.delay_spread_s = echoes.spread_s;
  }
  return budget;
}

double delivery_probability(const AcousticLink& between, const AcousticPacket& packet,
                            const sim::AcousticsConfig& acoustics, const sim::Medium& medium,
                            std::optional<double> water_depth_m) {
  AcousticLink link = between;
  link.bandwidth_Hz = packet.bandwidth_Hz.value_or(link.bandwidth_Hz);
  const LinkBudget budget = link_budget(link, acoustics, medium, water_depth_m);
  const bool fades = acoustics.fading.type != sim::FadingConfig::Type::none;
  if (!fades && !acoustics.multipath) return success_at(link, packet, sim::to_power(budget.snr));
  sim::Random random(1, "delivery");
  double sum = 0;
  for (int i = 0; i < draws; ++i) {
    random.begin_step(i);
    sim::Echoes echoes;
    if (acoustics.multipath) echoes = echoes_of(link, budget, acoustics, medium, water_depth_m, &random);
    const PowerRatio faded = sim::to_power(sim::fade(acoustics.fading, random) + budget.level);
    sum += success_at(link, packet, faded * echoes.signal / (sim::to_power(budget.noise) + faded * echoes.late));
  }
  return sum / draws;
}

std::vector<RangeRow> over_range(const AcousticLink& link, const std::vector<AcousticPacket>& packets,
                                 const std::vector<double>& ranges_m, const sim::AcousticsConfig& acoustics,
                                 const sim::Medium& medium, std::optional<double> water_depth_m) {
  std::vector<RangeRow> rows;
  const sim::Vector3d displacement_W = link.to.p_W - link.from.p_W;
  sim::Vector3d side_W(displacement_W.x(), displacement_W.y(), 0);
  side_W = side_W.norm() > 0 ? sim::Vector3d(side_W.normalized()) : sim::Vector3d::UnitX();
  for (const double range_m : ranges_m) {
    const double level_m2 = range_m * range_m - displacement_W.z() * displacement_W.z();
    if (level_m2 < 0) continue;
    AcousticLink at = link;
    at.to.p_W = link.from.p_W + side_W * std::sqrt(level_m2) + sim::Vector3d(0, 0, displacement_W.z());
    RangeRow row{link_budget(at, acoustics, medium, water_depth_m), {}};
    for (const AcousticPacket& packet : packets)
      row.delivered.push_back(delivery_probability(at, packet, acoustics, medium, water_depth_m));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace verification
