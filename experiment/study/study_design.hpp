// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace experiment {

/// Setting of the world that a design varies: a list of values, or a range.
struct StudyFactor {
  enum class Scale { linear, log };
  std::string name;
  std::vector<std::string> paths;      ///< dotted paths that get the value, as with --set
  std::vector<std::string> values;     ///< as written; empty: a range
  std::optional<double> from, to;      ///< the range
  Scale scale = Scale::linear;         ///< of a range
  bool whole = false;                  ///< values of the range are rounded to whole numbers
  std::optional<std::int64_t> levels;  ///< of a range in a grid
  sim::SourcePlace place;
  void read(sim::ParamReader& in);

  /// Returns the value at a share of the range or list, from 0 to 1, as it is written in a world.
  std::string value_at(double share) const;
  /// Returns the share of one of `count` levels of a grid, which include both ends of a range.
  double share_of_level(std::size_t level, std::size_t count) const;
  /// Number of levels in a grid; 0: it has neither values nor `levels`.
  std::size_t grid_levels() const;
};

/// How points are chosen in the space of the factors.
struct StudyDesign {
  enum class Type { grid, random, latin_hypercube, sobol };
  Type type = Type::grid;
  std::optional<std::int64_t> points;  ///< all types but `grid`
  std::int64_t seed = 1;               ///< of `random` and `latin_hypercube`
  void read(sim::ParamReader& in);
};

/// Point of a design: a value of each factor.
struct StudyPoint {
  std::vector<std::string> values;
};

/// Most points of a design.
inline constexpr std::size_t max_points = 100000;

/// Returns shares, from 0 to 1, of `points` points in `dimensions` dimensions.  Not for grids.  `latin_hypercube`: each
/// factor has one point in each of `points` equal parts of its range (McKay, Beckman and Conover 1979).  `sobol`: the
/// sequence of Sobol without its first point, which is 0 (direction numbers of Joe and Kuo 2008, by Boost).
std::vector<std::vector<double>> design_shares(const StudyDesign& design, std::size_t dimensions);

/// Returns the points of a design, in order; of a grid the last factor changes first.  Without factors: one point
/// without values.
std::vector<StudyPoint> design_points(const StudyDesign& design, const std::vector<StudyFactor>& factors);

/// Returns `path=value` of each setting of a point.
std::vector<std::string> point_sets(const std::vector<StudyFactor>& factors, const StudyPoint& point);

}  // namespace experiment
