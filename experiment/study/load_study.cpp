// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/load_study.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "experiment/process/world_programs.hpp"
#include "experiment/study/study_algorithms.hpp"
#include "experiment/study/study_rules.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/base/number.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"
#include "sim/random/random.hpp"
#include "sim/world_file/file_kind.hpp"
#include "sim/world_file/metric_config.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;

/// Adds the algorithms of the command line.
void add_algorithms(StudyConfig& config, const std::vector<std::string>& added) {
  for (const std::string& algorithm : added) {
    const std::string label = algorithm_label(algorithm);
    const std::string shown = "'" + sim::shortened(sim::printable(algorithm)) + "'";
    if (!is_algorithm_label(label)) throw std::invalid_argument("must be a name or python:FILE.Class, got " + shown);
    for (const std::string& other : config.algorithms)
      if (algorithm_label(other) == label) throw std::invalid_argument("two algorithms have the name '" + label + "'");
    config.algorithms.push_back(algorithm);
    config.added_algorithms.push_back(algorithm);
  }
  if (!added.empty() && !config.launch)
    throw std::invalid_argument("needs a study with 'launch: true': the programs of the world send what they receive");
  if (config.pairs.empty() && !config.algorithms.empty()) config.pairs = algorithm_label(config.algorithms.front());
}

/// Returns all figures of all cases, sorted.
std::vector<std::string> figures_of(const LoadedStudy& study) {
  std::set<std::string> names{"passed"};
  for (const sim::LoadedWorld& world : study.worlds)
    for (const sim::MetricConfig& metric : world.config.metrics)
      for (const std::string& figure : metric.figures()) names.insert(figure);
  for (std::string& figure : figures_of_algorithms(study.config.algorithms)) names.insert(std::move(figure));
  return {names.begin(), names.end()};
}

std::vector<std::string> error_metrics_of(const LoadedStudy& study) {
  std::set<std::string> names;
  for (const sim::LoadedWorld& world : study.worlds)
    for (const sim::MetricConfig& metric : world.config.metrics)
      if (metric.kind->find("samples") != nullptr) names.insert(metric.name);
  return {names.begin(), names.end()};
}

/// Checks names of figures and metrics, which are known only with the worlds.
class NameCheck {
 public:
  explicit NameCheck(const LoadedStudy& study)
      : study_(study), figures_(figures_of(study)), metrics_(error_metrics_of(study)) {}

  void check() {
    const StudyConfig& config = study_.config;
    if (config.until) require("until", config.until->figure, figures_, config.until->place, "");
    for (const std::string& figure : config.figures) require("figures", figure, figures_, config.figures_place, "");
    for (const StudyPlot& plot : config.plots) {
      const std::string who = "plot '" + plot.name + "'";
      if (!plot.figure.empty()) require("figure", plot.figure, figures_, plot.place, who);
      for (const std::string& metric : plot.metrics) require("metrics", metric, metrics_, plot.place, who);
    }
    sim::read_rule_list(config.rules,
                        StudyRuleNames(config.cases, study_.worlds, figures_of_algorithms(config.algorithms)),
                        diagnostics_);
    diagnostics_.throw_if_any();
  }

 private:
  void require(const char* key, const std::string& name, const std::vector<std::string>& known,
               const sim::SourcePlace& place, const std::string& who) {
    if (!std::binary_search(known.begin(), known.end(), name))
      diagnostics_.error(place, who,
                         "'" + std::string(key) + "' names nothing in this world: '" +
                             sim::shortened(sim::printable(name)) + "'; known: " + sim::list_text(known));
  }

  const LoadedStudy& study_;
  std::vector<std::string> figures_, metrics_;
  sim::Diagnostics diagnostics_;
};

/// Names of the YAML files in the folder of a file.
std::vector<std::string> files_beside(const std::string& file) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(file).parent_path() / ".", error))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Checks that the world is in the study's folder or the one above, because errors quote its text.
void check_world_file(const std::string& world, const std::string& study, const sim::SourcePlace& place,
                      const sim::LoadOptions& load) {
  const fs::path folder = fs::path(study).parent_path();
  std::vector<std::string> folders{folder.string(), (folder / "..").string()};
  if (!sim::shipped_folder().empty()) folders.push_back(sim::shipped_folder() + "/worlds");
  const sim::FileAccess access(std::move(folders), load.allow_paths, {});
  if (load.only_own_files && !access.may_read(world))
    sim::throw_config_error(place, "",
                            "'world' must lie below the folder of the study or the one above it, be a shipped one, or "
                            "lie below a folder given with --allow-path");
  std::error_code error;
  if (!fs::exists(world, error))
    sim::throw_config_error(place, "",
                            "'world': there is no file '" + sim::shortened(sim::printable(world)) + "'" +
                                sim::did_you_mean(fs::path(world).filename().string(), files_beside(world)));
  if (const std::string other = sim::other_kind(world, sim::FileKind::world); !other.empty())
    sim::throw_config_error(place, "", "'world': '" + sim::shortened(sim::printable(world)) + "' is " + other);
}

/// The file of `world:`, relative to the study; another bare name may be that of a shipped world.
std::string world_file_of(const std::string& study_file, const std::string& world) {
  const fs::path beside = fs::path(study_file).parent_path() / world;
  std::error_code error;
  if (!fs::exists(beside, error) && world.find('/') == std::string::npos && !sim::shipped_folder().empty()) {
    fs::path shipped = fs::path(sim::shipped_folder()) / "worlds" / world;
    if (shipped.extension() != ".yaml") shipped += ".yaml";
    if (fs::exists(shipped, error)) return shipped.lexically_normal().string();
  }
  return beside.lexically_normal().string();
}

/// Loads the world of a case.  Errors in a value of `set:` name its place in the study.
sim::LoadedWorld world_of_case(const StudyCase& in_case, sim::LoadOptions options) {
  const std::vector<std::string> sets = in_case.sets();
  options.study_sets.insert(options.study_sets.end(), sets.begin(), sets.end());
  try {
    return sim::load_world(in_case.world, options);
  } catch (const sim::ConfigError& error) {
    std::vector<std::string> lines = error.lines();
    for (std::string& line : lines)
      for (std::size_t i = 0; i < sets.size(); ++i) {
        const std::string place = sim::printable("--set " + sets[i]);
        if (!line.starts_with(place + ":")) continue;
        // The text of the option may be followed by a line and a column in it.
        const std::size_t rest = line.find_first_not_of("0123456789:", place.size());
        const sim::ConfigNode::Entry& entry = in_case.changes.entries[i];
        line = entry.value.place.text() + ": case '" + in_case.name + "': '" + sim::printable(entry.key) +
               "':" + (rest == std::string::npos ? "" : line.substr(rest));
        break;
      }
    throw sim::ConfigError(std::move(lines));
  }
}

/// Most numbers of a factor that are checked before the first run.
constexpr std::size_t max_checked_values = 8;

bool is_number(const std::string& value) {
  return sim::exact_number<double>(value).has_value();
}

/// First and last value of a factor and those between up to a number; texts, which may be names of files, all.
std::vector<std::string> checked_values(const StudyFactor& factor) {
  if (factor.values.empty()) return {factor.value_at(0), factor.value_at(1)};
  if (factor.values.size() <= max_checked_values || !std::all_of(factor.values.begin(), factor.values.end(), is_number))
    return factor.values;
  std::vector<std::string> values(factor.values.begin(), factor.values.begin() + max_checked_values);
  values.push_back(factor.values.back());
  return values;
}

/// Loads each world with some values of each factor.  Errors name the factor.
void check_factors(const LoadedStudy& study, const sim::LoadOptions& load) {
  const StudyConfig& config = study.config;
  std::set<std::string> worlds;
  for (const StudyCase& in_case : config.cases) {
    if (!worlds.insert(in_case.world).second) continue;
    for (const StudyFactor& factor : config.factors)
      for (const std::string& value : checked_values(factor)) {
        sim::LoadOptions options = load;
        for (const std::string& set : in_case.sets()) options.study_sets.push_back(set);
        for (const std::string& path : factor.paths) options.study_sets.push_back(path + "=" + value);
        try {
          sim::load_world(in_case.world, options);
        } catch (const sim::ConfigError& error) {
          std::vector<std::string> lines = error.lines();
          for (std::string& line : lines) {
            const std::size_t at = line.find(": ");
            if (line.starts_with("--set ") && at != std::string::npos)
              line = factor.place.text() + ": factor '" + factor.name + "': value " +
                     sim::shortened(sim::printable(value)) + line.substr(at);
          }
          throw sim::ConfigError(std::move(lines));
        }
      }
  }
}

/// Checks that a grid has levels, and not too many points.
void check_grid(const StudyConfig& config) {
  if (config.factors.empty() || config.design.type != StudyDesign::Type::grid) return;
  std::size_t points = 1;
  for (const StudyFactor& factor : config.factors) {
    if (factor.grid_levels() == 0)
      sim::throw_config_error(factor.place, "factor '" + factor.name + "'", "a range in a grid needs 'levels'");
    points = std::min(points * factor.grid_levels(), max_points + 1);
  }
  if (points > max_points)
    sim::throw_config_error(config.factors.front().place, "",
                            "the grid of the factors must have at most " + std::to_string(max_points) + " points");
}

void check_size(const LoadedStudy& study, const sim::ConfigNode& root) {
  const std::size_t runs = study.config.cases.size() * study.points.size() * study.config.seeds.size();
  if (runs > max_study_runs)
    sim::throw_config_error(root.place, "",
                            "a study must have at most " + std::to_string(max_study_runs) + " runs, got " +
                                std::to_string(study.config.cases.size()) + " cases, " +
                                std::to_string(study.points.size()) + " points and " +
                                std::to_string(study.config.seeds.size()) + " seeds");
}

}  // namespace

LoadedStudy load_study(const std::string& path, const StudyChanges& changes) {
  LoadedStudy study;
  // Read the file.
  sim::Diagnostics diagnostics;
  const sim::ConfigNode root = sim::load_config_file(path, diagnostics);
  diagnostics.throw_if_any();
  sim::require_file_kind(root, sim::FileKind::study, {sim::intern_file_name(path), 0, 0});
  sim::ParamReader in(root, "", diagnostics);
  study.config.read(in);
  in.finish();
  diagnostics.throw_if_any();
  // Apply the settings of the command line.
  study.config.file = path;
  if (!changes.seeds.empty()) study.config.seeds = changes.seeds;
  if (changes.duration_s) study.config.duration_s = changes.duration_s;
  if (study.config.until) study.config.until->planned_seeds = study.config.seeds.size();
  add_algorithms(study.config, changes.algorithms);
  for (std::size_t i = 0; i < study.config.cases.size(); ++i) {
    std::string& world = study.config.cases[i].world;
    world = world_file_of(path, world);
    if (i == 0 || study.config.of_worlds)
      check_world_file(world, path, study.config.cases[i].world_place, changes.load);
  }
  if (!changes.tuned) {
    check_grid(study.config);
    study.points = design_points(study.config.design, study.config.factors);
    check_size(study, root);
  }
  // Load the world of each case.
  sim::Warnings warnings;
  if (const auto& until = study.config.until;
      until && until->batch < min_sure_batch && !changes.tuned && !changes.planned)
    (changes.load.warnings != nullptr ? *changes.load.warnings : warnings)
        .warn(until->place, "",
              "'batch' is " + std::to_string(until->batch) + ": 'until' may be met by chance after fewer than " +
                  std::to_string(min_sure_batch) + " seeds");
  for (const StudyCase& each : study.config.cases) {
    sim::LoadOptions options = changes.load;
    if (options.warnings == nullptr) options.warnings = &warnings;
    options.allow_plugins = study.config.launch && !changes.only_checked;
    options.serial_ports = study.config.launch;
    options.encode_message = shoal::encode_own_message;
    sim::LoadedWorld& world = study.worlds.emplace_back(world_of_case(each, options));
    if (!study.config.algorithms.empty())
      algorithm_scoring(world.config, study.config.algorithms, study.config.algorithms_place);
    read_programs(world, {study.config.launch, options.allow_paths});
    if (!study.config.duration_s && world.config.run.duration_s == 0)
      sim::throw_config_error(root.place, "case '" + each.name + "'",
                              "its world runs without end: the study needs a 'duration_s'");
  }
  for (const sim::LoadedWorld& world : study.worlds)
    study.world_hashes.push_back(fmt::format("{:016x}", sim::hash_text(sim::to_yaml(world.resolved))));
  // Check some values of the factors, without repeating the warnings.
  if (!study.config.factors.empty()) {
    sim::Warnings repeated;
    sim::LoadOptions options = changes.load;
    options.warnings = &repeated;
    options.serial_ports = study.config.launch;
    options.encode_message = shoal::encode_own_message;
    check_factors(study, options);
  }
  NameCheck(study).check();
  return study;
}

std::optional<SharedPort> find_shared_port(const LoadedStudy& study) {
  if (!study.config.launch) return std::nullopt;
  for (const sim::LoadedWorld& world : study.worlds)
    for (const sim::VehicleInstance& vehicle : world.config.vehicles)
      for (const sim::DeviceConfig& device : vehicle.config->devices) {
        const sim::ConfigNode* const serial = device.source ? device.source->find("serial") : nullptr;
        const sim::ConfigNode* const path = serial != nullptr ? serial->find("path") : nullptr;
        if (path == nullptr || path->scalar.find("{run}") != std::string::npos) continue;
        if (fs::path(path->scalar).is_relative()) continue;  // relative to the results of each run
        return SharedPort{path->place, "vehicle '" + vehicle.name + "': device '" + device.name + "'",
                          sim::channel_name(path->scalar, vehicle.name, device.name)};
      }
  return std::nullopt;
}

}  // namespace experiment
