// SPDX-License-Identifier: BSD-3-Clause
#include "messages/yaml/message_writer.hpp"
#include "shoal/lcm_parser.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Messages as YAML (events, `shoal control do`), and the .lcm files of users.

SHOAL_FUZZ_TARGET(message_text) {
  fuzz::Reader reader(input);
  const std::size_t which = reader.byte();
  const std::string text(fuzz::text_of(reader.rest()));
  if (which == 0) {
    fuzz::allow<shoal::MessageError>([&] {
      const std::vector<shoal::LcmSource> sources{{"fuzz.lcm", text}};
      const shoal::MessageTypes types(sources);
    });
    return;
  }
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, schema] : shoal::embedded_types().all()) all.push_back(name);
    return all;
  }();
  const std::string& name = names[(which - 1) % names.size()];
  sim::Diagnostics diagnostics;
  const sim::ConfigNode value = sim::parse_config_text(text, "message", diagnostics);
  const std::vector<std::byte> payload = shoal::encode_own_message(name, value, diagnostics);
  if (!diagnostics.ok()) return;
  fuzz::require(!shoal::validate(*shoal::embedded_types().find(name), payload, shoal::Finite::any),
                "what was encoded from YAML is a good payload");
}
