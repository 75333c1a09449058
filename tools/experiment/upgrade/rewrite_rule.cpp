// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <vector>

#include "sim/config/message_text.hpp"
#include "tools/experiment/upgrade/entry_edits.hpp"
#include "tools/experiment/upgrade/number_text.hpp"
#include "tools/experiment/upgrade/renames.hpp"
#include "tools/experiment/upgrade/rewriting.hpp"

// Since version 0.2 a rule is a comparison, `a.rms_m < 0.4 * b.rms_m`; before, it was a map with a key for each part.

namespace tools {

namespace {

using Kind = SourceNode::Kind;

/// Kind of the value of a comparison.
enum class Right {
  number,
  figure,  ///< another figure
  of_case  ///< the same figure of another case
};

struct Comparison {
  const char* key;
  const char* sign;
  Right right;
};

constexpr Comparison world_comparisons[] = {
    {"below", "<", Right::number},        {"above", ">", Right::number},        {"equals", "==", Right::number},
    {"below_metric", "<", Right::figure}, {"above_metric", ">", Right::figure},
};
constexpr Comparison study_comparisons[] = {
    {"below", "<", Right::number},       {"above", ">", Right::number},        {"equals", "==", Right::number},
    {"below_case", "<", Right::of_case}, {"below_figure", "<", Right::figure},
};

class OldRule {
 public:
  OldRule(const SourceNode& map, FileKind kind) : map_(map), kind_(kind) {}

  std::string expression() const {
    const Comparison& comparison = only_comparison();
    std::vector<std::string_view> keys{"metric", comparison.key};
    if (kind_ == FileKind::study) keys = {"case", "figure", "statistic", comparison.key};
    if (comparison.right != Right::number) keys.emplace_back("factor");
    for (const SourceNode::Entry& entry : map_.entries)
      if (std::find(keys.begin(), keys.end(), entry.key.scalar) == keys.end())
        throw Doubt(entry.key.start, "a rule with '" + sim::shortened(entry.key.scalar) + "' is not rewritten");
    return left() + " " + comparison.sign + " " + right(comparison);
  }

 private:
  const Comparison& only_comparison() const {
    const std::span<const Comparison> known = kind_ == FileKind::study ? std::span<const Comparison>(study_comparisons)
                                                                       : std::span<const Comparison>(world_comparisons);
    const Comparison* found = nullptr;
    for (const Comparison& each : known) {
      if (map_.find(each.key) == nullptr) continue;
      if (found != nullptr) throw Doubt(map_.start, "a rule must have one comparison");
      found = &each;
    }
    if (found == nullptr) throw Doubt(map_.start, "a rule must have a comparison, such as 'below' or 'above'");
    return *found;
  }

  std::string left() const {
    return kind_ == FileKind::study ? statistic_of(name("case"), name("figure")) : name("metric");
  }

  std::string right(const Comparison& comparison) const {
    if (comparison.right == Right::number) return number(comparison.key);
    const std::string factor = map_.find("factor") != nullptr ? number("factor") + " * " : "";
    const std::string other = name(comparison.key);
    if (kind_ == FileKind::world) return factor + other;
    return factor + (comparison.right == Right::of_case ? statistic_of(other, name("figure"))
                                                        : statistic_of(name("case"), other));
  }

  std::string statistic_of(const std::string& in_case, const std::string& figure) const {
    return (map_.find("statistic") != nullptr ? name("statistic") : "mean") + "(" + in_case + "." + figure + ")";
  }

  const SourceNode& value(const std::string& key) const {
    const SourceNode::Entry* entry = map_.find(key);
    if (entry == nullptr) throw Doubt(map_.start, "a rule must have the key '" + key + "'");
    if (entry->value.target->kind != Kind::scalar)
      throw Doubt(entry->value.start, "'" + key + "' of a rule must be a number or a name");
    return *entry->value.target;
  }

  /// Reads a figure, a case or a statistic: letters, digits, `_`, `-` and dots.
  std::string name(const std::string& key) const {
    const SourceNode& node = value(key);
    const auto is_plain = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
             c == '.';
    };
    if (node.scalar.empty() || node.scalar[0] == '-' || !std::all_of(node.scalar.begin(), node.scalar.end(), is_plain))
      throw Doubt(node.start, "'" + key + "' of a rule must be a name, got '" + sim::shortened(node.scalar) + "'");
    return node.scalar;
  }

  std::string number(const std::string& key) const {
    const SourceNode& node = value(key);
    if (node.quoted || !number_of(node.scalar))
      throw Doubt(node.start, "'" + key + "' of a rule must be a number, got '" + sim::shortened(node.scalar) + "'");
    return node.scalar.starts_with('+') ? node.scalar.substr(1) : node.scalar;
  }

  const SourceNode& map_;
  FileKind kind_;
};

}  // namespace

void rewrite_rule(Site& site) {
  const bool is_rule = site.path.is(FileKind::world, "pass.*") || site.path.is(FileKind::study, "pass.*");
  if (!is_rule || site.source.kind != Kind::map) return;
  replace_by_scalar(site, renamed_rule(OldRule(site.source, site.path.kind()).expression(), site.path.kind()));
}

}  // namespace tools
