// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "devices/ranging/sonar_bins.hpp"

namespace devices {

/// Forward-looking imaging sonar: echo level over range and bearing.  The beams cover bearings from -fov/2 to +fov/2
/// about +z of the sensor frame S, counter-clockwise from +x.  Elevation is not resolved.
class ImagingSonar final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Forward-looking sonar: an image of echo levels over range and bearing.";
  static constexpr double default_rate_hz = 5;
  static constexpr bool casts_rays = true;
  static constexpr bool reuses_message = true;
  struct Params {
    int beams = 128;
    double fov_rad = sim::degrees_to_radians(90);
    double vertical_rad = sim::degrees_to_radians(20);
    int elevation_rays = 48;
    int beam_rays = 1;
    SonarParams sonar;
    SonarImageParams image;
    Params() { sonar.tvg = SonarParams::Gain::log20; }
    void read(sim::ParamReader& in);
  };

  ImagingSonar(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  std::optional<sim::FieldOfView> field_of_view() const override {
    sim::FieldOfView view{sim::FieldOfView::Kind::fan, params_.sonar.range_max_m, params_.sonar.range_min_m};
    view.from_rad = -params_.fov_rad / 2;
    view.to_rad = params_.fov_rad / 2;
    return view;
  }
  std::int64_t rays() const override { return static_cast<std::int64_t>(rays_S_.size()); }
  void visit_state(sim::StateArchive& archive) override { archive(receiver_, bins_); }

  const SonarBins& image() const { return bins_; }
  const SonarParams& sonar() const { return params_.sonar; }
  double first_bearing_rad() const { return params_.beams > 1 ? -params_.fov_rad / 2 : 0; }
  double bearing_step_rad() const { return params_.beams > 1 ? params_.fov_rad / (params_.beams - 1) : 0; }

 private:
  double beam_width_rad() const { return params_.beams > 1 ? bearing_step_rad() : params_.fov_rad; }
  void make_rays();

  Params params_;
  SonarReceiver receiver_;
  SonarBins bins_;
  std::vector<SonarRay> rays_S_;  ///< beam by beam
  /// Tangents of each ray towards higher elevation and bearing, multiplied by the angles that the ray represents.
  std::vector<sim::Vector3d> up_S_, left_S_;
};

}  // namespace devices
