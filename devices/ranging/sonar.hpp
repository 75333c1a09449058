// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "devices/ranging/sonar_return.hpp"
#include "sim/random/noise.hpp"

namespace devices {

/// Single-beam sonar: range of the first echo in a cone about an axis of the sensor frame S.
class RangeSonar : public sim::Sensor {
 public:
  static constexpr double default_rate_hz = 10;
  static constexpr bool casts_rays = true;
  struct Params {
    SonarParams sonar;
    SonarDetectionParams detection;
    double beam_rad = sim::degrees_to_radians(20);
    int rays = 64;
    double resolution_m = 0.01;
    sim::NoiseParams noise;           ///< error of the range, m
    sim::NoiseParams strength_noise;  ///< error of the strength, dB
    void read(sim::ParamReader& in);
  };

  RangeSonar(const Params& params, const sim::DeviceContext& context, const sim::Vector3d& axis_S);
  void change(const Params& params);
  auto noises() { return std::tie(noise_, strength_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  std::optional<sim::FieldOfView> field_of_view() const override {
    sim::FieldOfView view{sim::FieldOfView::Kind::cone, params_.sonar.range_max_m, params_.sonar.range_min_m};
    view.half_angle_rad = params_.beam_rad / 2;
    view.axis_S = axis_S_;
    return view;
  }
  std::int64_t rays() const override { return static_cast<std::int64_t>(rays_S_.size()); }
  void visit_state(sim::StateArchive& archive) override;

  double range_m() const { return range_m_; }
  double strength_dB() const { return strength_dB_; }
  bool valid() const { return valid_; }

 private:
  void miss();

  Params params_;
  sim::Vector3d axis_S_;
  SonarReceiver receiver_;
  sim::NoiseOf<&Params::noise> noise_;
  sim::NoiseOf<&Params::strength_noise> strength_noise_;
  std::vector<SonarRay> rays_S_;
  std::vector<SonarEcho> echoes_;
  double range_m_ = 0;
  double strength_dB_ = 0;
  bool valid_ = false;
};

/// Single-beam sonar along +x of S.
class Sonar final : public RangeSonar {
 public:
  static constexpr const char* meaning = "Single-beam sonar: range and strength of the first echo in a cone.";
  Sonar(const Params& params, const sim::DeviceContext& context)
      : RangeSonar(params, context, sim::Vector3d::UnitX()) {}
};

/// Altimeter: single-beam sonar along -z of S, downwards when mounted upright.
class Altimeter final : public RangeSonar {
 public:
  static constexpr const char* meaning = "Single-beam sonar that looks down: height above the ground.";
  Altimeter(const Params& params, const sim::DeviceContext& context)
      : RangeSonar(params, context, -sim::Vector3d::UnitZ()) {}
  std::string_view lacks() const override { return valid() ? "" : "echo of the bottom"; }
};

}  // namespace devices
