// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "devices/common/reading_digest.hpp"
#include "devices/ranging/sonar_return.hpp"
#include "sim/random/noise.hpp"

namespace devices {

/// Conversion of echo levels to an image; read from the map of the device.
struct SonarImageParams {
  int bins = 400;
  double noise_level_dB = 50;  ///< background in each bin, re 1 uPa
  double floor_dB = 75;
  double dynamic_range_dB = 60;
  sim::NoiseParams level_noise;  ///< dB
  /// Reads the parameters; `sonar` holds the sonar parameters already read.
  void read(sim::ParamReader& in, const SonarParams& sonar);
  double dB_per_count() const { return dynamic_range_dB / 255; }
};

/// Echo power over range and beam, in row-major order with one row per range bin.
class SonarBins {
 public:
  SonarBins(const SonarImageParams& params, const sim::DeviceContext& context);
  void change(const SonarImageParams& params, const SonarParams& sonar, int beams);

  /// Clears the bins for a ping; `receiver` must have cast its rays.
  void begin(const SonarReceiver& receiver);
  /// Adds an echo, spread evenly over `extent_m` of range about its own range, at least over the pulse length.
  void add(const SonarEcho& echo, double extent_m, int beam);
  /// Computes levels and pixels from the power, without errors.
  void finish(const SonarReceiver& receiver);
  /// Computes levels and pixels with background noise and, if configured, speckle.
  void disturb(double dt_s, sim::Random& random);

  int bins() const { return params_.bins; }
  int beams() const { return beams_; }
  const SonarImageParams& params() const { return params_; }
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }
  /// Archives a hash of the last image, which is already published.
  void visit_state(sim::StateArchive& archive);

 private:
  void quantize();

  SonarImageParams params_;
  sim::NoiseOf<&SonarImageParams::level_noise> level_noise_;
  bool speckle_ = true;
  int beams_ = 0;
  double range_min_m_ = 0, range_max_m_ = 0, pulse_m_ = 0, range_scale_ = 1;
  std::vector<double> power_uPa2_, levels_dB_;
  std::vector<double> gains_dB_;  ///< gain of each bin
  std::vector<std::uint8_t> pixels_;
  ReadingDigest digest_;  // of pixels_
};

}  // namespace devices
