// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_design.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <iterator>
#include <numeric>
#include <string_view>

#include "sim/config/message_text.hpp"
#include "sim/random/random.hpp"

namespace experiment {

namespace {

/// Columns of study.csv and points.csv, among which those of the factors stand.
constexpr std::string_view other_columns[] = {
    "case",  "seed",  "exit_code", "passed",      "ended",        "sim_time_s",    "wall_s",        "run_hash", "run",
    "point", "shoal", "processor", "c_library",   "figure",       "runs",          "count",         "mean",     "std",
    "min",   "max",   "median",    "mean_low_95", "mean_high_95", "median_low_95", "median_high_95"};

/// Returns the index of a share in a list of `count` items.
std::size_t item_at(double share, std::size_t count) {
  return std::min(static_cast<std::size_t>(share * static_cast<double>(count)), count - 1);
}

std::vector<std::vector<double>> random_shares(const StudyDesign& design, std::size_t points, std::size_t dimensions) {
  sim::Random random(static_cast<std::uint64_t>(design.seed), "study/random");
  std::vector<std::vector<double>> shares(points, std::vector<double>(dimensions));
  for (std::vector<double>& point : shares)
    for (double& share : point) share = random.uniform();
  return shares;
}

std::vector<std::vector<double>> latin_shares(const StudyDesign& design, std::size_t points, std::size_t dimensions) {
  sim::Random random(static_cast<std::uint64_t>(design.seed), "study/latin_hypercube");
  std::vector<std::vector<double>> shares(points, std::vector<double>(dimensions));
  std::vector<std::size_t> order(points);
  for (std::size_t k = 0; k < dimensions; ++k) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    // A random order for each factor (Fisher-Yates), so that each of its parts has one point.
    for (std::size_t i = points; i > 1; --i)
      std::swap(order[i - 1], order[random.integer_below(static_cast<std::uint32_t>(i))]);
    for (std::size_t i = 0; i < points; ++i)
      shares[i][k] = (static_cast<double>(order[i]) + random.uniform()) / static_cast<double>(points);
  }
  return shares;
}

std::vector<std::vector<double>> sobol_shares(std::size_t points, std::size_t dimensions) {
  boost::random::sobol sequence(dimensions);
  std::vector<std::vector<double>> shares(points, std::vector<double>(dimensions));
  for (std::vector<double>& point : shares)
    for (double& share : point) share = std::ldexp(static_cast<double>(sequence() >> 11u), -53);
  return shares;
}

}  // namespace

void StudyFactor::read(sim::ParamReader& in) {
  if (in.node() != nullptr) place = in.node()->place;
  in.require("name");
  in.read_name("name", name, "name of the factor, a column of study.csv");
  in.require("paths");
  in.read("paths", paths, "dotted paths that get the value, as with --set");
  in.read("values", values, "values, instead of a range");
  in.read("from", from, sim::any_number(), "lower end of the range");
  in.read("to", to, sim::any_number(), "upper end of the range");
  in.read_choice("scale", scale, {{"linear", Scale::linear}, {"log", Scale::log}},
                 "how a range is divided; log: by equal ratios");
  in.read("whole", whole, "round values of the range to whole numbers");
  std::int64_t number = 2;
  in.read("levels", number, sim::between(2, 1000), "values of the range in a grid, with both ends");
  if (in.describing()) return;
  if (std::find(std::begin(other_columns), std::end(other_columns), name) != std::end(other_columns))
    in.error("name", "'name' must not be that of another column of the tables, got '" + name + "'");
  if (in.has("levels")) levels = number;
  if (in.has("paths") && paths.empty()) in.error("paths", "'paths' must not be empty");
  if (in.has("values") && values.empty()) in.error("values", "'values' must not be empty");
  const bool range = from || to;
  if (in.has("values") == range) {
    in.error(range ? "needs either 'values' or 'from' and 'to', not both" : "needs 'values', or 'from' and 'to'");
  } else if (range && (!from || !to)) {
    in.error(from ? "has 'from' but no 'to'" : "has 'to' but no 'from'");
  } else if (range && !(*from < *to)) {
    in.error("to", "'to' must be greater than 'from', got " + sim::number_text(*to));
  } else if (range && scale == Scale::log && *from <= 0) {
    in.error("from", "'from' must be > 0 with 'scale: log', got " + sim::number_text(*from));
  }
  for (const std::string& path : paths)
    if (path.empty() || path.find('=') != std::string::npos)
      in.error("paths", "'paths' must be dotted paths, got '" + sim::shortened(sim::printable(path)) + "'");
}

std::string StudyFactor::value_at(double share) const {
  if (!values.empty()) return values[item_at(share, values.size())];
  double value = scale == Scale::log ? std::exp((1 - share) * std::log(*from) + share * std::log(*to))
                                     : (1 - share) * *from + share * *to;
  value = std::clamp(value, *from, *to);
  if (share == 0) value = *from;
  if (share == 1) value = *to;
  return sim::number_text(whole ? std::round(value) : value);
}

double StudyFactor::share_of_level(std::size_t level, std::size_t count) const {
  if (!values.empty()) return (static_cast<double>(level) + 0.5) / static_cast<double>(count);
  return static_cast<double>(level) / static_cast<double>(count - 1);
}

std::size_t StudyFactor::grid_levels() const {
  if (!values.empty()) return values.size();
  return levels ? static_cast<std::size_t>(*levels) : 0;
}

void StudyDesign::read(sim::ParamReader& in) {
  in.read_choice(
      "type", type,
      {{"grid", Type::grid},
       {"random", Type::random},
       {"latin_hypercube", Type::latin_hypercube},
       {"sobol", Type::sobol}},
      "how points are chosen: every combination of the levels, independent random points, one point in each part of "
      "each range, or a sequence that fills the space evenly");
  std::int64_t count = points.value_or(1);
  in.read("points", count, sim::between(1, static_cast<double>(max_points)), "number of points; not of a grid");
  in.read("seed", seed, sim::between(0, 9007199254740992.0), "seed of random points");
  if (in.describing()) return;
  if (in.has("points")) points = count;
  if (type == Type::grid && points) in.error("points", "a grid has no 'points': the levels of the factors give them");
  if (type != Type::grid && !points) in.error("needs 'points'");
  if (in.has("seed") && (type == Type::grid || type == Type::sobol))
    in.error("seed", "only the designs random and latin_hypercube have a 'seed'");
}

std::vector<std::vector<double>> design_shares(const StudyDesign& design, std::size_t dimensions) {
  const auto points = static_cast<std::size_t>(design.points.value_or(0));
  switch (design.type) {
    case StudyDesign::Type::random:
      return random_shares(design, points, dimensions);
    case StudyDesign::Type::latin_hypercube:
      return latin_shares(design, points, dimensions);
    case StudyDesign::Type::sobol:
      return sobol_shares(points, dimensions);
    case StudyDesign::Type::grid:
      break;
  }
  return {};
}

std::vector<StudyPoint> design_points(const StudyDesign& design, const std::vector<StudyFactor>& factors) {
  std::vector<StudyPoint> points;
  if (factors.empty()) return {{}};
  if (design.type != StudyDesign::Type::grid) {
    for (const std::vector<double>& shares : design_shares(design, factors.size())) {
      StudyPoint& point = points.emplace_back();
      for (std::size_t k = 0; k < factors.size(); ++k) point.values.push_back(factors[k].value_at(shares[k]));
    }
    return points;
  }
  std::size_t count = 1;
  for (const StudyFactor& factor : factors) count *= factor.grid_levels();
  for (std::size_t number = 0; number < count; ++number) {
    StudyPoint& point = points.emplace_back();
    point.values.resize(factors.size());
    // The last factor varies fastest, as in nested loops.
    std::size_t rest = number;
    for (std::size_t k = factors.size(); k-- > 0;) {
      const std::size_t levels = factors[k].grid_levels();
      point.values[k] = factors[k].value_at(factors[k].share_of_level(rest % levels, levels));
      rest /= levels;
    }
  }
  return points;
}

std::vector<std::string> point_sets(const std::vector<StudyFactor>& factors, const StudyPoint& point) {
  std::vector<std::string> sets;
  for (std::size_t k = 0; k < factors.size(); ++k)
    for (const std::string& path : factors[k].paths) sets.push_back(path + "=" + point.values[k]);
  return sets;
}

}  // namespace experiment
