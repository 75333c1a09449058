// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/imaging_sonar.hpp"

#include <cmath>

#include "devices/ranging/ray_casting.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/sonar_image_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

void ImagingSonar::Params::read(sim::ParamReader& in) {
  in.read("beams", beams, sim::between(1, 4096), "number of columns of the image");
  in.read_deg("fov_deg", fov_rad, sim::above_to(0, 360), "bearings from the first beam to the last");
  in.read_deg("vertical_deg", vertical_rad, sim::above_to(0, 90), "vertical beamwidth at -3 dB");
  in.read("elevation_rays", elevation_rays, sim::between(1, 2000), "rays over the vertical beamwidth");
  in.read("beam_rays", beam_rays, sim::between(1, 20), "rays over the width of a beam");
  sonar.read(in);
  image.read(in, sonar);
  if (in.describing()) return;
  const double pixels = static_cast<double>(beams) * image.bins;
  if (pixels > 4e6)
    in.error("bins", "an image must have at most 4000000 values, got " + std::to_string(static_cast<int>(pixels)));
  const RayFactor factors[] = {
      {"beams", double(beams)}, {"elevation_rays", double(elevation_rays)}, {"beam_rays", double(beam_rays)}};
  check_rays(in, factors);
}

ImagingSonar::ImagingSonar(const Params& params, const sim::DeviceContext& context)
    : receiver_(params.sonar, context), bins_(params.image, context) {
  change(params);
}

void ImagingSonar::change(const Params& params) {
  params_ = params;
  receiver_.change(params.sonar);
  bins_.change(params.image, params.sonar, params.beams);
  make_rays();
}

void ImagingSonar::make_rays() {
  rays_S_.clear();
  up_S_.clear();
  left_S_.clear();
  const int n = params_.elevation_rays, m = params_.beam_rays;
  // Rays cover twice the -3 dB height; the two-way response is -24 dB at its ends.
  const double height_rad = 2 * params_.vertical_rad / n, width_rad = beam_width_rad() / m;
  for (int beam = 0; beam < params_.beams; ++beam)
    for (int k = 0; k < m; ++k)
      for (int i = 0; i < n; ++i) {
        const double elevation_rad = (i + 0.5 - 0.5 * n) * height_rad;
        const double bearing_rad = first_bearing_rad() + beam * bearing_step_rad() + (k + 0.5 - 0.5 * m) * width_rad;
        const double ce = std::cos(elevation_rad), se = std::sin(elevation_rad);
        const double cb = std::cos(bearing_rad), sb = std::sin(bearing_rad);
        const double response = beam_response(elevation_rad, params_.vertical_rad);
        rays_S_.push_back({{ce * cb, ce * sb, se}, height_rad * width_rad * ce, response * response});
        up_S_.push_back(height_rad * sim::Vector3d(-se * cb, -se * sb, ce));
        left_S_.push_back(width_rad * sim::Vector3d(-ce * sb, ce * cb, 0));
      }
}

void ImagingSonar::measure(const sim::SenseContext& context) {
  receiver_.cast(context.world.scene(), context.X_WS, rays_S_);
  bins_.begin(receiver_);
  // Distribute the echoes over range, by the extent of each ray's footprint in elevation and bearing.
  const auto rays = static_cast<std::size_t>(params_.elevation_rays * params_.beam_rays);
  for (std::size_t i = 0; i < rays_S_.size(); ++i) {
    const SonarEcho echo = receiver_.echo(i, rays_S_[i]);
    if (!(echo.power_uPa2 > 0)) continue;
    const double extent_m = receiver_.range_slope(i, context.X_WS.linear() * up_S_[i]) +
                            receiver_.range_slope(i, context.X_WS.linear() * left_S_[i]);
    bins_.add(echo, extent_m, static_cast<int>(i / rays));
  }
  bins_.finish(receiver_);
}

void ImagingSonar::disturb(double dt_s, sim::Random& random) {
  bins_.disturb(dt_s, random);
}

void fill(const ImagingSonar& sonar, shoal::sonar_image_t& message) {
  const SonarBins& image = sonar.image();
  message.nbins = image.bins();
  message.nbeams = image.beams();
  message.range_min_m = static_cast<float>(sonar.sonar().range_min_m);
  message.range_max_m = static_cast<float>(sonar.sonar().range_max_m);
  message.rad0 = static_cast<float>(sonar.first_bearing_rad());
  message.radstep = static_cast<float>(sonar.bearing_step_rad());
  message.floor_dB = static_cast<float>(image.params().floor_dB);
  message.dB_per_count = static_cast<float>(image.params().dB_per_count());
  message.size = static_cast<std::int32_t>(image.pixels().size());
  message.data.assign(image.pixels().begin(), image.pixels().end());
}

SHOAL_SENSOR("imaging_sonar", ImagingSonar, shoal::sonar_image_t);

}  // namespace devices
