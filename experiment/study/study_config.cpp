// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_config.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "experiment/study/study_algorithms.hpp"
#include "experiment/study/study_rules.hpp"
#include "sim/base/number.hpp"
#include "sim/config/common_keys.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world_file/metric_config.hpp"

namespace experiment {
namespace {

namespace fs = std::filesystem;

/// Rejects a key without a value.
void require_something(sim::ParamReader& in, const char* key, bool empty) {
  if (in.has(key) && empty) in.error(key, "'" + std::string(key) + "' must not be empty");
}

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
                 "what errors are drawn over: distance traveled or time");
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
  sim::read_version(in, "shoal", version);
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
  pass = sim::read_rule_list(rules, StudyRuleNames(cases), in.diagnostics());
}

std::string StudyConfig::world_text() const {
  return of_worlds && cases.size() > 1 ? fmt::format("{} worlds", cases.size()) : cases.front().world;
}

void StudyConfig::read_worlds(sim::ParamReader& in) {
  std::string world;
  std::vector<std::string> worlds;
  in.read("world", world, "world file, relative to the folder of this file, or the name of a shipped world");
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
    if (!is_algorithm_label(algorithm))
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

namespace {

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
  const auto seed = sim::exact_number<std::int64_t>(text);
  return seed && text[0] != '-' && static_cast<double>(*seed) <= max_seed ? seed : std::nullopt;
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

}  // namespace

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

}  // namespace experiment
