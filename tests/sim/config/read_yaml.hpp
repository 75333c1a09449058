// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace test {

/// Reads a map of YAML by `read`; returns what is wrong with it, a line each.
inline std::vector<std::string> errors_of_reading(const std::string& yaml,
                                                  const std::function<void(sim::ParamReader&)>& read) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::parse_config_text(yaml, "w.yaml", diagnostics);
  sim::ParamReader in(node, "", diagnostics);
  read(in);
  in.finish();
  return diagnostics.lines();
}

}  // namespace test
