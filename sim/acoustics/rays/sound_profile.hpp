// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace sim {

/// Speed of sound over the depth, in layers in which it is linear, so that rays are arcs of circles.  Depths are below
/// the surface, m.
class SoundProfile {
 public:
  struct Knot {
    double depth_m, speed_mps;
  };

  /// Makes layers between knots: at least two, the first at the surface, with rising depths and positive speeds.
  explicit SoundProfile(std::vector<Knot> knots);
  /// Fits layers to a speed that is smooth between the depths of `rows_m`, from the surface to `deepest_m`: refined
  /// until it is linear to `tolerance_mps`, with zero mean error, so that errors of travel times cancel.
  static SoundProfile fitted(const std::function<double(double)>& speed_mps, std::span<const double> rows_m,
                             double deepest_m, double tolerance_mps = 5e-5);

  const std::vector<Knot>& knots() const { return knots_; }
  std::size_t layers() const { return knots_.size() - 1; }
  double deepest_m() const { return knots_.back().depth_m; }
  /// Layer of a depth; that of a knot is the one below it.
  std::size_t layer_of(double depth_m) const;
  /// Change of speed per depth in a layer, 1/s.
  double gradient(std::size_t layer) const { return gradients_[layer]; }
  double speed_mps(double depth_m) const;
  /// Highest speed between two depths, the smaller one first.
  double highest_mps(double upper_m, double lower_m) const;

 private:
  std::vector<Knot> knots_;
  std::vector<double> gradients_;
};

}  // namespace sim
