// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/side_scan.hpp"

#include <algorithm>
#include <cmath>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/side_scan_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

SideScan::Params::Params() {
  sonar.tvg = SonarParams::Gain::log20;
  sonar.range_min_m = 0;
}

void SideScan::Params::read(sim::ParamReader& in) {
  in.read_deg("along_deg", along_rad, sim::above_to(0, 30), "width of the beams along the track, at -3 dB");
  in.read_deg("vertical_deg", vertical_rad, sim::above_to(0, 90), "height of the beams, at -3 dB");
  in.read_deg("depression_deg", depression_rad, sim::between(0, 90),
              "depression of the middle of the beams, below the xy-plane");
  in.read("rays", rays, sim::between(1, 20000), "rays over the height of each beam");
  in.read("along_rays", along_rays, sim::between(1, 20), "rays over the width of a beam");
  sonar.read(in);
  image.read(in, sonar);
}

SideScan::SideScan(const Params& params, const sim::DeviceContext& context)
    : receiver_(params.sonar, context), bins_(params.image, context) {
  change(params);
}

/// Returns the edges and the axis of both beams.
std::optional<sim::FieldOfView> SideScan::field_of_view() const {
  sim::FieldOfView view{sim::FieldOfView::Kind::beams, params_.sonar.range_max_m, params_.sonar.range_min_m};
  for (const double side : {1.0, -1.0})
    for (const double share : {-0.5, 0.0, 0.5}) {
      const double down_rad = params_.depression_rad + share * params_.vertical_rad;
      view.directions_S.emplace_back(0, side * std::cos(down_rad), -std::sin(down_rad));
    }
  return view;
}

void SideScan::change(const Params& params) {
  params_ = params;
  receiver_.change(params.sonar);
  bins_.change(params.image, params.sonar, 2);
  make_rays();
}

void SideScan::make_rays() {
  rays_S_.clear();
  down_S_.clear();
  // Rays cover twice the -3 dB height, where the two-way response is -24 dB, but at most straight down.
  const double lowest_rad = std::min(params_.depression_rad + params_.vertical_rad, std::numbers::pi / 2);
  const double highest_rad = params_.depression_rad - params_.vertical_rad;
  const int n = params_.rays, m = params_.along_rays;
  const double height_rad = (lowest_rad - highest_rad) / n, width_rad = params_.along_rad / m;
  for (const double side : {1.0, -1.0})
    for (int k = 0; k < m; ++k)
      for (int i = 0; i < n; ++i) {
        const double down_rad = highest_rad + (i + 0.5) * height_rad;
        const double along_rad = (k + 0.5 - 0.5 * m) * width_rad;
        const double ca = std::cos(along_rad), sa = std::sin(along_rad);
        const double cd = std::cos(down_rad), sd = std::sin(down_rad);
        const double response = beam_response(down_rad - params_.depression_rad, params_.vertical_rad) *
                                beam_response(along_rad, params_.along_rad);
        rays_S_.push_back({{sa, side * ca * cd, -ca * sd}, height_rad * width_rad, response * response});
        down_S_.push_back(height_rad * sim::Vector3d(0, -side * ca * sd, -ca * cd));
      }
}

void SideScan::measure(const sim::SenseContext& context) {
  receiver_.cast(context.world.scene(), context.X_WS, rays_S_);
  bins_.begin(receiver_);
  for (std::size_t i = 0; i < rays_S_.size(); ++i) {
    const SonarEcho echo = receiver_.echo(i, rays_S_[i]);
    if (echo.power_uPa2 > 0)
      bins_.add(echo, receiver_.range_slope(i, context.X_WS.linear() * down_S_[i]), i < rays_S_.size() / 2 ? 0 : 1);
  }
  bins_.finish(receiver_);
}

void SideScan::disturb(double dt_s, sim::Random& random) {
  bins_.disturb(dt_s, random);
}

void SideScan::visit_state(sim::StateArchive& archive) {
  archive(receiver_, bins_);
}

void fill(const SideScan& sonar, shoal::side_scan_t& message) {
  const SonarBins& image = sonar.image();
  message.range_min_m = static_cast<float>(sonar.sonar().range_min_m);
  message.range_max_m = static_cast<float>(sonar.sonar().range_max_m);
  message.floor_dB = static_cast<float>(image.params().floor_dB);
  message.dB_per_count = static_cast<float>(image.params().dB_per_count());
  message.nbins = image.bins();
  message.port.resize(static_cast<std::size_t>(image.bins()));
  message.starboard.resize(message.port.size());
  for (std::size_t bin = 0; bin < message.port.size(); ++bin) {
    message.port[bin] = image.pixels()[2 * bin];
    message.starboard[bin] = image.pixels()[2 * bin + 1];
  }
}

SHOAL_SENSOR("side_scan", SideScan, shoal::side_scan_t);

}  // namespace devices
