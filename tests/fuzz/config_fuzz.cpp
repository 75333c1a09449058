// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/config_node.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// YAML, as files, --set and the bus bring it.

namespace {

bool equal(const sim::ConfigNode& a, const sim::ConfigNode& b) {
  if (a.kind != b.kind || a.scalar != b.scalar || a.items.size() != b.items.size() ||
      a.entries.size() != b.entries.size())
    return false;
  for (std::size_t i = 0; i < a.items.size(); ++i)
    if (!equal(a.items[i], b.items[i])) return false;
  for (std::size_t i = 0; i < a.entries.size(); ++i)
    if (a.entries[i].key != b.entries[i].key || !equal(a.entries[i].value, b.entries[i].value)) return false;
  return true;
}

}  // namespace

SHOAL_FUZZ_TARGET(config) {
  fuzz::Reader reader(input);
  const std::size_t path_size = reader.below(32);
  const std::string path(fuzz::text_of(reader.bytes(path_size)));
  const std::string text(fuzz::text_of(reader.rest()));
  sim::Diagnostics diagnostics;
  sim::ConfigNode node = sim::parse_config_text(text, "fuzz.yaml", diagnostics);
  if (!diagnostics.ok()) return;
  const sim::ConfigNode again = sim::parse_config_text(sim::to_yaml(node), "again.yaml", diagnostics);
  fuzz::require(diagnostics.ok() && equal(node, again), "to_yaml() parses to the same tree");

  sim::Diagnostics of_path, of_parameters;
  sim::set_config_path(node, path, sim::scalar_node("1", node.place), node.place, of_path);
  sim::substitute_parameters(node, {{"name", sim::scalar_node("auv", node.place)}, {"n", again}}, "fuzz",
                             of_parameters);
}
