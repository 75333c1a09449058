// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "devices/ranging/sonar_bins.hpp"

namespace devices {

/// Side-scan sonar: one line of echo levels over slant range to each side, across the track.  Its two fan beams lie in
/// the yz-plane of the sensor frame S, narrow along +x, one to port (+y) and one to starboard, inclined downwards by
/// the depression angle.
class SideScan final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Side-scan sonar: echo levels over slant range, to port and starboard.";
  static constexpr double default_rate_hz = 5;
  static constexpr bool casts_rays = true;
  static constexpr bool reuses_message = true;
  struct Params {
    double along_rad = sim::degrees_to_radians(0.5);
    double vertical_rad = sim::degrees_to_radians(60);
    double depression_rad = sim::degrees_to_radians(40);
    int rays = 600;
    int along_rays = 1;
    SonarParams sonar;
    SonarImageParams image;
    Params();
    void read(sim::ParamReader& in);
  };

  SideScan(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  std::optional<sim::FieldOfView> field_of_view() const override;
  std::int64_t rays() const override { return static_cast<std::int64_t>(rays_S_.size()); }
  void visit_state(sim::StateArchive& archive) override;

  /// Returns the image with two beams: port and starboard.
  const SonarBins& image() const { return bins_; }
  const SonarParams& sonar() const { return params_.sonar; }

 private:
  void make_rays();

  Params params_;
  SonarReceiver receiver_;
  SonarBins bins_;
  std::vector<SonarRay> rays_S_;       ///< port, then starboard
  std::vector<sim::Vector3d> down_S_;  ///< tangent of each ray towards larger depression, times the angle it represents
};

}  // namespace devices
