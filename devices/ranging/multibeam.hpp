// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "devices/common/reading_digest.hpp"
#include "devices/ranging/sonar_return.hpp"
#include "sim/random/noise.hpp"

namespace devices {

/// Multibeam sonar: a swath of beams in the yz-plane of the sensor frame S, centered on -z, from starboard (-y) to
/// port.
class Multibeam final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Multibeam sonar: ranges and strengths over a swath across the track.";
  static constexpr double default_rate_hz = 5;
  static constexpr bool casts_rays = true;
  static constexpr bool reuses_message = true;
  struct Params {
    int beams = 128;
    double swath_rad = sim::degrees_to_radians(120);
    double across_rad = sim::degrees_to_radians(1);
    double along_rad = sim::degrees_to_radians(1);
    int across_rays = 5;
    int along_rays = 3;
    double gate = 0.1;
    SonarParams sonar;
    SonarDetectionParams detection;
    double resolution_m = 0.01;
    sim::NoiseParams noise;           ///< error of each range, m
    sim::NoiseParams strength_noise;  ///< error of each strength, dB
    void read(sim::ParamReader& in);
  };

  Multibeam(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  auto noises() { return std::tie(noise_, strength_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  std::optional<sim::FieldOfView> field_of_view() const override;
  std::int64_t rays() const override { return static_cast<std::int64_t>(rays_S_.size()); }
  void visit_state(sim::StateArchive& archive) override;

  const std::vector<double>& angles_rad() const { return angles_rad_; }
  const std::vector<double>& ranges_m() const { return ranges_m_; }
  const std::vector<double>& strengths_dB() const { return strengths_dB_; }
  const std::vector<std::uint8_t>& valid() const { return valid_; }

 private:
  void make_rays();
  /// Computes range and strength of one beam from its echoes.
  void detect(std::size_t beam);

  Params params_;
  SonarReceiver receiver_;
  sim::NoiseOf<&Params::noise> noise_;
  sim::NoiseOf<&Params::strength_noise> strength_noise_;
  std::vector<double> angles_rad_;
  std::vector<SonarRay> rays_S_;  ///< beam by beam
  std::vector<SonarEcho> echoes_;
  std::vector<double> ranges_m_, true_ranges_m_, strengths_dB_;
  std::vector<std::uint8_t> valid_;
  ReadingDigest digest_;
};

}  // namespace devices
