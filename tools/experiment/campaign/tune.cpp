// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/campaign/tune.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "tools/experiment/optimise/cma_es.hpp"
#include "tools/experiment/process/signals.hpp"
#include "tools/experiment/study/run_files.hpp"
#include "tools/experiment/study/study_results.hpp"
#include "tools/experiment/study/study_tables.hpp"

namespace tools {

Tuning::Tuning(LoadedStudy study, TuneOptions options) : study_(std::move(study)), options_(std::move(options)) {
  const sim::SourcePlace place{sim::intern_file_name(study_.config.file), 0, 0};
  if (study_.config.factors.empty()) sim::throw_config_error(place, "", "to be tuned, a study needs 'factors'");
  for (const StudyFactor& factor : study_.config.factors)
    if (!factor.from)
      sim::throw_config_error(factor.place, "factor '" + factor.name + "'", "to be tuned, it needs 'from' and 'to'");
  study_.points.clear();
}

double Tuning::value_of(std::size_t point, const std::vector<StudyRun>& runs) const {
  std::vector<double> values;
  for (const StudyRun& run : runs)
    if (run.point == point) values.push_back(figure_of(run, options_.figure));
  if (std::any_of(values.begin(), values.end(), [](double value) { return !std::isfinite(value); })) return no_figure;
  return statistics_of(values).by_word(options_.statistic);
}

void Tuning::run(const std::function<void(int generation)>& after) {
  const std::vector<StudyFactor>& factors = study_.config.factors;
  CmaEs search(Point(factors.size(), 0.5), CmaEs::Options{.population = options_.population,
                                                          .sigma = options_.sigma,
                                                          .seed = static_cast<std::uint64_t>(options_.seed)});
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
    run_study(study_, options_.study, runs);
    if (caught_signal() != 0) return;
    // Their values.
    std::vector<double> values;
    for (std::size_t point = first; point < study_.points.size(); ++point) {
      values.push_back(value_of(point, runs));
      tried_.push_back({generation, point, values.back()});
    }
    if (best() == nullptr)
      throw std::runtime_error(fmt::format("no point of generation {} has a value{}", generation,
                                           runs.front().record ? "" : "; the first run: " + runs.front().failure));
    search.learn(ranked_values(values, options_.maximise));
    after(generation);
  }
}

const TunedPoint* Tuning::best() const {
  const TunedPoint* best = nullptr;
  for (const TunedPoint& each : tried_)
    if (std::isfinite(each.value) && (best == nullptr || better(each.value, best->value))) best = &each;
  return best;
}

std::string Tuning::to_csv() const {
  std::string text = "generation,point";
  for (const StudyFactor& factor : study_.config.factors) text += "," + factor.name;
  text += "," + options_.figure + "\n";
  for (const TunedPoint& each : tried_) {
    text += fmt::format("{},{}", each.generation, each.point + 1);
    for (const std::string& value : study_.points[each.point].values) text += "," + csv_field(value);
    text += "," + (std::isfinite(each.value) ? fmt::format("{}", each.value) : "") + "\n";
  }
  return text;
}

std::string Tuning::command(const TunedPoint& point) const {
  StudyRun run;
  run.point = point.point;
  run.seed = study_.config.seeds.front();
  return command_of(study_, run);
}

std::vector<double> ranked_values(const std::vector<double>& values, bool maximise) {
  std::vector<double> ranked;
  double min = 0;
  bool any = false;
  for (const double value : values) {
    ranked.push_back(maximise ? value : -value);
    if (!std::isfinite(value)) continue;
    min = any ? std::min(min, ranked.back()) : ranked.back();
    any = true;
  }
  for (double& value : ranked)
    if (!std::isfinite(value)) value = min - std::max(1.0, std::fabs(min));
  return ranked;
}

}  // namespace tools
