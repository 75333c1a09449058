// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/acoustics/acoustic_link.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "devices/comms/micromodem_rates.hpp"
#include "sim/acoustics/echoes.hpp"
#include "sim/acoustics/fading.hpp"
#include "sim/acoustics/sound_path.hpp"
#include "sim/random/random.hpp"

namespace tools {

namespace {

using sim::Decibels;
using sim::Modulation;
using sim::PowerRatio;

constexpr int draws = 2000;  ///< number of fades and phases for a mean

std::string packet_name(Modulation modulation, double bit_rate_bps, std::int64_t bytes) {
  return fmt::format("{}_{:g}_{}", sim::to_string(modulation), bit_rate_bps, bytes);
}

/// Effect of the echoes on the direct path; `random` as for sim::echoes().
sim::Echoes echoes_of(const AcousticLink& link, const LinkBudget& budget, const sim::AcousticsConfig& acoustics,
                      const sim::Medium& medium, std::optional<double> water_depth_m, sim::Random* random) {
  sim::MultipathMedium water;
  water.frequency_Hz = link.centre_Hz;
  if (budget.travel_time_s > 0) water.sound_speed_mps = budget.range_m / budget.travel_time_s;
  water.absorption_dBpkm = budget.absorption_dBpkm;
  water.wind_mps = budget.wind_mps;
  water.spreading = acoustics.spreading;
  const sim::LinkDepths depths{medium.depth_m(link.from.p_W), medium.depth_m(link.to.p_W),
                               (link.to.p_W - link.from.p_W).head<2>().norm(),
                               acoustics.multipath->water_depth_m.value_or(water_depth_m.value_or(HUGE_VAL))};
  return sim::echoes(*acoustics.multipath, water, depths, random);
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

LinkBudget link_budget(const AcousticLink& link, const sim::AcousticsConfig& acoustics, const sim::Medium& medium,
                       std::optional<double> water_depth_m) {
  LinkBudget budget;
  const sim::Vector3d displacement_W = link.to.p_W - link.from.p_W;
  budget.range_m = displacement_W.norm();
  budget.travel_time_s = sim::travel_time_s(medium, link.from.p_W, link.to.p_W);
  budget.absorption_dBpkm =
      sim::absorption_dBpkm(acoustics.absorption, link.centre_Hz, medium, link.from.p_W, link.to.p_W);
  const double c_mps = medium.sound_speed_mps(link.to.p_W);
  budget.from_gain =
      sim::directivity_gain(link.from.directivity, link.from.R_WS.transpose() * displacement_W, link.centre_Hz, c_mps);
  budget.to_gain =
      sim::directivity_gain(link.to.directivity, -(link.to.R_WS.transpose() * displacement_W), link.centre_Hz, c_mps);
  budget.spreading = -sim::spreading_loss(budget.range_m, acoustics.spreading);
  budget.absorption = -sim::absorption_loss(budget.range_m, budget.absorption_dBpkm);
  budget.level = link.source_level + budget.from_gain + budget.spreading + budget.absorption + budget.to_gain;
  const sim::AmbientNoise noise = acoustics.noise.with_wind(medium.mean_wind_mps());
  budget.wind_mps = noise.wind_mps;
  budget.noise_per_Hz = noise.spectral_level(link.centre_Hz / 1000);
  budget.noise_reduction = sim::directivity_index(link.to.directivity, link.centre_Hz, c_mps);
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

}  // namespace tools
