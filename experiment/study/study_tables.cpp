// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_tables.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "experiment/files/csv.hpp"
#include "experiment/study/run_files.hpp"
#include "experiment/study/study_rules.hpp"

namespace experiment {

namespace {

constexpr std::size_t max_points_in_json = 2000;
constexpr std::size_t max_failed_in_text = 20;
constexpr std::size_t max_converging_figures = 3;
constexpr std::size_t max_curve_points = 100;
/// Most points of the only case that are compared with the first one.
constexpr std::size_t max_compared_points = 50;

std::string short_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

std::string csv_number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

}  // namespace

RunKind kind_of(const RunRecord& record) {
  const std::size_t comma = record.build.find(", ");
  return {record.version, record.build.substr(0, comma),
          comma == std::string::npos ? "" : record.build.substr(comma + 2)};
}

std::string values_text(const StudyConfig& config, const StudyPoint& point) {
  std::string text;
  for (std::size_t k = 0; k < config.factors.size(); ++k)
    text += (k == 0 ? "" : ", ") + config.factors[k].name + " = " + point.values[k];
  return text;
}

nlohmann::ordered_json statistics_json(const Statistics& statistics) {
  nlohmann::ordered_json json{{"count", statistics.count}};
  for (const std::string& word : statistic_words()) json[word] = statistics.by_word(word);  // NaN becomes null
  json["mean_low_95"] = statistics.mean_95.low;
  json["mean_high_95"] = statistics.mean_95.high;
  json["median_low_95"] = statistics.median_95.low;
  json["median_high_95"] = statistics.median_95.high;
  return json;
}

nlohmann::ordered_json comparison_json(const StudyComparison& comparison) {
  const PairedComparison& d = comparison.difference;
  return {{"compared", comparison.compared},
          {"base", comparison.base},
          {"figure", comparison.figure},
          {"pairs", d.pairs},
          {"mean", d.mean},
          {"mean_low_95", d.mean_95.low},
          {"mean_high_95", d.mean_95.high},
          {"median", d.median},
          {"higher", d.higher},
          {"lower", d.lower},
          {"equal", d.equal},
          {"sign_p", d.sign_p},
          {"wilcoxon_p", d.wilcoxon_p}};
}

void add_points(nlohmann::ordered_json& json, const StudyResults& results) {
  const StudyConfig& config = results.study().config;
  if (config.factors.empty()) return;
  json["factors"] = nlohmann::ordered_json::array();
  for (const StudyFactor& factor : config.factors)
    json["factors"].push_back(
        {{"name", factor.name}, {"paths", factor.paths}, {"log", factor.scale == StudyFactor::Scale::log}});
  json["points"] = nlohmann::ordered_json::array();
  const std::vector<StudyPoint>& points = results.study().points;
  // A page that reads the JSON would not cope with more; points.csv has all.
  for (std::size_t point = 0; point < std::min(points.size(), max_points_in_json); ++point)
    for (std::size_t in_case = 0; in_case < config.cases.size(); ++in_case) {
      nlohmann::ordered_json entry{{"point", point + 1},
                                   {"case", config.cases[in_case].name},
                                   {"values", points[point].values},
                                   {"figures", nlohmann::ordered_json::object()}};
      for (const std::string& figure : results.table_figures())
        entry["figures"][figure] = statistics_json(results.at_point(in_case, point, figure));
      json["points"].push_back(std::move(entry));
    }
}

void add_convergence(nlohmann::ordered_json& json, const StudyResults& results) {
  const StudyConfig& config = results.study().config;
  json["convergence"] = nlohmann::ordered_json::array();
  const std::size_t seeds = config.seeds.size();
  if (seeds < 3) return;
  std::size_t figures = 0;
  for (const std::string& figure : results.table_figures()) {
    if (figure == passed_figure || ++figures > max_converging_figures) continue;
    for (std::size_t in_case = 0; in_case < config.cases.size(); ++in_case) {
      // Values by seed.
      std::map<std::int64_t, std::vector<double>> by_seed;
      for (const StudyRun& run : results.runs())
        if (run.in_case == in_case) by_seed[run.seed].push_back(figure_of(run, figure));
      nlohmann::ordered_json curve{
          {"figure", figure}, {"case", config.cases[in_case].name}, {"points", nlohmann::ordered_json::array()}};
      std::vector<double> values;
      const std::size_t every = (seeds + max_curve_points - 1) / max_curve_points;
      for (std::size_t i = 0; i < seeds; ++i) {
        // Runs of one seed at several points are not independent.
        values.push_back(statistics_of(by_seed[config.seeds[i]]).mean);
        if (i == 0 || (i % every != 0 && i + 1 < seeds)) continue;
        const Statistics s = statistics_of(values);
        curve["points"].push_back({i + 1, s.mean, s.mean_95.low, s.mean_95.high});
      }
      json["convergence"].push_back(std::move(curve));
    }
  }
}

std::vector<ExtremeRun> extreme_runs(const StudyResults& results) {
  std::vector<ExtremeRun> extremes;
  for (const std::string& figure : results.table_figures()) {
    // Its extremes are 0 and 1.
    if (figure == passed_figure) continue;
    const StudyRun *min_run = nullptr, *max_run = nullptr;
    for (const StudyRun& run : results.runs()) {
      const double value = figure_of(run, figure);
      if (!std::isfinite(value)) continue;
      if (min_run == nullptr || value < figure_of(*min_run, figure)) min_run = &run;
      if (max_run == nullptr || value > figure_of(*max_run, figure)) max_run = &run;
    }
    // A figure that is the same in all runs has no extreme.
    if (min_run == nullptr || figure_of(*min_run, figure) == figure_of(*max_run, figure)) continue;
    extremes.push_back({figure, true, max_run});
    extremes.push_back({figure, false, min_run});
  }
  return extremes;
}

std::string shown_folder(const StudyRun& run) {
  return fmt::format("shown/run_{}", run.index);
}

void add_extremes(nlohmann::ordered_json& json, const StudyResults& results) {
  const LoadedStudy& study = results.study();
  json["extremes"] = nlohmann::ordered_json::array();
  for (const auto& [figure, max, run] : extreme_runs(results))
    json["extremes"].push_back({{"figure", figure},
                                {"which", max ? "max" : "min"},
                                {"value", figure_of(*run, figure)},
                                {"run", run->index},
                                {"case", study.config.cases[run->in_case].name},
                                {"seed", run->seed},
                                {"folder", directory_of(study, ".", run->in_case, run->point, run->seed).substr(2)},
                                {"shown", shown_folder(*run)},
                                {"command", command_of(study, *run)}});
}

std::string StudyResults::points_csv() const {
  const StudyConfig& config = study_.config;
  std::string text = "case,point";
  for (const StudyFactor& factor : config.factors) text += "," + factor.name;
  text += ",figure,runs,count,mean,mean_low_95,mean_high_95,std,min,median,median_low_95,median_high_95,max\n";
  const std::vector<std::string> figures = table_figures();
  for (const auto& [key, runs] : groups_) {
    const auto [in_case, point] = key;
    std::string begin = fmt::format("{},{}", config.cases[in_case].name, config.factors.empty() ? 0 : point + 1);
    for (const std::string& value : study_.points[point].values) begin += "," + csv_field(value);
    for (const std::string& figure : figures) {
      const Statistics s = at_point(in_case, point, figure);
      text += fmt::format("{},{},{},{}", begin, figure, runs.size(), s.count);
      for (const double value :
           {s.mean, s.mean_95.low, s.mean_95.high, s.std, s.min, s.median, s.median_95.low, s.median_95.high, s.max})
        text += "," + csv_number(value);
      text += "\n";
    }
  }
  return text;
}

std::vector<StudyComparison> StudyResults::comparisons() const {
  const StudyConfig& config = study_.config;
  const bool of_cases = config.cases.size() > 1;
  if (config.of_worlds) return {};  // figures of different worlds are not pairs
  const std::size_t count = of_cases ? config.cases.size() : study_.points.size();
  if (!of_cases && count > max_compared_points) return {};
  // Runs of each case or point by what a pair has in common.
  std::vector<std::map<std::pair<std::size_t, std::int64_t>, const StudyRun*>> groups(count);
  for (const StudyRun& run : runs_)
    if (of_cases)
      groups[run.in_case][{run.point, run.seed}] = &run;
    else
      groups[run.point][{0, run.seed}] = &run;
  const auto name = [&](std::size_t i) {
    return of_cases ? config.cases[i].name : values_text(config, study_.points[i]);
  };
  std::vector<StudyComparison> comparisons;
  for (const std::string& figure : table_figures())
    for (std::size_t i = 1; i < count; ++i) {
      std::vector<double> differences;
      for (const auto& [key, run] : groups[i]) {
        const auto base = groups[0].find(key);
        if (base == groups[0].end()) continue;
        const double difference = figure_of(*run, figure) - figure_of(*base->second, figure);
        if (std::isfinite(difference)) differences.push_back(difference);
      }
      if (!differences.empty())
        comparisons.push_back({name(i), name(0), figure, compare_pairs(std::move(differences))});
    }
  return comparisons;
}

std::string StudyResults::mixture() const {
  std::map<RunKind, std::size_t> kinds;
  for (const StudyRun& run : runs_)
    if (run.record) ++kinds[kind_of(*run.record)];
  if (kinds.size() < 2) return {};
  std::string text = "the runs are of different programs or machines, so that their last bits may differ:";
  for (const auto& [kind, count] : kinds)
    text += fmt::format("{} {} of shoal {}, {}, {}", text.ends_with(':') ? "" : ";", count,
                        kind.version.empty() ? "of unknown version" : kind.version,
                        kind.processor.empty() ? "unknown processor" : kind.processor,
                        kind.c_library.empty() ? "unknown C library" : kind.c_library);
  return text;
}

std::string comparisons_text(const std::vector<StudyComparison>& comparisons) {
  if (comparisons.empty()) return {};
  const auto name = [](const StudyComparison& each) { return each.compared + " minus " + each.base; };
  std::size_t widest_figure = 6, widest_name = 10;
  for (const StudyComparison& each : comparisons) {
    widest_figure = std::max(widest_figure, each.figure.size());
    widest_name = std::max(widest_name, name(each).size());
  }
  const auto line = [&](const std::string& figure, const std::string& difference, const auto&... cells) {
    std::string text = fmt::format("{:<{}}  {:<{}}", figure, widest_figure, difference, widest_name);
    ((text += fmt::format(" {:>10}", cells)), ...);
    return text + "\n";
  };
  std::string text = "differences in pairs of equal seeds\n" +
                     line("figure", "difference", "pairs", "mean", "mean 95 %", "", "median", "sign p", "Wilcoxon p");
  for (const StudyComparison& each : comparisons) {
    const PairedComparison& d = each.difference;
    text +=
        line(each.figure, name(each), fmt::format("{}", d.pairs), short_number(d.mean), short_number(d.mean_95.low),
             short_number(d.mean_95.high), short_number(d.median), short_number(d.sign_p), short_number(d.wilcoxon_p));
  }
  return text;
}

std::string failed_text(const StudyResults& results, const std::string& directory) {
  std::string text;
  std::size_t listed = 0;
  for (const StudyRun& run : results.runs()) {
    if (run.record) continue;
    if (++listed > max_failed_in_text) {
      text += "  ... and others: study.json has all\n";
      break;
    }
    text += fmt::format("  run {}, seed {}: {}\n", run.index, run.seed, run.failure);
    if (!directory.empty()) text += fmt::format("    shoal study run {} --index {}\n", directory, run.index);
    text += "    " + command_of(results.study(), run) + "\n";
  }
  return text;
}

}  // namespace experiment
