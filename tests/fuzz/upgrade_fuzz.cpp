// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzz_input.hpp"
#include "tools/experiment/upgrade/renames.hpp"
#include "tools/experiment/upgrade/upgrade_text.hpp"

// Worlds, vehicles and studies of an older version, as `shoal upgrade` rewrites them.

namespace {

constexpr tools::Rename table[] = {
    {tools::Rename::What::key, tools::FileKind::vehicle, "devices.*", "beams", "rays"},
    {tools::Rename::What::word, tools::FileKind::vehicle, "devices.*.type", "lidar", "laser"},
    {tools::Rename::What::word, tools::FileKind::world, "events.*.do.*.publish.type", "t", "u"},
};

constexpr tools::Rewriting with_renames[] = {
    {"words", tools::rewrite_zero},       {"rules", tools::rewrite_rule},
    {"commands", tools::rewrite_command}, {"names", [](tools::Site& site) { tools::apply_renames(site, table); }},
    {"actions", tools::rewrite_action},
};

void check(const std::string& text, tools::FileKind kind, std::span<const tools::Rewriting> rewritings) {
  sim::Diagnostics diagnostics;
  const auto upgraded = tools::upgrade_text(text, kind, "fuzz.yaml", diagnostics, rewritings);
  fuzz::require(upgraded.has_value() == diagnostics.ok(), "a text is rewritten, or there is an error");
  if (!upgraded) return;
  fuzz::require(upgraded->lines.empty() == (upgraded->text == text), "a text that is up to date stays as it is");
  const auto again = tools::upgrade_text(upgraded->text, kind, "again.yaml", diagnostics, rewritings);
  fuzz::require(again && again->text == upgraded->text, "rewriting twice is rewriting once");
}

}  // namespace

SHOAL_FUZZ_TARGET(upgrade) {
  fuzz::Reader reader(input);
  constexpr tools::FileKind kinds[] = {tools::FileKind::world, tools::FileKind::vehicle, tools::FileKind::study};
  const std::size_t choice = reader.below(6);
  const std::string text(fuzz::text_of(reader.rest()));
  check(text, kinds[choice % 3], choice < 3 ? tools::rewritings() : std::span<const tools::Rewriting>(with_renames));
}
