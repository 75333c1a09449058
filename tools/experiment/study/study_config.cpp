// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/study/study_config.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "messages/yaml/message_writer.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/shipped_files.hpp"
#include "sim/config/yaml_writer.hpp"
#include "sim/random/random.hpp"
#include "sim/world_file/file_kind.hpp"
#include "sim/world_file/rule_list.hpp"
#include "tools/experiment/process/world_programs.hpp"
#include "tools/experiment/study/study_algorithms.hpp"
#include "tools/experiment/study/study_rules.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_seeds = 100000;
constexpr double max_seed = 9007199254740992.0;  // 2^53

/// First seed and number of seeds.
struct SeedRange {
  std::int64_t first = 1;
  std::int64_t count = 0;
  void read(sim::ParamReader& in) {
    in.read("first", first, sim::between(0, max_seed), "the first seed");
    in.require("count");
    in.read("count", count, sim::between(1, static_cast<double>(max_seeds)), "how many");
  }
};

std::optional<std::int64_t> whole_seed(std::string_view text) {
  std::int64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  const bool good = error == std::errc{} && end == text.data() + text.size() && !text.empty() && text[0] != '-' &&
                    static_cast<double>(seed) <= max_seed;
  return good ? std::optional(seed) : std::nullopt;
}

/// Parses `1-10`.  Nothing for any other form.
std::optional<std::pair<std::int64_t, std::int64_t>> first_and_last(std::string_view text) {
  const std::size_t dash = text.find('-', 1);
  if (dash == std::string_view::npos) return std::nullopt;
  const auto trimmed = [](std::string_view part) {
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    return part;
  };
  const auto first = whole_seed(trimmed(text.substr(0, dash))), last = whole_seed(trimmed(text.substr(dash + 1)));
  return first && last ? std::optional(std::pair(*first, *last)) : std::nullopt;
}

/// Adds `7` or `1-10`.  Returns the error; empty: none.
std::string add_seeds(std::string_view text, std::vector<std::int64_t>& seeds) {
  const std::string got = ", got '" + sim::shortened(sim::printable(text)) + "'";
  if (const auto one = whole_seed(text)) {
    seeds.push_back(*one);
    return {};
  }
  const auto range = first_and_last(text);
  if (!range) return "must be whole numbers from 0 to 2^53 or ranges such as 1-10" + got;
  if (range->second < range->first) return "must be ranges from the lower to the higher seed" + got;
  if (range->second - range->first >= static_cast<std::int64_t>(max_seeds))
    return "must be at most " + std::to_string(max_seeds) + got;
  for (std::int64_t seed = range->first; seed <= range->second; ++seed) seeds.push_back(seed);
  return {};
}

bool differ_from_each_other(const std::vector<std::int64_t>& seeds) {
  return std::set<std::int64_t>(seeds.begin(), seeds.end()).size() == seeds.size();
}

/// Returns whether a text such as `1-10` is among the seeds, so that they are not a list of numbers.
bool has_range(const sim::ConfigNode& node) {
  if (node.kind == sim::ConfigNode::Kind::scalar) return first_and_last(node.scalar).has_value();
  return std::any_of(node.items.begin(), node.items.end(), has_range);
}

std::vector<std::int64_t> read_seed_ranges(sim::ParamReader& in, const sim::ConfigNode& node) {
  std::vector<std::int64_t> seeds;
  const auto add = [&](const sim::ConfigNode& item) {
    const std::string problem = item.kind == sim::ConfigNode::Kind::scalar
                                    ? add_seeds(item.scalar, seeds)
                                    : "must be whole numbers or ranges such as 1-10, got " + sim::shown(item);
    if (!problem.empty()) in.error("seeds", "'seeds' " + problem);
  };
  if (node.kind == sim::ConfigNode::Kind::scalar) add(node);
  for (const sim::ConfigNode& item : node.items) add(item);
  return seeds;
}

void describe_seeds(sim::ParamReader& in) {
  sim::ParamInfo info;
  info.key = "seeds";
  info.type = "list of numbers";
  info.rule = "whole numbers from 0 to 2^53";
  info.meaning = "seeds of the runs: [1, 2, 3], 1-10, [1-3, 8] or {first: 1, count: 10}";
  in.describe(std::move(info));
}

std::vector<std::int64_t> read_seeds(sim::ParamReader& in) {
  in.require("seeds");
  if (in.describing()) {
    describe_seeds(in);
    return {};
  }
  const sim::ConfigNode* node = in.child("seeds");
  std::vector<std::int64_t> seeds;
  // Range as a map.
  if (node != nullptr && node->kind == sim::ConfigNode::Kind::map) {
    SeedRange range;
    in.read("seeds", range, "seeds of the runs");
    for (std::int64_t i = 0; i < range.count; ++i) seeds.push_back(range.first + i);
    return seeds;
  }
  // Ranges as text.
  if (node != nullptr && has_range(*node)) {
    seeds = read_seed_ranges(in, *node);
    if (!differ_from_each_other(seeds)) in.error("seeds", "'seeds' must differ from each other");
    return seeds;
  }
  // List of numbers.
  std::vector<double> numbers;
  in.read("seeds", numbers, sim::between(0, max_seed), "seeds of the runs");
  for (const double number : numbers) {
    if (number != std::trunc(number))
      in.error("seeds", "'seeds' must be whole numbers, got " + sim::number_text(number));
    seeds.push_back(static_cast<std::int64_t>(number));
  }
  const bool nothing = node != nullptr && (node->kind == sim::ConfigNode::Kind::null ||
                                           (node->kind == sim::ConfigNode::Kind::list && node->items.empty()));
  if (nothing) in.error("seeds", "'seeds' must have at least one seed");
  if (!differ_from_each_other(seeds)) in.error("seeds", "'seeds' must differ from each other");
  return seeds;
}

/// Rejects a key without a value.
void require_something(sim::ParamReader& in, const char* key, bool empty) {
  if (in.has(key) && empty) in.error(key, "'" + std::string(key) + "' must not be empty");
}

bool is_label(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  });
}

/// Adds the algorithms of the command line.
void add_algorithms(StudyConfig& config, const std::vector<std::string>& added) {
  for (const std::string& algorithm : added) {
    const std::string label = algorithm_label(algorithm);
    const std::string shown = "'" + sim::shortened(sim::printable(algorithm)) + "'";
    if (!is_label(label)) throw std::invalid_argument("must be a name or python:FILE.Class, got " + shown);
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
                        study_rule_of_map, diagnostics_);
    diagnostics_.throw_if_any();
  }

 private:
  void require(const char* key, const std::string& name, const std::vector<std::string>& known,
               const sim::SourcePlace& place, const std::string& who) {
    if (!std::binary_search(known.begin(), known.end(), name))
      diagnostics_.error(place, who,
                         "'" + std::string(key) + "' names nothing of this world: '" +
                             sim::shortened(sim::printable(name)) + "'; known: " + sim::list_text(known));
  }

  const LoadedStudy& study_;
  std::vector<std::string> figures_, metrics_;
  sim::Diagnostics diagnostics_;
};

}  // namespace

void StudyCase::read(sim::ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "name of the case");
  in.read("world", world, "world file of this case; unset: that of the study");
  if (const sim::ConfigNode* node = in.describing() ? nullptr : in.child("world")) world_place = node->place;
  in.read_raw("set", changes, "dotted path: value, as with --set");
}

std::vector<std::string> StudyCase::sets() const {
  std::vector<std::string> texts;
  for (const auto& entry : changes.entries) texts.push_back(entry.key + "=" + sim::to_flow_yaml(entry.value));
  return texts;
}

void StudyPlot::read(sim::ParamReader& in) {
  if (in.node() != nullptr) place = in.node()->place;
  in.require("name");
  in.read_name("name", name, "name of the plot, NAME.png");
  in.read("figure", figure, "figure that is drawn for each case");
  in.read("metrics", metrics, "metrics whose errors are drawn, instead of `figure`");
  in.read_references("cases", cases, "case", "those that are drawn; unset: all");
  in.read_choice("over", over, {{"cases", Over::cases}, {"distance", Over::distance}, {"time", Over::time}},
                 "what errors are drawn over: distance travelled or time");
  if (in.describing()) return;
  require_something(in, "figure", figure.empty());
  require_something(in, "metrics", metrics.empty());
  if (in.has("figure") == in.has("metrics"))
    in.error(in.has("figure") ? "needs either 'figure' or 'metrics', not both" : "needs either 'figure' or 'metrics'");
  else if (in.has("metrics") == (over == Over::cases))
    in.error("over",
             in.has("metrics") ? "'metrics' are drawn over 'distance' or 'time'" : "a 'figure' is drawn over 'cases'");
}

void StudyConfig::read(sim::ParamReader& in) {
  // Version and name.
  int version = 1;
  in.require("shoal");
  in.read("shoal", version, sim::between(1, 1), "version of the file format");
  in.require("study");
  in.read_name("study", name, "name of the study");
  in.read("description", description, "description in one sentence");
  // World, seeds and cases.
  in.read("launch", launch, "start the programs that the world names");
  in.read("duration_s", duration_s, sim::above_to(0, 1e9), "simulated time of each run; unset: as the world says");
  seeds = read_seeds(in);
  in.read_list("cases", cases, "case", "ways of running the world; unset: as it is");
  read_worlds(in);
  for (const StudyCase& each : cases) in.declare("case", each.name);
  // Factors and their design.
  in.read_list("factors", factors, "factor", "settings that vary together, by `design`");
  for (const StudyFactor& factor : factors) in.declare("factor", factor.name);
  in.read("design", design, "how the values of the factors are chosen; unset: every combination of their levels");
  check_design(in);
  read_algorithms(in);
  // Figures, plots and rules.
  in.read("figures", figures, "figures of the table; unset: all");
  if (in.has("figures")) figures_place = in.child("figures")->place;
  until = read_until(in, figures);
  in.read_list("plots", plots, "plot", "plots");
  for (const StudyPlot& plot : plots) in.declare("plot", plot.name);
  if (in.describing())
    return sim::describe_rules(in, "the study passes when every rule holds; else exit code 1",
                               {"mean(cooperative.passed) == 1", "max(cooperative.auv1.rms_m) < 0.8"});
  if (const sim::ConfigNode* node = in.child("pass")) rules = *node;
  pass = sim::read_rule_list(rules, StudyRuleNames(cases), study_rule_of_map, in.diagnostics());
}

std::string StudyConfig::world_text() const {
  return of_worlds && cases.size() > 1 ? fmt::format("{} worlds", cases.size()) : cases.front().world;
}

void StudyConfig::read_worlds(sim::ParamReader& in) {
  std::string world;
  std::vector<std::string> worlds;
  in.read("world", world, "world file, from the folder of this file, or the name of a shipped world");
  in.read("worlds", worlds, "several world files instead, each of which is a case with the name of its file");
  if (in.describing()) return;
  if (in.has("world") && in.has("worlds")) in.error("worlds", "needs either 'world' or 'worlds', not both");
  const sim::ConfigNode* list = in.child("worlds");
  require_something(in, "worlds", worlds.empty());
  std::set<std::string> names;
  std::vector<StudyCase> of_list;
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    StudyCase& each = of_list.emplace_back();
    each.name = fs::path(worlds[i]).stem().string();
    each.world = worlds[i];
    each.world_place = list->items.empty() ? list->place : list->items.at(i).place;
    const bool good = !each.name.empty() && std::all_of(each.name.begin(), each.name.end(), [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    });
    const std::string shown_path = "'" + sim::shortened(sim::printable(worlds[i])) + "'";
    if (!good) in.error("worlds", "'worlds': a file name must have letters, digits, _ and - only, got " + shown_path);
    if (!names.insert(each.name).second)
      in.error("worlds", "'worlds' must have different file names, got " + shown_path);
  }
  // A case without its own world runs that of the study.
  if (in.has("world") && cases.empty()) cases.emplace_back().name = "world";
  for (StudyCase& each : cases) {
    if (!names.insert(each.name).second && in.has("worlds"))
      in.error("cases", "case '" + each.name + "' has the name of one of 'worlds'");
    of_worlds = of_worlds || !each.world.empty();
    if (!each.world.empty()) continue;
    if (!in.has("world")) in.error("cases", "case '" + each.name + "' needs a 'world', because the study has none");
    each.world = world;
    if (const sim::ConfigNode* node = in.child("world")) each.world_place = node->place;
  }
  of_worlds = of_worlds || !of_list.empty();
  cases.insert(cases.begin(), of_list.begin(), of_list.end());
  if (!cases.empty()) return;
  in.error("world", "needs 'world', 'worlds' or 'cases' with a 'world'");
  cases.emplace_back().name = "world";
}

void StudyConfig::read_algorithms(sim::ParamReader& in) {
  in.read("algorithms", algorithms,
          "algorithms of `shoal-nav`, each of which navigates the record of every run: LABEL.rms_m and so on");
  in.read("pairs", pairs, "algorithm that the others are compared with, in pairs of equal seeds; unset: the first");
  if (in.describing()) return;
  require_something(in, "algorithms", algorithms.empty());
  if (const sim::ConfigNode* node = in.child("algorithms")) algorithms_place = node->place;
  for (const std::string& algorithm : algorithms)
    if (!is_label(algorithm))
      in.error("algorithms", "'algorithms' must be names, got '" + sim::shortened(sim::printable(algorithm)) +
                                 "'; an own class in Python is given with --algorithm");
  if (std::set<std::string>(algorithms.begin(), algorithms.end()).size() != algorithms.size())
    in.error("algorithms", "'algorithms' must differ from each other");
  if (!algorithms.empty() && !launch)
    in.error("algorithms", "'algorithms' need 'launch: true': the programs of the world send what they receive");
  if (in.has("pairs") && std::find(algorithms.begin(), algorithms.end(), pairs) == algorithms.end())
    in.error("pairs", "'pairs' must be one of 'algorithms', got '" + sim::shortened(sim::printable(pairs)) + "'");
  if (pairs.empty() && !algorithms.empty()) pairs = algorithms.front();
}

void StudyConfig::check_design(sim::ParamReader& in) const {
  if (in.describing()) return;
  if (factors.empty() && in.has("design")) in.error("design", "'design' needs 'factors'");
}

std::vector<std::int64_t> parse_seeds(const std::string& text) {
  std::vector<std::int64_t> seeds;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (const std::string problem = add_seeds(std::string_view(text).substr(begin, end - begin), seeds);
        !problem.empty())
      throw std::invalid_argument(problem);
    begin = end + 1;
  }
  if (!differ_from_each_other(seeds)) throw std::invalid_argument("must differ from each other, got '" + text + "'");
  return seeds;
}

namespace {

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
  options.sets.insert(options.sets.end(), sets.begin(), sets.end());
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

}  // namespace

namespace {

/// Most values of a factor that are checked before the first run.
constexpr std::size_t max_checked_values = 8;

/// Loads the world with some values of each factor: its first and last ones, and those between up to a number. Errors
/// name the factor.
void check_factors(const LoadedStudy& study, const sim::LoadOptions& load) {
  const StudyConfig& config = study.config;
  for (const StudyFactor& factor : config.factors) {
    std::vector<std::string> values{factor.value_at(0), factor.value_at(1)};
    if (!factor.values.empty()) {
      values.assign(factor.values.begin(), factor.values.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                       factor.values.size(), max_checked_values)));
      if (factor.values.size() > max_checked_values) values.push_back(factor.values.back());
    }
    for (const std::string& value : values) {
      sim::LoadOptions options = load;
      for (const std::string& set : config.cases.front().sets()) options.sets.push_back(set);
      for (const std::string& path : factor.paths) options.sets.push_back(path + "=" + value);
      try {
        sim::load_world(config.cases.front().world, options);
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
              "'batch' is " + std::to_string(until->batch) + ": 'until' may hold by chance after fewer than " +
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

}  // namespace tools
