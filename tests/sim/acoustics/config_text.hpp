// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/config/config_node.hpp"
#include "sim/config/param_reader.hpp"

namespace test_support {

/// A struct as YAML says it.  Throws ConfigError.
template <typename Config>
Config read_config(const std::string& yaml) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::parse_config_text(yaml, "acoustics.yaml", diagnostics);
  Config config;
  sim::ParamReader in(node, "acoustics", diagnostics);
  config.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return config;
}

/// The words of the error that reading ends with; empty: none.
template <typename Config>
std::string config_error(const std::string& yaml) {
  try {
    read_config<Config>(yaml);
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "";
}

}  // namespace test_support
