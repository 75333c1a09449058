// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/number_text.hpp"
#include "tools/experiment/upgrade/rewriting.hpp"

// Since version 0.2 a word replaces a zero with a special meaning: `speed: max`.

namespace tools {

namespace {

struct WordOfZero {
  FileKind kind;
  std::string_view path;
  const char* word;
};

constexpr WordOfZero words_of_zero[] = {
    {FileKind::world, "run.speed", "max"},
    {FileKind::world, "run.duration_s", "forever"},
    {FileKind::world, "run.hash_every_steps", "never"},
    {FileKind::world, "state_rate_hz", "never"},
    {FileKind::world, "limits.step_cpu_s", "unlimited"},
    {FileKind::world, "events.*.times", "unlimited"},
    {FileKind::world, "vehicles.*.placement.columns", "auto"},
    {FileKind::world, "objects.*.placement.columns", "auto"},
    {FileKind::vehicle, "bodies.*.hydrodynamics.cross_flow.strips", "exact"},
    {FileKind::vehicle, "devices.*.rate_hz", "every_step"},
    {FileKind::vehicle, "devices.*.watchdog_s", "never"},
    {FileKind::vehicle, "devices.*.natural_frequency_radps", "none"},
    {FileKind::vehicle, "devices.*.max_message_bytes", "all_frames"},
    {FileKind::vehicle, "devices.*.synchronous_s", "at_once"},
    {FileKind::vehicle, "devices.*.range_at_10_percent_m", "unlimited"},
    {FileKind::vehicle, "devices.*.full_well_electrons", "unlimited"},
    {FileKind::vehicle, "devices.*.bandwidth_hz", "unlimited"},
    {FileKind::vehicle, "devices.*.gyro_range_dps", "unlimited"},
    {FileKind::vehicle, "devices.*.accel_range_g", "unlimited"},
};

/// Returns the word for a zero at this path; null: it has none.
const char* word_at(const KeyPath& path) {
  for (const WordOfZero& each : words_of_zero)
    if (path.is(each.kind, each.path)) return each.word;
  return nullptr;
}

/// Returns whether the value is `${NAME}`, and the parameter of this file is 0 by default.
bool is_zero_by_parameter(const Site& site) {
  const std::string& text = site.source.scalar;
  if (!text.starts_with("${") || !text.ends_with("}")) return false;
  const SourceNode::Entry* parameters = site.text.root().find("parameters");
  if (parameters == nullptr) return false;
  const SourceNode::Entry* value = parameters->value.target->find(std::string_view(text).substr(2, text.size() - 3));
  return value != nullptr && !value->value.target->quoted && is_zero(value->value.target->scalar);
}

}  // namespace

void rewrite_zero(Site& site) {
  if (site.source.kind != SourceNode::Kind::scalar || site.source.quoted) return;
  const bool by_parameter = is_zero_by_parameter(site);
  if (!by_parameter && !is_zero(site.source.scalar)) return;
  const char* word = word_at(site.path);
  if (word == nullptr) return;
  if (by_parameter) throw Doubt(site.source.start, "the parameter is 0, which is '" + std::string(word) + "' here");
  site.meaning.scalar = word;
  if (site.edits != nullptr) site.edits->replace(site.source.span, word);
}

}  // namespace tools
