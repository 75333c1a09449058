// SPDX-License-Identifier: BSD-3-Clause
#include "sim/program/program_args.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// NAME.args.yaml, which anyone may write, and the `args:` of a world by it.

SHOAL_FUZZ_TARGET(declaration) {
  fuzz::Reader reader(input);
  const std::string args = reader.text(), text(fuzz::text_of(reader.rest()));
  sim::Diagnostics diagnostics;
  const sim::ProgramDeclaration declaration = sim::read_declaration(text, "fuzz.args.yaml", diagnostics);
  if (!diagnostics.ok()) return;
  const std::string written = sim::to_yaml(declaration);
  const sim::ProgramDeclaration again = sim::read_declaration(written, "again.args.yaml", diagnostics);
  fuzz::require(diagnostics.ok() && sim::to_yaml(again) == written, "to_yaml() reads back as the same declaration");
  sim::param_table_of(declaration);

  const sim::ConfigNode node = sim::parse_config_text(args, "world.yaml", diagnostics);
  if (!diagnostics.ok()) return;
  const std::vector<std::string> words =
      sim::command_line_of(declaration, node, node.place, "process 'fuzz'", diagnostics);
  for (const std::string& word : words) {
    fuzz::require(word.starts_with("--"), "every argument is an option");
    fuzz::require(word.find('\0') == std::string::npos, "every argument is a word of a command line");
  }
  for (const auto& channel : declaration.publishes.value_or(std::vector<std::string>()))
    sim::channel_of(declaration, node, channel);
}
