// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "devices/common/reading_digest.hpp"
#include "devices/ranging/sonar_return.hpp"
#include "sim/random/noise.hpp"

namespace devices {

/// How echo levels become an image; read from the device's own map.
struct SonarImageParams {
  int bins = 400;
  double noise_level_dB = 50;  ///< background in each bin, re 1 uPa
  double floor_dB = 75;
  double dynamic_range_dB = 60;
  sim::NoiseParams level_noise;  ///< dB
  /// `sonar`: as it was read.
  void read(sim::ParamReader& in, const SonarParams& sonar);
  double dB_per_count() const { return dynamic_range_dB / 255; }
};

/// Echo power over range, for a number of beams: bin by bin, and in each bin beam by beam.
class SonarBins {
 public:
  SonarBins(const SonarImageParams& params, const sim::DeviceContext& context);
  void change(const SonarImageParams& params, const SonarParams& sonar, int beams);

  /// Before the echoes of a ping: `receiver` has cast its rays.
  void begin(const SonarReceiver& receiver);
  /// Adds an echo that comes from `extent_m` of range about the echo's own, evenly; at least from a pulse's length.
  void add(const SonarEcho& echo, double extent_m, int beam);
  /// Levels and pixels from the power: without errors.
  void finish(const SonarReceiver& receiver);
  /// Levels and pixels with background noise and, when asked for, speckle.
  void disturb(double dt_s, sim::Random& random);

  int bins() const { return params_.bins; }
  int beams() const { return beams_; }
  const SonarImageParams& params() const { return params_; }
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }
  /// The image of the last ping is out already: its hash.
  void visit_state(sim::StateArchive& archive);

 private:
  void quantize();

  SonarImageParams params_;
  sim::NoiseOf<&SonarImageParams::level_noise> level_noise_;
  bool speckle_ = true;
  int beams_ = 0;
  double range_min_m_ = 0, range_max_m_ = 0, pulse_m_ = 0, range_scale_ = 1;
  std::vector<double> power_uPa2_, levels_dB_;
  std::vector<double> gains_dB_;  ///< of each bin
  std::vector<std::uint8_t> pixels_;
  ReadingDigest digest_;  // of pixels_
};

}  // namespace devices
