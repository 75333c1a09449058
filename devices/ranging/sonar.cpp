// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/sonar.hpp"

#include <algorithm>
#include <cmath>

#include "devices/ranging/ray_casting.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/sonar_range_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

void RangeSonar::Params::read(sim::ParamReader& in) {
  in.read_deg("beam_deg", beam_rad, sim::above_to(0, 180), "width of the cone, between its -3 dB points");
  in.read("rays", rays, sim::between(1, 10000), "rays that fill the cone");
  sonar.read(in);
  detection.read(in);
  in.read("resolution_m", resolution_m, sim::at_least(0), "ranges are rounded to multiples of this; 0: not");
  in.read("noise", noise, "error of the range, m");
  in.read("strength_noise", strength_noise, "error of the strength, dB");
}

RangeSonar::RangeSonar(const Params& params, const sim::DeviceContext& context, const sim::Vector3d& axis_S)
    : axis_S_(axis_S), receiver_(params.sonar, context), noise_(context, params), strength_noise_(context, params) {
  change(params);
}

void RangeSonar::change(const Params& params) {
  params_ = params;
  receiver_.change(params.sonar);
  // Rays over the cone, weighted by the two-way beam pattern.
  const sim::Quaterniond R_SA = sim::rotation_between(sim::Vector3d::UnitX(), axis_S_);
  const double share_sr = cone_solid_angle_sr(params.beam_rad / 2) / params.rays;
  rays_S_.clear();
  for (const sim::Vector3d& d : cone_pattern(params.beam_rad / 2, params.rays)) {
    const double response = beam_response(std::acos(std::min(d.x(), 1.0)), params.beam_rad);
    rays_S_.push_back({R_SA * d, share_sr, response * response});
  }
  miss();
}

void RangeSonar::miss() {
  range_m_ = params_.sonar.range_max_m;
  strength_dB_ = 0;
  valid_ = false;
}

void RangeSonar::measure(const sim::SenseContext& context) {
  miss();
  receiver_.cast(context.world.scene(), context.X_WS, rays_S_);
  // Echoes sorted by range.
  echoes_.clear();
  for (std::size_t i = 0; i < rays_S_.size(); ++i) {
    const SonarEcho echo = receiver_.echo(i, rays_S_[i]);
    if (echo.power_uPa2 > 0) echoes_.push_back(echo);
  }
  std::sort(echoes_.begin(), echoes_.end(),
            [](const SonarEcho& a, const SonarEcho& b) { return a.range_m < b.range_m; });
  // Find the first echo above the threshold, summed over the length of the pulse.
  const double threshold_uPa2 = std::pow(10, params_.detection.threshold_dB / 10);
  for (std::size_t from = 0; from < echoes_.size() && !valid_; ++from) {
    double power_uPa2 = 0;
    for (std::size_t i = from; i < echoes_.size(); ++i) {
      if (echoes_[i].range_m > echoes_[from].range_m + receiver_.pulse_m()) break;
      power_uPa2 += echoes_[i].power_uPa2;
    }
    if (power_uPa2 < threshold_uPa2) continue;
    valid_ = true;
    range_m_ = echoes_[from].range_m;
    strength_dB_ = 10 * std::log10(power_uPa2) + receiver_.gain_dB(range_m_);
  }
}

void RangeSonar::disturb(double dt_s, sim::Random& random) {
  const double truth_m = range_m_;
  if (valid_) range_m_ *= receiver_.range_scale();
  if (params_.sonar.speckle) strength_dB_ += 10 * std::log10(speckle_power(random));
  strength_noise_.apply(strength_dB_, dt_s, random);
  noise_.apply(range_m_, dt_s, random);
  if (params_.resolution_m > 0) range_m_ = std::round(range_m_ / params_.resolution_m) * params_.resolution_m;
  range_m_ = std::clamp(range_m_, params_.sonar.range_min_m, params_.sonar.range_max_m);
  if (!valid_ || strength_dB_ - receiver_.gain_dB(truth_m) < params_.detection.threshold_dB) miss();
}

void RangeSonar::visit_state(sim::StateArchive& archive) {
  archive(range_m_, strength_dB_, valid_, receiver_, noise_, strength_noise_);
}

void fill(const RangeSonar& sonar, shoal::sonar_range_t& message) {
  message.range_m = sonar.range_m();
  message.strength_dB = sonar.strength_dB();
  message.valid = sonar.valid();
}

SHOAL_SENSOR("sonar", Sonar, shoal::sonar_range_t);
SHOAL_SENSOR("altimeter", Altimeter, shoal::sonar_range_t);

}  // namespace devices
