// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_algorithms.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>

#include "experiment/files/json_reader.hpp"
#include "experiment/study/study_runs.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace {

constexpr const char* metric_type = "bound";
constexpr std::string_view python_prefix = "python:";
constexpr double max_count = 1e12;

std::optional<double> number_in(const JsonReader& in, const char* key) {
  return in.at(key).is_null() ? std::nullopt : std::optional(in.number(key));
}

/// Returns a value that lies from 0 to `max`.
double checked(const JsonReader& in, const char* key, double value, double max) {
  if (!(value >= 0 && value <= max))
    throw std::runtime_error(fmt::format("{}: '{}' must be from 0 to {}, got {}", in.where(), key, max, value));
  return value;
}

/// Sums over the scored vehicles.
struct TeamSums {
  double squares = 0, bound_squares = 0, nees = 0, inside = 0, bytes = 0;
  double samples = 0;
  bool whole = true;  ///< every vehicle has an estimate
  bool bounded = true;

  void add(const JsonReader& vehicle, std::optional<double> bound) {
    const auto rms = number_in(vehicle, "rms_m"), mean = number_in(vehicle, "nees_mean"),
               share = number_in(vehicle, "inside_95_share");
    bytes += checked(vehicle, "bytes_per_h", vehicle.number("bytes_per_h"), max_count);
    const double count = checked(vehicle, "samples", vehicle.number("samples"), max_count);
    if (rms) checked(vehicle, "rms_m", *rms, std::numeric_limits<double>::max());
    if (mean) checked(vehicle, "nees_mean", *mean, std::numeric_limits<double>::max());
    if (share) checked(vehicle, "inside_95_share", *share, 1);
    // Without one vehicle the figure of the team would look better than it is.
    if (!rms || !mean || !share || !(count > 0)) {
      whole = false;
      return;
    }
    // Weighted by samples, so that the root of the sum is the rms of all estimates of the team.
    samples += count;
    squares += count * *rms * *rms;
    nees += count * *mean;
    inside += count * *share;
    if (bound)
      bound_squares += count * *bound * *bound;
    else
      bounded = false;
  }

  std::map<std::string, std::optional<double>> figures(std::size_t vehicles) const {
    std::map<std::string, std::optional<double>> values;
    for (const AlgorithmFigure& figure : algorithm_figures()) values[figure.name] = std::nullopt;
    values["bytes_per_h"] = bytes / static_cast<double>(vehicles);
    if (!whole) return values;
    values["rms_m"] = std::sqrt(squares / samples);
    values["nees_mean"] = nees / samples;
    values["inside_95_share"] = inside / samples;
    if (bounded && bound_squares > 0) values["ratio"] = std::sqrt(squares / bound_squares);
    return values;
  }
};

}  // namespace

const std::vector<AlgorithmFigure>& algorithm_figures() {
  static const std::vector<AlgorithmFigure> figures{
      {"rms_m", "m", "rms of the horizontal error"},
      {"nees_mean", "1", "mean of the normalized error squared; 2 is consistent"},
      {"inside_95_share", "1", "share of the estimates whose 95 % ellipse contains the truth"},
      {"ratio", "1", "rms over that of the bound"},
      {"bytes_per_h", "B/h", "payload that a vehicle sent"},
      {time_of_event, "us", "CPU time of algorithm and driver for each report, packet and frame"}};
  return figures;
}

std::string algorithm_label(const std::string& algorithm) {
  if (!algorithm.starts_with(python_prefix)) return algorithm;
  const std::size_t dot = algorithm.find_last_of('.');
  return dot == std::string::npos ? algorithm : algorithm.substr(dot + 1);
}

bool is_algorithm_label(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  });
}

std::string source_of(const std::string& algorithm) {
  const std::size_t dot = algorithm.find_last_of('.');
  if (!algorithm.starts_with(python_prefix) || dot == std::string::npos) return {};
  try {
    return read_whole_file(algorithm.substr(python_prefix.size(), dot - python_prefix.size()) + ".py");
  } catch (const std::runtime_error&) {
    return {};  // shoal-nav reports it
  }
}

std::vector<std::string> figures_of_algorithms(const std::vector<std::string>& algorithms) {
  std::vector<std::string> names;
  for (const std::string& algorithm : algorithms)
    for (const AlgorithmFigure& figure : algorithm_figures())
      names.push_back(algorithm_label(algorithm) + "." + figure.name);
  return names;
}

AlgorithmScoring algorithm_scoring(const sim::WorldConfig& world, const std::vector<std::string>& algorithms,
                                   const sim::SourcePlace& place) {
  const std::string who = "world '" + world.name + "'";
  AlgorithmScoring scoring;
  std::vector<const sim::MetricConfig*> bounds;
  for (const sim::MetricConfig& metric : world.metrics) {
    for (const std::string& algorithm : algorithms)
      if (metric.name == algorithm_label(algorithm))
        sim::throw_config_error(metric.place, who,
                                "metric '" + metric.name + "' has the name of an algorithm of the study");
    if (metric.kind->word != metric_type) continue;
    // A world that includes another one may have its own metric for the same vehicle.
    std::erase_if(bounds, [&](const auto* other) { return other->params->vehicle == metric.params->vehicle; });
    bounds.push_back(&metric);
  }
  for (const sim::MetricConfig* bound : bounds) {
    if (scoring.vehicles.empty()) scoring.from_s = bound->params->from_s;
    if (bound->params->from_s != scoring.from_s)
      sim::throw_config_error(bound->place, who,
                              "metrics of type 'bound' must have equal 'from_s' for a study with algorithms, got " +
                                  sim::number_text(bound->params->from_s) + " and " + sim::number_text(scoring.from_s));
    scoring.vehicles.push_back({bound->params->vehicle, bound->name});
  }
  if (scoring.vehicles.empty())
    sim::throw_config_error(
        place, "", "'algorithms' need a metric of type 'bound' for each vehicle that is scored; " + who + " has none");
  return scoring;
}

std::string algorithm_program() {
  return sim::program_folder() + "/shoal-nav";
}

std::string record_of(const StudyRun& run) {
  return run.directory + "/algorithms.lcm";
}

std::string algorithm_scores_of(const StudyRun& run) {
  return run.directory + "/algorithms.json";
}

std::vector<std::string> arguments_of_algorithms(const LoadedStudy& study, const StudyRun& run) {
  const StudyConfig& config = study.config;
  const AlgorithmScoring scoring =
      algorithm_scoring(study.worlds[run.in_case].config, config.algorithms, config.algorithms_place);
  std::string names;
  for (const std::string& algorithm : config.algorithms) names += (names.empty() ? "" : ",") + algorithm;
  // A separate process: an estimator that crashes fails its run, not the study.
  return {"shoal-nav",
          "--log",
          record_of(run),
          "--algorithm",
          names,
          "--from-s",
          sim::number_text(scoring.from_s),
          "--scores",
          algorithm_scores_of(run)};
}

void add_algorithm_figures(const LoadedStudy& study, StudyRun& run) {
  const std::string path = algorithm_scores_of(run);
  const auto json = read_json_file(path);
  const JsonReader in(json, path);
  const std::vector<std::string>& algorithms = study.config.algorithms;
  const AlgorithmScoring scoring =
      algorithm_scoring(study.worlds[run.in_case].config, algorithms, study.config.algorithms_place);
  const auto& entries = in.list("algorithms");
  if (entries.size() != algorithms.size())
    throw std::runtime_error(
        fmt::format("{}: must have {} algorithms, got {}", path, algorithms.size(), entries.size()));
  for (std::size_t i = 0; i < algorithms.size(); ++i) {
    const JsonReader entry(entries.at(i), path + ": algorithms");
    if (entry.text("name") != algorithms[i])
      throw std::runtime_error(path + ": algorithm must be '" + algorithms[i] + "', got '" +
                               sim::shortened(sim::printable(entry.text("name"))) + "'");
    const std::string label = algorithm_label(algorithms[i]);
    // An algorithm that cannot navigate this world has no figures; the run itself is fine.
    if (entry.has("left_out")) {
      for (const AlgorithmFigure& figure : algorithm_figures())
        run.record->metrics[label + "." + figure.name] = std::nullopt;
      continue;
    }
    const JsonReader vehicles(entry.object("vehicles"), path + ": " + algorithms[i]);
    TeamSums sums;
    for (const ScoredVehicle& scored : scoring.vehicles) {
      const auto bound = run.record->metrics.find(scored.bound + ".rms_m");
      sums.add(JsonReader(vehicles.object(scored.vehicle.c_str()), vehicles.where() + ": " + scored.vehicle),
               bound == run.record->metrics.end() ? std::nullopt : bound->second);
    }
    for (const auto& [name, value] : sums.figures(scoring.vehicles.size()))
      run.record->metrics[label + "." + name] = value;
    run.record->metrics[label + "." + time_of_event] = entry.number(time_of_event);
  }
}

}  // namespace experiment
