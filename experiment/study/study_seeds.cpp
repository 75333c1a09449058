// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

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
