// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/campaign/tune.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include "experiment/files/csv.hpp"
#include "experiment/optimize/cma_es.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/study/run_files.hpp"
#include "experiment/study/study_results.hpp"
#include "experiment/study/study_rules.hpp"
#include "experiment/study/study_tables.hpp"

namespace experiment {

Tuning::Tuning(LoadedStudy study, TuneOptions options) : study_(std::move(study)), options_(std::move(options)) {
  const sim::SourcePlace place{sim::intern_file_name(study_.config.file), 0, 0};
  if (study_.config.factors.empty()) sim::throw_config_error(place, "", "to be tuned, a study needs 'factors'");
  for (const StudyFactor& factor : study_.config.factors)
    if (!factor.from)
      sim::throw_config_error(factor.place, "factor '" + factor.name + "'", "to be tuned, it needs 'from' and 'to'");
  study_.points.clear();
}

TunedPoint Tuning::point_of(int generation, std::size_t point, const std::vector<StudyRun>& runs) const {
  TunedPoint tuned{generation, point};
  std::vector<double> values;
  std::size_t passed = 0;
  for (const StudyRun& run : runs) {
    if (run.point != point) continue;
    ++tuned.runs;
    values.push_back(figure_of(run, options_.figure));
    if (!run.record) continue;
    tuned.failed += run.record->judgement == Judgement::failed;
    passed += run.record->judgement == Judgement::passed;
  }
  if (tuned.failed > 0) tuned.judgement = Judgement::failed;
  if (passed == tuned.runs) tuned.judgement = Judgement::passed;
  // A statistic over some of the seeds would compare points by different runs.
  const bool all = std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  tuned.value = all ? statistics_of(values).by_word(options_.statistic) : no_figure;
  return tuned;
}

void Tuning::run(const std::function<void(int generation)>& after) {
  const std::vector<StudyFactor>& factors = study_.config.factors;
  CmaEs search(Point(factors.size(), 0.5), CmaEs::Options{.population = options_.population,
                                                          .sigma = options_.sigma,
                                                          .seed = static_cast<std::uint64_t>(options_.seed)});
  StudyProgress progress{static_cast<std::size_t>(options_.generations) *
                         static_cast<std::size_t>(search.population()) * study_.config.cases.size() *
                         study_.config.seeds.size()};
  for (int generation = 1; generation <= options_.generations && caught_signal() == 0; ++generation) {
    // Points of the generation, and their runs.
    const std::size_t first = study_.points.size();
    for (const Point& shares : search.propose()) {
      StudyPoint& point = study_.points.emplace_back();
      for (std::size_t k = 0; k < factors.size(); ++k) point.values.push_back(factors[k].value_at(shares[k]));
    }
    std::vector<StudyRun> runs;
    for (std::size_t point = first; point < study_.points.size(); ++point)
      for (std::size_t in_case = 0; in_case < study_.config.cases.size(); ++in_case)
        for (const std::int64_t seed : study_.config.seeds)
          runs.push_back({runs.size() + 1, in_case, point, seed,
                          directory_of(study_, options_.study.output, in_case, point, seed)});
    std::vector<std::size_t> all(runs.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    run_study(study_, options_.study, runs, all, progress);
    if (caught_signal() != 0) return;
    // Values of these points.
    std::vector<TunedPoint> points;
    for (std::size_t point = first; point < study_.points.size(); ++point)
      points.push_back(point_of(generation, point, runs));
    tried_.insert(tried_.end(), points.begin(), points.end());
    if (best() == nullptr)
      throw std::runtime_error(fmt::format("no point of generation {} has a value{}", generation,
                                           runs.front().record ? "" : "; the first run: " + runs.front().failure));
    search.learn(ranked_values(points, options_.maximize));
    after(generation);
  }
}

bool Tuning::better(const TunedPoint& a, const TunedPoint& b) const {
  if (a.failed != b.failed) return a.failed < b.failed;
  return options_.maximize ? a.value > b.value : a.value < b.value;
}

const TunedPoint* Tuning::best() const {
  const TunedPoint* best = nullptr;
  for (const TunedPoint& each : tried_)
    if (std::isfinite(each.value) && (best == nullptr || better(each, *best))) best = &each;
  return best;
}

std::string Tuning::to_csv() const {
  std::string text = "generation,point";
  for (const StudyFactor& factor : study_.config.factors) text += "," + factor.name;
  // The figure may be `passed` itself, in the mean over the runs.
  const bool of_rules = options_.figure == passed_figure;
  text += "," + options_.figure + (of_rules ? "\n" : ",passed\n");
  for (const TunedPoint& each : tried_) {
    text += fmt::format("{},{}", each.generation, each.point + 1);
    for (const std::string& value : study_.points[each.point].values) text += "," + csv_field(value);
    text += "," + (std::isfinite(each.value) ? fmt::format("{}", each.value) : "");
    const auto passed = as_flag(each.judgement);
    if (!of_rules) text += passed ? *passed ? ",1" : ",0" : ",";
    text += "\n";
  }
  return text;
}

std::string Tuning::command(const TunedPoint& point) const {
  StudyRun run;
  run.point = point.point;
  run.seed = study_.config.seeds.front();
  return command_of(study_, run);
}

std::vector<double> ranked_values(const std::vector<TunedPoint>& points, bool maximize) {
  const auto value_of = [&](const TunedPoint& point) { return maximize ? point.value : -point.value; };
  std::map<std::size_t, std::vector<std::size_t>> by_failed;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(points[i].value)) by_failed[points[i].failed].push_back(i);
  std::vector<double> ranked(points.size(), no_figure);
  double min = 0;  // of all values so far
  bool any = false;
  const auto next_below = [&] { return min - std::max(1.0, std::fabs(min)); };
  for (const auto& [failed, indices] : by_failed) {
    double max = -std::numeric_limits<double>::infinity();
    for (const std::size_t i : indices) max = std::max(max, value_of(points[i]));
    const double lowered = any ? next_below() - max : 0;
    for (const std::size_t i : indices) {
      ranked[i] = value_of(points[i]) + lowered;
      min = any ? std::min(min, ranked[i]) : ranked[i];
      any = true;
    }
  }
  for (double& value : ranked)
    if (!std::isfinite(value)) value = next_below();
  return ranked;
}

}  // namespace experiment
