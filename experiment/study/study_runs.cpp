// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_runs.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "bridges/base/child_program.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/run/version.hpp"
#include "experiment/study/run_files.hpp"
#include "experiment/study/study_algorithms.hpp"
#include "experiment/study/study_results.hpp"
#include "sim/random/random.hpp"

namespace experiment {

namespace {

/// Reads the results of a run.  Unset, with the reason: they do not exist, or the run did not reach its end.
void read_record(const LoadedStudy& study, StudyRun& run) {
  read_summary(run);
  if (!run.record || study.config.algorithms.empty()) return;
  try {
    add_algorithm_figures(study, run);
  } catch (const std::runtime_error& error) {
    run.record.reset();
    run.failure = error.what();
  }
}

/// Values of the figure of `until` by case and point, for the first seeds.
bool certain_after(const LoadedStudy& study, const std::vector<StudyRun>& runs,
                   const std::map<std::int64_t, std::size_t>& position, std::size_t seeds) {
  const StudyUntil& until = *study.config.until;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<double>> values;
  for (const StudyRun& run : runs)
    if (position.at(run.seed) < seeds) values[{run.in_case, run.point}].push_back(figure_of(run, until.figure));
  return std::all_of(values.begin(), values.end(), [&](const auto& each) { return is_certain(until, each.second); });
}

std::map<std::int64_t, std::size_t> positions_of(const std::vector<std::int64_t>& seeds) {
  std::map<std::int64_t, std::size_t> position;
  for (std::size_t i = 0; i < seeds.size(); ++i) position[seeds[i]] = i;
  return position;
}

}  // namespace

void read_summary(StudyRun& run) {
  run.record.reset();
  try {
    RunRecord record = read_run(run.directory);
    // 0 and 1 are results; other codes and runs ended by hand must be repeated.
    const bool done = record.exit_code == 0 || record.exit_code == 1;
    const bool by_hand = record.ended == "quit" || record.ended == "signal";
    if (done && !by_hand && record.ended != "process")
      run.record = std::move(record);
    else if (!record.error.empty())
      run.failure = record.error;
    else
      run.failure = by_hand ? record.not_judged : fmt::format("exit code {}", record.exit_code);
  } catch (const std::runtime_error& error) {
    run.failure = error.what();
  }
}

std::vector<StudyRun> plan_study(const LoadedStudy& study, const std::string& output) {
  std::vector<StudyRun> runs;
  runs.reserve(study.config.cases.size() * study.points.size() * study.config.seeds.size());
  for (std::size_t i = 0; i < study.config.cases.size(); ++i)
    for (std::size_t point = 0; point < study.points.size(); ++point)
      for (const std::int64_t seed : study.config.seeds)
        runs.push_back({runs.size() + 1, i, point, seed, directory_of(study, output, i, point, seed)});
  return runs;
}

std::string directory_of(const LoadedStudy& study, const std::string& output, std::size_t in_case, std::size_t point,
                         std::int64_t seed) {
  const std::string of_point = study.config.factors.empty() ? "" : fmt::format("/point_{}", point + 1);
  return fmt::format("{}/runs/{}{}/seed_{}", output, study.config.cases[in_case].name, of_point, seed);
}

std::vector<std::string> sets_of(const LoadedStudy& study, const StudyRun& run) {
  std::vector<std::string> sets = study.config.cases[run.in_case].sets();
  for (std::string& set : point_sets(study.config.factors, study.points[run.point])) sets.push_back(std::move(set));
  return sets;
}

std::string inputs_of(const LoadedStudy& study, const StudyRun& run) {
  const StudyConfig& config = study.config;
  std::string text = fmt::format("world {} seed {} duration {} launch {}", study.world_hashes[run.in_case], run.seed,
                                 config.duration_s ? fmt::format("{}", *config.duration_s) : "as the world says",
                                 config.launch ? "yes" : "no");
  // The settings of the case are part of the hash of its world.
  for (const std::string& set : point_sets(config.factors, study.points[run.point])) text += "\nset " + set;
  for (const std::string& algorithm : config.algorithms)
    text += "\nalgorithm " + algorithm + " " + source_of(algorithm);
  return fmt::format("{:016x}", sim::hash_text(text));
}

std::string command_of(const LoadedStudy& study, const StudyRun& run) {
  const StudyConfig& config = study.config;
  std::string command =
      fmt::format("shoal run {} --seed {}", bridges::shell_word(config.cases[run.in_case].world), run.seed);
  for (const std::string& set : sets_of(study, run)) command += " --set " + bridges::shell_word(set);
  if (config.duration_s) command += fmt::format(" --duration {}", *config.duration_s);
  return command + (config.launch ? " --launch" : " --bus none --no-serial-ports");
}

void read_result(const LoadedStudy& study, bool any_version, StudyRun& run) {
  run.record.reset();
  run.failure = "it has not been run";
  run.tried = false;
  const std::string inputs = inputs_of(study, run);
  if (const auto stamp = read_stamp(run.directory)) {
    // The hash of the inputs decides, not the time of the file.
    if (stamp->inputs != inputs)
      run.failure = "its result belongs to other inputs: the study or its world has changed";
    else if (!any_version && stamp->version != short_version())
      run.failure = "its result is of shoal " + stamp->version;
    else
      return read_record(study, run);
  }
  const auto failure = read_failure(run.directory);
  if (!failure || failure->inputs != inputs) return;
  run.failure = failure->reason;
  run.tried = true;
}

void read_ended_run(const LoadedStudy& study, StudyRun& run) {
  read_record(study, run);
}

void run_in_batches(const LoadedStudy& study, std::vector<StudyRun>& runs,
                    const std::function<void(const std::vector<std::size_t>&)>& execute) {
  const std::size_t seeds = study.config.seeds.size();
  const std::size_t batch = study.config.until ? study.config.until->batch : seeds;
  const auto position = positions_of(study.config.seeds);
  for (std::size_t first = 0; first < seeds && caught_signal() == 0; first += batch) {
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::size_t at = position.at(runs[i].seed);
      if (at >= first && at < first + batch) which.push_back(i);
    }
    // Seeds in batches, all cases and points of each: they are compared in pairs of equal seeds.
    execute(which);
    if (study.config.until && certain_after(study, runs, position, std::min(first + batch, seeds))) return;
  }
}

std::size_t seeds_needed(const LoadedStudy& study, const std::vector<StudyRun>& runs) {
  const std::size_t seeds = study.config.seeds.size();
  if (!study.config.until) return seeds;
  const auto position = positions_of(study.config.seeds);
  const std::size_t batch = study.config.until->batch;
  for (std::size_t count = batch; count < seeds; count += batch)
    if (certain_after(study, runs, position, count)) return count;
  return seeds;
}

bool until_holds(const LoadedStudy& study, const std::vector<StudyRun>& runs) {
  return study.config.until && certain_after(study, runs, positions_of(study.config.seeds), study.config.seeds.size());
}

std::string until_text(const LoadedStudy& study, const std::vector<StudyRun>& runs) {
  if (!study.config.until) return {};
  const StudyUntil& until = *study.config.until;
  const std::size_t used = study.config.seeds.size();
  const std::string seeds = used < until.planned_seeds ? fmt::format("{} of {} seeds", used, until.planned_seeds)
                                                       : fmt::format("all {} seeds", used);
  const bool holds = until_holds(study, runs);
  std::string text = fmt::format("until: {} {} after {}", until.text, holds ? "holds" : "does not hold", seeds);
  if (used < until.planned_seeds) text += "; runs of the others are not used";
  // With few seeds an interval is small by chance from time to time, and the study stops just then.
  if (holds && used < min_sure_batch)
    text += fmt::format("; with fewer than {} seeds this may be chance", min_sure_batch);
  return text;
}

void drop_needless_seeds(LoadedStudy& study, std::vector<StudyRun>& runs) {
  const std::size_t needed = seeds_needed(study, runs);
  const auto position = positions_of(study.config.seeds);
  std::erase_if(runs, [&](const StudyRun& run) { return position.at(run.seed) >= needed; });
  study.config.seeds.resize(needed);
}

}  // namespace experiment
