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
    {What::figure, FileKind::world, "pass.*", "rms_deg", "pitch_std_deg"},
    {What::figure, FileKind::study, "pass.*", "rms_deg", "pitch_std_deg"},
    {What::figure, FileKind::study, "figures.*", "rms_deg", "pitch_std_deg"},
    {What::figure, FileKind::study, "plots.*.figure", "rms_deg", "pitch_std_deg"},
    {What::figure, FileKind::study, "pictures.*.figure", "rms_deg", "pitch_std_deg"},
    {What::figure, FileKind::world, "pass.*", "mean_deg", "pitch_mean_deg"},
    {What::figure, FileKind::study, "pass.*", "mean_deg", "pitch_mean_deg"},
    {What::figure, FileKind::study, "figures.*", "mean_deg", "pitch_mean_deg"},
    {What::figure, FileKind::study, "plots.*.figure", "mean_deg", "pitch_mean_deg"},
    {What::figure, FileKind::study, "pictures.*.figure", "mean_deg", "pitch_mean_deg"},
    {What::key, FileKind::study, "", "pictures", "plots"},
    {What::word, FileKind::study, "world", "../living_warehouse.yaml", "../dynamic_warehouse.yaml"},
    {What::key, FileKind::vehicle, "devices.*", "ticks_per_turn", "ticks_per_revolution"},
    {What::key, FileKind::vehicle, "devices.*", "bandwidth_hz", "bandwidth_Hz"},
    {What::key, FileKind::vehicle, "materials.*", "lets_through", "transparent_to"},
    {What::key, FileKind::world, "materials.*", "lets_through", "transparent_to"},
    {What::key, FileKind::world, "acoustics", "inaudible_dB", "negligible_dB"},
    {What::key, FileKind::vehicle, "contacts.*", "bounce", "restitution"},
    {What::key, FileKind::world, "contacts.*", "bounce", "restitution"},
    {What::key, FileKind::vehicle, "contacts.*", "bounce_velocity_mps", "restitution_velocity_mps"},
    {What::key, FileKind::world, "contacts.*", "bounce_velocity_mps", "restitution_velocity_mps"},
    {What::key, FileKind::vehicle, "joints.*", "bounce", "restitution"},
    {What::key, FileKind::vehicle, "joints.*.axis2", "bounce", "restitution"},
    {What::word, FileKind::world, "actors.*.ends", "bounce", "reverse"},
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
