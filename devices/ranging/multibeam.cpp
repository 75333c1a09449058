// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/multibeam.hpp"

#include <algorithm>
#include <cmath>

#include "devices/ranging/ray_casting.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/multibeam_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

void Multibeam::Params::read(sim::ParamReader& in) {
  in.read("beams", beams, sim::between(1, 2048), "beams per ping");
  in.read_deg("swath_deg", swath_rad, sim::between(0, 180), "angle between the outermost beams");
  in.read_deg("across_deg", across_rad, sim::above_to(0, 30), "width of a beam across the track, at -3 dB");
  in.read_deg("along_deg", along_rad, sim::above_to(0, 30), "width of a beam along the track, at -3 dB");
  in.read("across_rays", across_rays, sim::between(1, 50), "rays over the width of a beam across the track");
  in.read("along_rays", along_rays, sim::between(1, 50), "rays over the width of a beam along the track");
  in.read("gate", gate, sim::between(0, 1), "echoes of a beam within this share of the range are one bottom");
  sonar.read(in);
  detection.read(in);
  in.read("resolution_m", resolution_m, sim::at_least(0), "ranges are rounded to multiples of this; 0: not");
  in.read("noise", noise, "error of each range, m");
  in.read("strength_noise", strength_noise, "error of each strength, dB");
  if (in.describing()) return;
  const RayFactor factors[] = {
      {"beams", double(beams)}, {"across_rays", double(across_rays)}, {"along_rays", double(along_rays)}};
  check_rays(in, factors);
}

Multibeam::Multibeam(const Params& params, const sim::DeviceContext& context)
    : receiver_(params.sonar, context), noise_(context, params), strength_noise_(context, params) {
  change(params);
}

/// Returns the edges of the swath and a few beams between them.
std::optional<sim::FieldOfView> Multibeam::field_of_view() const {
  constexpr int shown = 9;
  sim::FieldOfView view{sim::FieldOfView::Kind::beams, params_.sonar.range_max_m, params_.sonar.range_min_m};
  for (int i = 0; i < shown; ++i) {
    const double angle_rad = params_.swath_rad * (static_cast<double>(i) / (shown - 1) - 0.5);
    view.directions_S.emplace_back(0, std::sin(angle_rad), -std::cos(angle_rad));
  }
  return view;
}

void Multibeam::change(const Params& params) {
  params_ = params;
  receiver_.change(params.sonar);
  const auto beams = static_cast<std::size_t>(params.beams);
  ranges_m_.assign(beams, params.sonar.range_max_m);
  true_ranges_m_ = ranges_m_;
  strengths_dB_.assign(beams, 0);
  valid_.assign(beams, 0);
  digest_.renew();
  make_rays();
}

void Multibeam::make_rays() {
  angles_rad_.clear();
  rays_S_.clear();
  // Rays of each beam over its -3 dB widths, with the two-way beam pattern.
  const double step_rad = params_.beams > 1 ? params_.swath_rad / (params_.beams - 1) : 0;
  const double first_rad = params_.beams > 1 ? -params_.swath_rad / 2 : 0;
  const int n = params_.across_rays, m = params_.along_rays;
  for (int beam = 0; beam < params_.beams; ++beam) {
    angles_rad_.push_back(first_rad + beam * step_rad);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < m; ++k) {
        const double across_rad = params_.across_rad * ((i + 0.5) / n - 0.5);
        const double along_rad = params_.along_rad * ((k + 0.5) / m - 0.5);
        const double angle_rad = angles_rad_.back() + across_rad;
        const double response =
            beam_response(across_rad, params_.across_rad) * beam_response(along_rad, params_.along_rad);
        rays_S_.push_back({{std::sin(along_rad), std::cos(along_rad) * std::sin(angle_rad),
                            -std::cos(along_rad) * std::cos(angle_rad)},
                           params_.across_rad / n * params_.along_rad / m,
                           response * response});
      }
  }
}

void Multibeam::measure(const sim::SenseContext& context) {
  digest_.renew();
  receiver_.cast(context.world.scene(), context.X_WS, rays_S_);
  for (std::size_t beam = 0; beam < ranges_m_.size(); ++beam) detect(beam);
  true_ranges_m_ = ranges_m_;
}

// Finds the range window with the highest echo power and reports its power-weighted mean range: amplitude detection by
// weighted mean time (de Moustier, Oceans 1993).
void Multibeam::detect(std::size_t beam) {
  // Echoes of the beam, sorted by range.
  ranges_m_[beam] = params_.sonar.range_max_m;
  strengths_dB_[beam] = 0;
  valid_[beam] = 0;
  echoes_.clear();
  const auto rays = static_cast<std::size_t>(params_.across_rays * params_.along_rays);
  for (std::size_t i = beam * rays; i < (beam + 1) * rays; ++i) {
    const SonarEcho echo = receiver_.echo(i, rays_S_[i]);
    if (echo.power_uPa2 > 0) echoes_.push_back(echo);
  }
  std::sort(echoes_.begin(), echoes_.end(),
            [](const SonarEcho& a, const SonarEcho& b) { return a.range_m < b.range_m; });
  const auto end_of = [&](double from_m) {
    return std::max(from_m * (1 + params_.gate), from_m + receiver_.pulse_m());
  };
  // Slide the window over the echoes; both ends increase monotonically.
  std::size_t loudest_from = 0, loudest_to = 0;
  double max_uPa2 = 0, stretch_uPa2 = 0;
  for (std::size_t from = 0, to = 0; from < echoes_.size(); ++from) {
    const double end_m = end_of(echoes_[from].range_m);
    for (; to < echoes_.size() && echoes_[to].range_m <= end_m; ++to) stretch_uPa2 += echoes_[to].power_uPa2;
    if (stretch_uPa2 > max_uPa2) max_uPa2 = stretch_uPa2, loudest_from = from, loudest_to = to;
    stretch_uPa2 -= echoes_[from].power_uPa2;
  }
  if (echoes_.empty()) return;
  // Power and weighted mean range in the window.
  double loudest_uPa2 = 0, moment = 0;
  for (std::size_t i = loudest_from; i < loudest_to; ++i) {
    loudest_uPa2 += echoes_[i].power_uPa2;
    moment += echoes_[i].power_uPa2 * echoes_[i].range_m;
  }
  const double range_m = moment / loudest_uPa2;
  const double level_dB = 10 * std::log10(loudest_uPa2);
  // Apply the detection threshold.
  if (level_dB < params_.detection.threshold_dB) return;
  ranges_m_[beam] = range_m;
  strengths_dB_[beam] = level_dB + receiver_.gain_dB(range_m);
  valid_[beam] = 1;
}

void Multibeam::disturb(double dt_s, sim::Random& random) {
  // Errors of strengths and ranges.
  if (params_.sonar.speckle)
    for (double& strength_dB : strengths_dB_) strength_dB += 10 * std::log10(speckle_power(random));
  strength_noise_.apply(std::span<double>(strengths_dB_), dt_s, random);
  for (double& range_m : ranges_m_) range_m *= receiver_.range_scale();
  noise_.apply(std::span<double>(ranges_m_), dt_s, random);
  // Detection with errors, quantization and limits.
  for (std::size_t i = 0; i < ranges_m_.size(); ++i) {
    const double level_dB = strengths_dB_[i] - receiver_.gain_dB(true_ranges_m_[i]);
    valid_[i] = valid_[i] && level_dB >= params_.detection.threshold_dB;
    if (params_.resolution_m > 0) ranges_m_[i] = std::round(ranges_m_[i] / params_.resolution_m) * params_.resolution_m;
    ranges_m_[i] = valid_[i] ? std::clamp(ranges_m_[i], params_.sonar.range_min_m, params_.sonar.range_max_m)
                             : params_.sonar.range_max_m;
    if (!valid_[i]) strengths_dB_[i] = 0;
  }
}

void Multibeam::visit_state(sim::StateArchive& archive) {
  digest_.visit(archive, ranges_m_, strengths_dB_, valid_);
  archive(receiver_, noise_, strength_noise_);
}

void fill(const Multibeam& multibeam, shoal::multibeam_t& message) {
  const auto floats = [](const std::vector<double>& from, std::vector<float>& to) {
    to.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) to[i] = static_cast<float>(from[i]);
  };
  message.count = static_cast<std::int32_t>(multibeam.ranges_m().size());
  floats(multibeam.angles_rad(), message.angles_rad);
  floats(multibeam.ranges_m(), message.ranges_m);
  floats(multibeam.strengths_dB(), message.strengths_dB);
  message.valid.assign(multibeam.valid().begin(), multibeam.valid().end());
}

SHOAL_SENSOR("multibeam", Multibeam, shoal::multibeam_t);

}  // namespace devices
