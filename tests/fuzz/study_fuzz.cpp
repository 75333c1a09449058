// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/load_study.hpp"
#include "experiment/study/study_config.hpp"
#include "messages/yaml/message_writer.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "verification/fidelity/fidelity.hpp"

// Files of experiments: studies, cases of the fidelity report and their references.

SHOAL_FUZZ_TARGET(study) {
  [[maybe_unused]] static const std::string world = [] {
    const std::string_view text = "shoal: 1\nname: fuzz\nmetrics: [{name: bumps, type: collisions}]\n";
    return fuzz::write_scratch("world.yaml", {reinterpret_cast<const std::byte*>(text.data()), text.size()});
  }();
  fuzz::Reader reader(input);
  const std::size_t kind = reader.below(4);
  const fuzz::Input rest = reader.rest();
  if (kind == 3) {
    fuzz::allow<std::invalid_argument>([&] { experiment::parse_seeds(std::string(fuzz::text_of(rest))); });
    return;
  }
  const std::string path = fuzz::write_scratch(kind == 2 ? "reference.csv" : "study.yaml", rest);
  fuzz::allow<sim::ConfigError>([&] {
    if (kind == 0) experiment::load_study(path);
    if (kind == 1) verification::read_fidelity_file(path);
    if (kind == 2) verification::read_fidelity_reference(path);
  });
}
