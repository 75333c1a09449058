// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/run_metrics.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "sim/config/config_node.hpp"

namespace experiment {

namespace {

/// Splits `cooperative.rms_m` into metric and figure.  Names of metrics have no dot.
std::pair<std::string, std::string> parts_of(const std::string& name) {
  const auto dot = name.find('.');
  const bool whole = dot == std::string::npos || dot + 1 == name.size();
  return whole ? std::pair(name, std::string()) : std::pair(name.substr(0, dot), name.substr(dot + 1));
}

/// Orders figures as their kind does, unknown ones last.
void sort_figures(RunMetric& metric) {
  std::set<std::string> names;
  for (const RunMetric::Figure& figure : metric.figures) names.insert(figure.name);
  metric.kind = sim::MetricRegistry::instance().of_figures(names);
  if (metric.kind == nullptr) return;
  const auto& kinds = metric.kind->figures;
  for (RunMetric::Figure& figure : metric.figures) figure.kind = metric.kind->find(figure.name);
  std::sort(metric.figures.begin(), metric.figures.end(), [&](const RunMetric::Figure& a, const RunMetric::Figure& b) {
    return a.kind - kinds.data() < b.kind - kinds.data();
  });
}

std::string text_at(const sim::ConfigNode& map, const char* key) {
  const sim::ConfigNode* node = map.find(key);
  return node != nullptr ? node->scalar : "";
}

/// Reads the metrics in the world of the run.  The file is untrusted, and is only parsed.
void read_world(const std::string& path, std::vector<RunMetric>& metrics) {
  // Read the world of the run.
  sim::Diagnostics problems;
  sim::ConfigNode world;
  try {
    world = sim::parse_config_text(read_whole_file(path), path, problems);
  } catch (const std::runtime_error&) {
    return;
  }
  const sim::ConfigNode* entries = world.find("metrics");
  if (entries == nullptr) return;
  // Vehicle, channel and dimensions of each metric.
  std::map<std::string, std::size_t> places;
  for (const sim::ConfigNode& entry : entries->items) {
    const std::string name = text_at(entry, "name");
    if (!places.emplace(name, places.size()).second) continue;
    const auto metric =
        std::find_if(metrics.begin(), metrics.end(), [&](const RunMetric& each) { return each.name == name; });
    if (metric == metrics.end() || metric->kind == nullptr) continue;
    metric->vehicle = text_at(entry, "vehicle");
    metric->channel = text_at(entry, "channel");
    metric->dimensions = text_at(entry, "dimensions") == "3" ? 3 : 2;
  }
  // Order of the world.
  const auto place = [&](const RunMetric& metric) {
    const auto known = places.find(metric.name);
    return known == places.end() ? places.size() : known->second;
  };
  std::stable_sort(metrics.begin(), metrics.end(),
                   [&](const RunMetric& a, const RunMetric& b) { return place(a) < place(b); });
}

}  // namespace

std::optional<double> RunMetric::value(const std::string& figure) const {
  const auto found =
      std::find_if(figures.begin(), figures.end(), [&](const Figure& each) { return each.name == figure; });
  return found == figures.end() ? std::nullopt : found->value;
}

std::vector<RunMetric> metrics_of(const RunRecord& run) {
  std::vector<std::string> names;
  for (const auto& [name, value] : run.metrics) names.push_back(name);
  std::vector<RunMetric> metrics = metrics_named(names);
  for (RunMetric& metric : metrics)
    for (RunMetric::Figure& figure : metric.figures) {
      const std::optional<double>& value =
          run.metrics.at(figure.name.empty() ? metric.name : metric.name + "." + figure.name);
      // null in the file is a figure that there is no value for.
      if (value && std::isfinite(*value)) figure.value = value;
    }
  read_world(run.directory + "/world.yaml", metrics);
  return metrics;
}

std::vector<RunMetric> metrics_named(const std::vector<std::string>& figures) {
  std::map<std::string, RunMetric> by_name;
  for (const std::string& full : figures) {
    const auto [name, figure] = parts_of(full);
    RunMetric& metric = by_name[name];
    metric.name = name;
    metric.figures.push_back({figure, std::nullopt, nullptr});
  }
  std::vector<RunMetric> metrics;
  for (auto& [name, metric] : by_name) {
    sort_figures(metric);
    metrics.push_back(std::move(metric));
  }
  return metrics;
}

std::map<std::string, std::string> units_of(const std::vector<std::string>& figures) {
  std::map<std::string, std::string> units;
  for (const RunMetric& metric : metrics_named(figures))
    for (const RunMetric::Figure& figure : metric.figures)
      if (figure.kind != nullptr && figure.kind->unit != "1")
        units[metric.name + "." + figure.name] = figure.kind->unit;
  return units;
}

std::string figure_text(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return "none";
  const double size = std::abs(*value);
  const bool whole = size < 1e15 && std::round(*value) == *value;
  if (whole || (size >= 1000 && size < 1e15)) return fmt::format("{:.0f}", *value);
  return fmt::format("{:.4g}", *value);
}

std::string figure_with_unit(const RunMetric::Figure& figure) {
  const bool has_unit = figure.value && figure.kind != nullptr && figure.kind->unit != "1";
  return figure_text(figure.value) + (has_unit ? " " + figure.kind->unit : "");
}

}  // namespace experiment
