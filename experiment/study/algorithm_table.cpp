// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/algorithm_table.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "experiment/files/csv.hpp"
#include "experiment/score/paired.hpp"
#include "experiment/study/study_algorithms.hpp"
#include "experiment/study/study_tables.hpp"
#include "sim/random/random.hpp"

namespace experiment {

namespace {

constexpr std::size_t bootstrap_samples = 2000;
constexpr double consistent_nees = 2;  ///< dimensions of the horizontal error
constexpr double clear_nees = 4;       ///< an interval up to there tells enough
constexpr std::int64_t min_trust_runs = 5;
/// Logarithms of a ratio that differ from 0 by rounding only.
constexpr double equal_log = 1e-9;

/// Squares of the error and of the bound of one seed.
struct SeedSquares {
  double error = 0, bound = 0;
};

double root_mean(const std::vector<SeedSquares>& seeds, const std::vector<std::size_t>& chosen) {
  double sum = 0;
  for (const std::size_t i : chosen) sum += seeds[i].error;
  return std::sqrt(sum / static_cast<double>(chosen.size()));
}

double efficiency_of(const std::vector<SeedSquares>& seeds, const std::vector<std::size_t>& chosen) {
  double error = 0, bound = 0;
  for (const std::size_t i : chosen) {
    error += seeds[i].error;
    bound += seeds[i].bound;
  }
  return std::sqrt(bound / error);
}

/// Bootstrap percentiles of a statistic over the seeds.
template <class Statistic>
Interval bootstrap_95(const std::vector<SeedSquares>& seeds, Statistic statistic) {
  if (seeds.size() < 2) return {no_figure, no_figure};
  sim::Random random(1, "bootstrap");
  std::vector<double> values;
  std::vector<std::size_t> chosen(seeds.size());
  for (std::size_t i = 0; i < bootstrap_samples; ++i) {
    for (std::size_t& each : chosen) each = random.integer_below(static_cast<std::uint32_t>(seeds.size()));
    values.push_back(statistic(seeds, chosen));
  }
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.025), quantile(values, 0.975)};
}

Trust trust_of(const Statistics& nees) {
  if (nees.count < min_trust_runs) return Trust::unknown;
  if (nees.mean_95.low > consistent_nees) return Trust::overconfident;
  if (nees.mean_95.high < consistent_nees) return Trust::conservative;
  return nees.mean_95.high > clear_nees ? Trust::unclear : Trust::consistent;
}

/// Runs of a case at a point.
struct World {
  std::string name;
  std::vector<const StudyRun*> runs;
};

std::vector<World> worlds_of(const StudyResults& results) {
  const LoadedStudy& study = results.study();
  std::map<std::pair<std::size_t, std::size_t>, std::vector<const StudyRun*>> groups;
  for (const StudyRun& run : results.runs()) groups[{run.in_case, run.point}].push_back(&run);
  std::vector<World> worlds;
  for (auto& [key, runs] : groups) {
    std::string name = study.config.cases[key.first].name;
    if (!study.config.factors.empty()) name += " (" + values_text(study.config, study.points[key.second]) + ")";
    worlds.push_back({std::move(name), std::move(runs)});
  }
  return worlds;
}

AlgorithmCell cell_of(const World& world, const std::string& label) {
  AlgorithmCell cell;
  cell.world = world.name;
  cell.algorithm = label;
  cell.planned = world.runs.size();
  std::vector<SeedSquares> seeds;
  std::vector<double> nees, inside, bytes, times;
  bool bounded = true;
  for (const StudyRun* run : world.runs) {
    const double rms = figure_of(*run, label + ".rms_m"), ratio = figure_of(*run, label + ".ratio");
    if (!std::isfinite(rms)) continue;
    // An efficiency of some seeds would belong to another set of runs than the rms.
    bounded = bounded && ratio > 0;
    seeds.push_back({rms * rms, rms / ratio * (rms / ratio)});
    nees.push_back(figure_of(*run, label + ".nees_mean"));
    inside.push_back(figure_of(*run, label + ".inside_95_share"));
    bytes.push_back(figure_of(*run, label + ".bytes_per_h"));
    times.push_back(figure_of(*run, label + "." + time_of_event));
  }
  cell.runs = seeds.size();
  if (seeds.empty()) return cell;
  std::vector<std::size_t> all(seeds.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  cell.rms_m = root_mean(seeds, all);
  cell.rms_95 = bootstrap_95(seeds, root_mean);
  if (bounded) {
    cell.efficiency = efficiency_of(seeds, all);
    cell.efficiency_95 = bootstrap_95(seeds, efficiency_of);
  }
  const Statistics of_nees = statistics_of(nees);
  cell.nees = of_nees.mean;
  cell.nees_95 = of_nees.mean_95;
  cell.trust = trust_of(of_nees);
  cell.inside_95 = statistics_of(inside).mean;
  cell.bytes_per_h = statistics_of(bytes).mean;
  // Other work on the machine only makes times longer, so the median is less disturbed than the mean.
  cell.us_per_event = statistics_of(times).median;
  return cell;
}

AlgorithmPair pair_of(const World& world, const std::string& label, const std::string& base) {
  AlgorithmPair pair;
  pair.world = world.name;
  pair.algorithm = label;
  pair.base = base;
  std::vector<double> logarithms;
  for (const StudyRun* run : world.runs) {
    const double log = std::log(figure_of(*run, label + ".rms_m") / figure_of(*run, base + ".rms_m"));
    // Runs of two algorithms that agree to rounding are ties for the test of ranks.
    if (std::isfinite(log)) logarithms.push_back(std::abs(log) < equal_log ? 0 : log);
  }
  pair.pairs = logarithms.size();
  if (logarithms.empty()) return pair;
  const PairedComparison compared = compare_pairs(std::move(logarithms));
  // Ratios are averaged by their logarithms: twice as good and half as good cancel.
  pair.factor = std::exp(compared.mean);
  pair.factor_95 = {std::exp(compared.mean_95.low), std::exp(compared.mean_95.high)};
  pair.wilcoxon_p = compared.wilcoxon_p;
  return pair;
}

std::string short_text(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "-";
}

std::string with_interval(double value, const Interval& interval) {
  if (!std::isfinite(value)) return "-";
  if (!std::isfinite(interval.low)) return short_text(value);
  return fmt::format("{} [{}, {}]", short_text(value), short_text(interval.low), short_text(interval.high));
}

/// `20`, or `19 of 20`.
std::string runs_text(const AlgorithmCell& cell) {
  return cell.runs == cell.planned ? fmt::format("{}", cell.runs) : fmt::format("{} of {}", cell.runs, cell.planned);
}

std::string csv_value(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

/// The algorithms of a world, the best first.  Those that lack a run are omitted: it may be the one that failed.
std::vector<const AlgorithmCell*> ranked(const std::vector<AlgorithmCell>& cells, const std::string& world) {
  std::vector<const AlgorithmCell*> order;
  for (const AlgorithmCell& cell : cells)
    if (cell.world == world && cell.runs == cell.planned && std::isfinite(cell.rms_m)) order.push_back(&cell);
  std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) { return a->rms_m < b->rms_m; });
  return order;
}

}  // namespace

const char* trust_word(Trust trust) {
  switch (trust) {
    case Trust::consistent:
      return "consistent";
    case Trust::overconfident:
      return "overconfident";
    case Trust::conservative:
      return "conservative";
    case Trust::unclear:
      return "unclear";
    case Trust::unknown:
      break;
  }
  return "-";
}

AlgorithmTable::AlgorithmTable(const StudyResults& results) {
  const StudyConfig& config = results.study().config;
  base_ = config.pairs;
  for (const World& world : worlds_of(results)) {
    for (const std::string& algorithm : config.algorithms) {
      const std::string label = algorithm_label(algorithm);
      cells_.push_back(cell_of(world, label));
      if (AlgorithmPair pair = pair_of(world, label, config.pairs); label != config.pairs && pair.pairs > 0)
        pairs_.push_back(std::move(pair));
    }
    const auto order = ranked(cells_, world.name);
    if (order.size() > 1) winners_.push_back(pair_of(world, order[1]->algorithm, order[0]->algorithm));
  }
}

std::vector<std::string> AlgorithmTable::sentences() const {
  std::vector<std::string> sentences;
  for (const AlgorithmPair& pair : winners_) {
    const auto order = ranked(cells_, pair.world);
    std::string text = fmt::format("{}: {} has the smallest rms, {} m, then {} with {} m; ratio in pairs {}",
                                   pair.world, pair.base, short_text(order[0]->rms_m), pair.algorithm,
                                   short_text(order[1]->rms_m), with_interval(pair.factor, pair.factor_95));
    if (order[0]->trust == Trust::overconfident) {
      const auto trusted = std::find_if(order.begin(), order.end(), [](const auto* cell) {
        return cell->trust != Trust::overconfident && cell->trust != Trust::unclear;
      });
      text += fmt::format("; {} is overconfident (NEES {})", pair.base, short_text(order[0]->nees));
      if (trusted != order.end())
        text +=
            fmt::format(", the best that is not is {} with {} m", (*trusted)->algorithm, short_text((*trusted)->rms_m));
    }
    sentences.push_back(text);
  }
  return sentences;
}

std::string AlgorithmTable::text() const {
  std::size_t world = 5, algorithm = 9;
  for (const AlgorithmCell& cell : cells_) {
    world = std::max(world, cell.world.size());
    algorithm = std::max(algorithm, cell.algorithm.size());
  }
  std::string text =
      fmt::format("{:<{}}  {:<{}}  {:>8}  {:<20}  {:<20}  {:<11}  {:<20}  {:>7}  {:>8}\n", "world", world, "algorithm",
                  algorithm, "runs", "rms, m", "NEES (2: consistent)", "covariance", "bound / rms", "B/h", "us/event");
  for (const AlgorithmCell& cell : cells_)
    text += fmt::format(
        "{:<{}}  {:<{}}  {:>8}  {:<20}  {:<20}  {:<11}  {:<20}  {:>7}  {:>8}\n", cell.world, world, cell.algorithm,
        algorithm, runs_text(cell), with_interval(cell.rms_m, cell.rms_95), with_interval(cell.nees, cell.nees_95),
        trust_word(cell.trust), with_interval(cell.efficiency, cell.efficiency_95),
        std::isfinite(cell.bytes_per_h) ? fmt::format("{:.0f}", cell.bytes_per_h) : "-", short_text(cell.us_per_event));
  for (const AlgorithmPair& pair : pairs_)
    text += fmt::format("{}: rms of {} over that of {}, in {} pairs: {}, p = {}\n", pair.world, pair.algorithm,
                        pair.base, pair.pairs, with_interval(pair.factor, pair.factor_95), short_text(pair.wilcoxon_p));
  for (const std::string& sentence : sentences()) text += sentence + "\n";
  return text;
}

std::string AlgorithmTable::markdown() const {
  std::string text =
      "| world | algorithm | runs | rms, m | NEES | covariance | bound / rms | rms over that of the base, p | B/h | "
      "us/event "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const AlgorithmCell& cell : cells_) {
    const auto pair = std::find_if(pairs_.begin(), pairs_.end(), [&](const AlgorithmPair& each) {
      return each.world == cell.world && each.algorithm == cell.algorithm;
    });
    const std::string nees = with_interval(cell.nees, cell.nees_95);
    text += fmt::format(
        "| {} | `{}` | {} | {} | {} | {} | {} | {} | {} | {} |\n", cell.world, cell.algorithm, runs_text(cell),
        with_interval(cell.rms_m, cell.rms_95), cell.trust == Trust::overconfident ? "**" + nees + "**" : nees,
        trust_word(cell.trust), with_interval(cell.efficiency, cell.efficiency_95),
        pair == pairs_.end() ? (cell.runs > 0 && cell.algorithm == base_ ? "base" : "-")
                             : with_interval(pair->factor, pair->factor_95) + ", " + short_text(pair->wilcoxon_p),
        std::isfinite(cell.bytes_per_h) ? fmt::format("{:.0f}", cell.bytes_per_h) : "-", short_text(cell.us_per_event));
  }
  text += "\n";
  for (const std::string& sentence : sentences()) text += "- " + sentence + ".\n";
  return text;
}

std::string AlgorithmTable::csv() const {
  std::string text =
      "world,algorithm,runs,rms_m,rms_low_95,rms_high_95,nees,nees_low_95,nees_high_95,covariance,inside_95_share,"
      "efficiency,efficiency_low_95,efficiency_high_95,bytes_per_h,us_per_event\n";
  for (const AlgorithmCell& cell : cells_) {
    text += fmt::format("{},{},{}", csv_field(cell.world), cell.algorithm, cell.runs);
    for (const double value :
         {cell.rms_m, cell.rms_95.low, cell.rms_95.high, cell.nees, cell.nees_95.low, cell.nees_95.high})
      text += "," + csv_value(value);
    text += std::string(",") + trust_word(cell.trust);
    for (const double value : {cell.inside_95, cell.efficiency, cell.efficiency_95.low, cell.efficiency_95.high,
                               cell.bytes_per_h, cell.us_per_event})
      text += "," + csv_value(value);
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json AlgorithmTable::json() const {
  using Json = nlohmann::ordered_json;
  Json json{{"cells", Json::array()}, {"pairs", Json::array()}, {"sentences", sentences()}};
  for (const AlgorithmCell& cell : cells_)
    json["cells"].push_back({{"world", cell.world},
                             {"algorithm", cell.algorithm},
                             {"runs", cell.runs},
                             {"planned", cell.planned},
                             {"rms_m", cell.rms_m},
                             {"rms_95", {cell.rms_95.low, cell.rms_95.high}},
                             {"nees", cell.nees},
                             {"nees_95", {cell.nees_95.low, cell.nees_95.high}},
                             {"covariance", trust_word(cell.trust)},
                             {"inside_95_share", cell.inside_95},
                             {"efficiency", cell.efficiency},
                             {"efficiency_95", {cell.efficiency_95.low, cell.efficiency_95.high}},
                             {"bytes_per_h", cell.bytes_per_h},
                             {"us_per_event", cell.us_per_event}});
  for (const AlgorithmPair& pair : pairs_)
    json["pairs"].push_back({{"world", pair.world},
                             {"algorithm", pair.algorithm},
                             {"base", pair.base},
                             {"pairs", pair.pairs},
                             {"factor", pair.factor},
                             {"factor_95", {pair.factor_95.low, pair.factor_95.high}},
                             {"wilcoxon_p", pair.wilcoxon_p}});
  return json;
}

}  // namespace experiment
