// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_results.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "bridges/base/json_text.hpp"
#include "experiment/files/csv.hpp"
#include "experiment/results/summary_file.hpp"
#include "experiment/run/version.hpp"
#include "experiment/study/algorithm_table.hpp"
#include "experiment/study/study_rules.hpp"
#include "experiment/study/study_tables.hpp"

namespace experiment {

namespace {

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

}  // namespace

double Statistics::by_word(const std::string& word) const {
  if (word == "mean") return mean;
  if (word == "std") return std;
  if (word == "min") return min;
  return word == "max" ? max : median;
}

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

Statistics statistics_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  Statistics statistics;
  statistics.count = static_cast<std::int64_t>(values.size());
  if (values.empty()) return statistics;
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  statistics.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - statistics.mean) * (value - statistics.mean);
  if (values.size() > 1) {
    statistics.std = std::sqrt(squares / (count - 1));
    statistics.mean_95 = mean_interval_95(statistics.mean, statistics.std, values.size());
  }
  statistics.min = values.front();
  statistics.max = values.back();
  statistics.median = quantile(values, 0.5);
  statistics.median_95 = median_interval_95(values);
  return statistics;
}

Statistics statistics_of_figure(const std::string& figure, const std::vector<double>& values) {
  Statistics statistics = statistics_of(values);
  if (figure == passed_figure && statistics.count > 0) {
    const auto count = static_cast<std::size_t>(statistics.count);
    const auto hits = static_cast<std::size_t>(std::llround(statistics.mean * static_cast<double>(count)));
    statistics.mean_95 = share_interval_95(hits, count);
  }
  return statistics;
}

double figure_of(const StudyRun& run, const std::string& figure) {
  if (!run.record) return no_figure;
  if (figure == passed_figure) {
    const auto flag = as_flag(run.record->judgement);
    return !flag ? no_figure : *flag ? 1 : 0;
  }
  const auto found = run.record->metrics.find(figure);
  return found == run.record->metrics.end() ? no_figure : found->second.value_or(no_figure);
}

StudyResults::StudyResults(const LoadedStudy& study, const std::vector<StudyRun>& runs) : study_(study), runs_(runs) {
  std::set<std::string> names;
  for (const StudyRun& run : runs)
    if (run.record)
      for (const auto& [name, value] : run.record->metrics) names.insert(name);
  figures_.assign(names.begin(), names.end());
  for (const StudyRun& run : runs) groups_[{run.in_case, run.point}].push_back(&run);
}

std::vector<double> StudyResults::values(const std::string& in_case, const std::string& figure) const {
  std::vector<double> values;
  for (const StudyRun& run : runs_)
    if (run.record && study_.config.cases[run.in_case].name == in_case) values.push_back(figure_of(run, figure));
  return values;
}

Statistics StudyResults::of(const std::string& in_case, const std::string& figure) const {
  Statistics statistics = statistics_of_figure(figure, values(in_case, figure));
  if (study_.points.size() == 1) return statistics;
  // Runs of one seed at several points are not independent: the interval is that of the means of the seeds.
  std::map<std::int64_t, std::vector<double>> by_seed;
  for (const StudyRun& run : runs_)
    if (study_.config.cases[run.in_case].name == in_case) by_seed[run.seed].push_back(figure_of(run, figure));
  std::vector<double> means;
  for (const auto& [seed, of_seed] : by_seed) means.push_back(statistics_of(of_seed).mean);
  statistics.mean_95 = statistics_of(means).mean_95;
  statistics.median_95 = {no_figure, no_figure};
  return statistics;
}

Statistics StudyResults::at_point(std::size_t in_case, std::size_t point, const std::string& figure) const {
  std::vector<double> values;
  const auto found = groups_.find({in_case, point});
  if (found != groups_.end())
    for (const StudyRun* run : found->second) values.push_back(figure_of(*run, figure));
  return statistics_of_figure(figure, values);
}

std::vector<std::string> StudyResults::table_figures() const {
  if (!study_.config.figures.empty()) return study_.config.figures;
  std::vector<std::string> figures{passed_figure};
  figures.insert(figures.end(), figures_.begin(), figures_.end());
  return figures;
}

std::size_t StudyResults::runs_of(const std::string& in_case) const {
  return static_cast<std::size_t>(std::count_if(runs_.begin(), runs_.end(), [&](const StudyRun& run) {
    return study_.config.cases[run.in_case].name == in_case;
  }));
}

FigureValue StudyResults::value_of(const sim::RuleExpression::Figure& figure) const {
  const auto [in_case, name] = case_and_figure(figure.name);
  const Statistics statistics = of(in_case, name);
  const std::size_t runs = runs_of(in_case);
  const std::size_t lacking = runs - static_cast<std::size_t>(statistics.count);
  // A figure that is missing in some of the runs has no statistic.
  if (lacking > 0)
    return {no_figure, fmt::format("{} of {} runs {} no such figure", lacking, runs, lacking == 1 ? "has" : "have")};
  const double value = statistics.by_word(figure.function);
  return {value, std::isnan(value) ? figure.function + " needs two runs" : ""};
}

std::vector<Scoring::Verdict> StudyResults::verdicts() const {
  std::vector<Scoring::Verdict> verdicts;
  for (const sim::RuleExpression& rule : study_.config.pass)
    verdicts.push_back(judge_rule(rule, [this](const auto& figure) { return value_of(figure); }));
  if (!verdicts.empty() && runs_with_failed_programs() > 0)
    verdicts.push_back(
        {fmt::format("{} of {} runs had programs that failed", runs_with_failed_programs(), runs_.size()), false});
  return verdicts;
}

std::size_t StudyResults::failed_runs() const {
  return static_cast<std::size_t>(
      std::count_if(runs_.begin(), runs_.end(), [](const StudyRun& run) { return !run.record; }));
}

std::size_t StudyResults::runs_with_failed_programs() const {
  return static_cast<std::size_t>(std::count_if(runs_.begin(), runs_.end(), [](const StudyRun& run) {
    return run.record && std::any_of(run.record->processes.begin(), run.record->processes.end(),
                                     [](const RunRecord::Process& process) { return process.failed; });
  }));
}

Judgement StudyResults::judgement() const {
  const auto all = verdicts();
  const bool hold = std::all_of(all.begin(), all.end(), [](const auto& verdict) { return verdict.passed; });
  if (failed_runs() > 0 || !hold) return Judgement::failed;
  return all.empty() ? Judgement::not_judged : Judgement::passed;
}

const AlgorithmTable& StudyResults::algorithm_table() const {
  if (!algorithm_table_) algorithm_table_ = std::make_shared<const AlgorithmTable>(*this);
  return *algorithm_table_;
}

std::string StudyResults::to_text(const std::string& directory) const {
  const StudyConfig& config = study_.config;
  std::size_t widest_figure = 6, widest_case = 4;
  for (const std::string& figure : table_figures()) widest_figure = std::max(widest_figure, figure.size());
  for (const StudyCase& each : config.cases) widest_case = std::max(widest_case, each.name.size());
  const auto line = [&](const std::string& figure, const std::string& in_case, const auto&... cells) {
    std::string text = fmt::format("{:<{}}  {:<{}}", figure, widest_figure, in_case, widest_case);
    ((text += fmt::format(" {:>10}", cells)), ...);
    return text + "\n";
  };
  std::string text = fmt::format("study {}: {} runs of {}\n", config.name, runs_.size(), config.world_text());
  text += line("figure", "case", "runs", "mean", "std", "min", "max", "median", "mean 95 %", "");
  for (const std::string& figure : table_figures())
    for (const StudyCase& each : config.cases) {
      const Statistics s = of(each.name, figure);
      // A mean over the runs with the figure is not representative of the others.
      const std::size_t runs = runs_of(each.name);
      const bool all = static_cast<std::size_t>(s.count) == runs;
      text += line(figure, each.name, all ? fmt::format("{}", runs) : fmt::format("{}/{}", s.count, runs),
                   number(s.mean), number(s.std), number(s.min), number(s.max), number(s.median), number(s.mean_95.low),
                   number(s.mean_95.high));
    }
  text += points_text();
  if (!config.algorithms.empty()) text += algorithm_table().text();
  for (const Scoring::Verdict& verdict : verdicts())
    text += fmt::format("{}: {}\n", verdict.passed ? "passed" : "FAILED", verdict.text());
  if (config.pass.empty() && runs_with_failed_programs() > 0)
    text += fmt::format("{} of {} runs had programs that failed\n", runs_with_failed_programs(), runs_.size());
  for (const EqualCases& group : equal_cases(study_, runs_)) text += "note: " + equal_cases_text(group) + "\n";
  if (const std::string text_of_kinds = mixture(); !text_of_kinds.empty()) text += "note: " + text_of_kinds + "\n";
  text += comparisons_text(comparisons());
  if (failed_runs() > 0) text += fmt::format("{} runs have no result\n", failed_runs()) + failed_text(*this, directory);
  if (const std::string until = until_text(study_, runs_); !until.empty()) text += until + "\n";
  if (judgement() == Judgement::not_judged) text += "not judged: the study has no rules\n";
  return text;
}

/// Means at each point of a small design.
std::string StudyResults::points_text() const {
  constexpr std::size_t max_shown = 20;
  const std::vector<StudyPoint>& points = study_.points;
  if (points.size() == 1) return "";
  if (points.size() > max_shown) return "points.csv has the statistics of each point\n";
  std::string text;
  for (std::size_t point = 0; point < points.size(); ++point) {
    text += fmt::format("point {} ({}), mean:", point + 1, values_text(study_.config, points[point]));
    for (std::size_t in_case = 0; in_case < study_.config.cases.size(); ++in_case)
      for (const std::string& figure : table_figures())
        text += fmt::format(" {}{} {}", study_.config.cases.size() > 1 ? study_.config.cases[in_case].name + "." : "",
                            figure, number(at_point(in_case, point, figure).mean));
    text += "\n";
  }
  return text;
}

std::string StudyResults::to_csv() const {
  std::string text = "case,seed,exit_code,passed,ended,sim_time_s,wall_s,run_hash";
  for (const std::string& figure : figures_) text += "," + figure;
  text += ",run,point";
  for (const StudyFactor& factor : study_.config.factors) text += "," + factor.name;
  text += ",shoal,processor,c_library\n";
  // Columns of the plan, and of the program and machine.
  const auto last_columns = [&](const StudyRun& run) {
    std::string columns = fmt::format(",{},{}", run.index, study_.config.factors.empty() ? 0 : run.point + 1);
    for (const std::string& value : study_.points[run.point].values) columns += "," + csv_field(value);
    const RunKind kind = run.record ? kind_of(*run.record) : RunKind{};
    return columns + "," + csv_field(kind.version) + "," + csv_field(kind.processor) + "," + csv_field(kind.c_library) +
           "\n";
  };
  for (const StudyRun& run : runs_) {
    text += fmt::format("{},{}", study_.config.cases[run.in_case].name, run.seed);
    // Run without a result.
    if (!run.record) {
      text += ",,,failed,,," + std::string(figures_.size(), ',') + last_columns(run);
      continue;
    }
    // Outcome of the run.
    const RunRecord& record = *run.record;
    const auto passed = as_flag(record.judgement);
    text += fmt::format(",{},{},{},{},{:.3f},{}", record.exit_code,
                        !passed   ? ""
                        : *passed ? "1"
                                  : "0",
                        csv_field(record.ended), record.sim_time_s, record.wall_s, record.run_hash);
    // Figures of the run.
    for (const std::string& figure : figures_) {
      const auto found = record.metrics.find(figure);
      const bool known = found != record.metrics.end() && found->second;
      text += "," + (known ? fmt::format("{}", *found->second) : "");
    }
    text += last_columns(run);
  }
  return text;
}

std::string StudyResults::to_json(int exit_code) const {
  const StudyConfig& config = study_.config;
  nlohmann::ordered_json json;
  // Study.
  json["study"] = config.name;
  json["description"] = config.description;
  json["world"] = config.of_worlds ? config.world_text() : study_.worlds.front().config.name;
  json["seeds"] = config.seeds;
  json["launch"] = config.launch;
  json["figures"] = table_figures();
  // Cases and their statistics.
  json["cases"] = nlohmann::ordered_json::array();
  for (const StudyCase& each : config.cases) {
    nlohmann::ordered_json entry{{"name", each.name}, {"set", each.sets()}, {"figures", nlohmann::json::object()}};
    entry["figures"][passed_figure] = statistics_json(of(each.name, passed_figure));
    for (const std::string& figure : figures_) entry["figures"][figure] = statistics_json(of(each.name, figure));
    json["cases"].push_back(std::move(entry));
  }
  // Notes and failed runs.
  json["notes"] = nlohmann::ordered_json::array();
  for (const EqualCases& group : equal_cases(study_, runs_)) json["notes"].push_back(equal_cases_text(group));
  if (const std::string text = mixture(); !text.empty()) json["notes"].push_back(text);
  json["until"] = nullptr;
  if (config.until)
    json["until"] = {{"condition", config.until->text},
                     {"holds", until_holds(study_, runs_)},
                     {"seeds", config.seeds.size()},
                     {"planned_seeds", config.until->planned_seeds},
                     {"text", until_text(study_, runs_)}};
  json["failed_runs"] = nlohmann::ordered_json::array();
  for (const StudyRun& run : runs_)
    if (!run.record)
      json["failed_runs"].push_back({{"case", config.cases[run.in_case].name},
                                     {"seed", run.seed},
                                     {"why", run.failure},
                                     {"run", run.index},
                                     {"repeat", command_of(study_, run)}});
  // Points and comparisons.
  if (!config.algorithms.empty()) json["algorithms"] = algorithm_table().json();
  add_points(json, *this);
  add_convergence(json, *this);
  add_extremes(json, *this);
  json["comparisons"] = nlohmann::ordered_json::array();
  for (const StudyComparison& each : comparisons()) json["comparisons"].push_back(comparison_json(each));
  // Rules and verdict.
  json["runs"] = runs_.size();
  json["rules"] = nlohmann::ordered_json::array();
  for (const Scoring::Verdict& verdict : verdicts()) json["rules"].push_back(json_of(verdict));
  json["plots"] = study_plots(config);
  json["judged"] = judgement() != Judgement::not_judged;
  json["passed"] = nullptr;
  if (const auto flag = as_flag(judgement())) json["passed"] = *flag && exit_code == 0;
  json["exit_code"] = exit_code;
  json["shoal"] = short_version();
  return bridges::json_text(json, 2) + "\n";
}

}  // namespace experiment
