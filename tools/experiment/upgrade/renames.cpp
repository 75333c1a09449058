// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/renames.hpp"

#include <utility>

namespace tools {

using What = Rename::What;

constexpr Rename name_changes[] = {
    {What::word, FileKind::world, "metrics.*.type", "lean", "tilt"},
    {What::word, FileKind::world, "metrics.*.channel", "sim.mail", "sim.inputs"},
    {What::word, FileKind::world, "metrics.*.channel", "sim.notice", "sim.audit"},
    {What::part, FileKind::world, "events.*.when", "sim.mail", "sim.inputs"},
    {What::part, FileKind::world, "events.*.when", "sim.notice", "sim.audit"},
    {What::figure, FileKind::world, "pass.*", "longest_gap_s", "max_gap_s"},
    {What::figure, FileKind::study, "pass.*", "longest_gap_s", "max_gap_s"},
    {What::figure, FileKind::study, "figures.*", "longest_gap_s", "max_gap_s"},
    {What::figure, FileKind::study, "plots.*.figure", "longest_gap_s", "max_gap_s"},
    {What::figure, FileKind::study, "pictures.*.figure", "longest_gap_s", "max_gap_s"},
    {What::key, FileKind::study, "", "pictures", "plots"},
    {What::word, FileKind::study, "world", "living_warehouse", "dynamic_warehouse"},
};

std::span<const Rename> renames() {
  return name_changes;
}

std::string renamed_rule(std::string rule, FileKind kind) {
  for (const Rename& rename : name_changes)
    if (rename.what == What::figure && rename.kind == kind && rename.path == "pass.*")
      rule = renamed_figure(std::move(rule), rename.before, rename.after);
  return rule;
}

}  // namespace tools
