// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/rays/sound_profile.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sim {

SoundProfile::SoundProfile(std::vector<Knot> knots) : knots_(std::move(knots)) {
  assert(knots_.size() >= 2 && knots_.front().depth_m == 0);
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i)
    gradients_.push_back((knots_[i + 1].speed_mps - knots_[i].speed_mps) / (knots_[i + 1].depth_m - knots_[i].depth_m));
}

namespace {

/// Appends the lower ends of the pieces into which a smooth stretch is halved until it is linear.
void refine(const std::function<double(double)>& speed_mps, SoundProfile::Knot top, SoundProfile::Knot bottom,
            double tolerance_mps, std::vector<SoundProfile::Knot>& out) {
  constexpr double thinnest_m = 0.01;
  const double thickness_m = bottom.depth_m - top.depth_m;
  bool linear = true;
  for (const double share : {0.25, 0.5, 0.75}) {
    const double line_mps = top.speed_mps + share * (bottom.speed_mps - top.speed_mps);
    linear = linear && std::abs(speed_mps(top.depth_m + share * thickness_m) - line_mps) <= tolerance_mps;
  }
  if (linear || thickness_m < thinnest_m) {
    out.push_back(bottom);
    return;
  }
  const double middle_m = top.depth_m + thickness_m / 2;
  const SoundProfile::Knot middle{middle_m, speed_mps(middle_m)};
  refine(speed_mps, top, middle, tolerance_mps, out);
  refine(speed_mps, middle, bottom, tolerance_mps, out);
}

}  // namespace

SoundProfile SoundProfile::fitted(const std::function<double(double)>& speed_mps, std::span<const double> rows_m,
                                  double deepest_m, double tolerance_mps) {
  std::vector<double> rows{0};
  for (const double row_m : rows_m)
    if (row_m > rows.back() && row_m < deepest_m) rows.push_back(row_m);
  rows.push_back(deepest_m);
  std::vector<Knot> knots{{0, speed_mps(0)}};
  for (std::size_t i = 1; i < rows.size(); ++i)
    refine(speed_mps, knots.back(), {rows[i], speed_mps(rows[i])}, tolerance_mps, knots);
  // Mean error of each layer (Simpson's rule; it is zero at the ends), of which each knot takes that of its neighbors.
  std::vector<double> mean_mps;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double middle_m = (knots[i].depth_m + knots[i + 1].depth_m) / 2;
    mean_mps.push_back(2.0 / 3 * (speed_mps(middle_m) - (knots[i].speed_mps + knots[i + 1].speed_mps) / 2));
  }
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const double above = mean_mps[i > 0 ? i - 1 : 0], below = mean_mps[std::min(i, mean_mps.size() - 1)];
    knots[i].speed_mps += (above + below) / 2;
  }
  return SoundProfile(std::move(knots));
}

std::size_t SoundProfile::layer_of(double depth_m) const {
  const auto below = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, depth_m,
                                      [](double depth, const Knot& knot) { return depth < knot.depth_m; });
  return static_cast<std::size_t>(below - knots_.begin()) - 1;
}

double SoundProfile::speed_mps(double depth_m) const {
  const std::size_t layer = layer_of(depth_m);
  return knots_[layer].speed_mps + gradient(layer) * (depth_m - knots_[layer].depth_m);
}

double SoundProfile::highest_mps(double upper_m, double lower_m) const {
  double highest = std::max(speed_mps(upper_m), speed_mps(lower_m));
  for (std::size_t k = layer_of(upper_m) + 1; k < knots_.size() && knots_[k].depth_m < lower_m; ++k)
    highest = std::max(highest, knots_[k].speed_mps);
  return highest;
}

}  // namespace sim
