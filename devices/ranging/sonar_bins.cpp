// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/sonar_bins.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace devices {

namespace {

constexpr double smallest_bin_m = 1e-4;
constexpr double silence_dB = -300;  // level without any echo, below every floor

double level_dB(double power_uPa2) {
  return power_uPa2 > 0 ? 10 * std::log10(power_uPa2) : silence_dB;
}

}  // namespace

void SonarImageParams::read(sim::ParamReader& in, const SonarParams& sonar) {
  in.read("bins", bins, sim::between(1, 10000), "steps in range");
  in.read("noise_level_dB", noise_level_dB, sim::any_number(), "background in each bin, re 1 uPa, before the gain");
  in.read("floor_dB", floor_dB, sim::any_number(), "level of the value 0, re 1 uPa, after the gain");
  in.read("dynamic_range_dB", dynamic_range_dB, sim::between(1, 200), "from the value 0 to the value 255");
  in.read("level_noise", level_noise, "further error of each level, dB");
  const double bin_m = (sonar.range_max_m - sonar.range_min_m) / bins;
  if (in.describing() || bin_m >= smallest_bin_m || bin_m <= 0) return;
  const char* key = in.has("bins") ? "bins" : in.has("range_max_m") ? "range_max_m" : "range_min_m";
  in.error(key, fmt::format("'range_min_m' to 'range_max_m' in 'bins' steps must be at least {:g} m each, got {:g} m",
                            smallest_bin_m, bin_m));
}

SonarBins::SonarBins(const SonarImageParams& params, const sim::DeviceContext& context)
    : params_(params), level_noise_(context, params) {}

void SonarBins::change(const SonarImageParams& params, const SonarParams& sonar, int beams) {
  params_ = params;
  level_noise_.change(params);
  speckle_ = sonar.speckle;
  beams_ = beams;
  range_min_m_ = sonar.range_min_m;
  range_max_m_ = sonar.range_max_m;
  const auto size = static_cast<std::size_t>(beams) * static_cast<std::size_t>(params.bins);
  power_uPa2_.assign(size, 0);
  levels_dB_.assign(size, silence_dB);
  pixels_.assign(size, 0);
  digest_.renew();
  gains_dB_.assign(static_cast<std::size_t>(params.bins), 0);
}

void SonarBins::begin(const SonarReceiver& receiver) {
  std::fill(power_uPa2_.begin(), power_uPa2_.end(), 0.0);
  digest_.renew();
  range_scale_ = receiver.range_scale();
  pulse_m_ = receiver.pulse_m() * range_scale_;
}

void SonarBins::add(const SonarEcho& echo, double extent_m, int beam) {
  if (!(echo.power_uPa2 > 0)) return;
  const double bin_m = (range_max_m_ - range_min_m_) / params_.bins;
  const double width = std::max(extent_m * range_scale_, pulse_m_) / bin_m;
  const double from = (echo.range_m * range_scale_ - range_min_m_) / bin_m - width / 2, to = from + width;
  // Clamp before the conversion: at grazing incidence the extent can exceed the range of int.
  const int first = static_cast<int>(std::clamp(std::floor(from), 0.0, static_cast<double>(params_.bins)));
  const int last = static_cast<int>(std::clamp(std::floor(to), -1.0, params_.bins - 1.0));
  for (int bin = first; bin <= last; ++bin) {
    const double share = (std::min<double>(bin + 1, to) - std::max<double>(bin, from)) / width;
    power_uPa2_[static_cast<std::size_t>(bin) * static_cast<std::size_t>(beams_) + static_cast<std::size_t>(beam)] +=
        echo.power_uPa2 * share;
  }
}

void SonarBins::finish(const SonarReceiver& receiver) {
  const double bin_m = (range_max_m_ - range_min_m_) / params_.bins;
  for (std::size_t bin = 0; bin < gains_dB_.size(); ++bin)
    gains_dB_[bin] = receiver.gain_dB(range_min_m_ + (static_cast<double>(bin) + 0.5) * bin_m);
  const auto beams = static_cast<std::size_t>(beams_);
  for (std::size_t i = 0; i < levels_dB_.size(); ++i) levels_dB_[i] = level_dB(power_uPa2_[i]) + gains_dB_[i / beams];
  quantize();
}

void SonarBins::disturb(double dt_s, sim::Random& random) {
  const double background_uPa2 = std::pow(10, params_.noise_level_dB / 10);
  const auto beams = static_cast<std::size_t>(beams_);
  for (std::size_t i = 0; i < levels_dB_.size(); ++i) {
    // Echo and background are sums of many waves with random phases, so speckle applies to their total power.
    double power_uPa2 = power_uPa2_[i] + background_uPa2;
    if (speckle_) power_uPa2 *= speckle_power(random);
    levels_dB_[i] = level_dB(power_uPa2) + gains_dB_[i / beams];
  }
  level_noise_.apply(std::span<double>(levels_dB_), dt_s, random);
  quantize();
}

void SonarBins::quantize() {
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const double count = std::round((levels_dB_[i] - params_.floor_dB) / params_.dB_per_count());
    pixels_[i] = static_cast<std::uint8_t>(std::clamp(count, 0.0, 255.0));
  }
}

void SonarBins::visit_state(sim::StateArchive& archive) {
  archive(level_noise_);
  digest_.visit(archive, pixels_);
}

}  // namespace devices
