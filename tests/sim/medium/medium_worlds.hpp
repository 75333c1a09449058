// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "sim/config/config_node.hpp"
#include "sim/medium/medium.hpp"

namespace test_support {

/// What `medium:` says, read as a world file's.
inline sim::MediumConfig read_medium(const std::string& yaml, const std::string& file = "medium.yaml") {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::parse_config_text(yaml, file, diagnostics);
  sim::MediumConfig config;
  sim::ParamReader in(node, "medium", diagnostics);
  config.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return config;
}

inline sim::Medium make_medium(const std::string& yaml, std::uint64_t seed = 1) {
  return sim::Medium(read_medium(yaml), 9.80665, seed);
}

/// The words of the error that reading and making it ends with; empty: none.
inline std::string error_of(const std::string& yaml, const std::string& file = "medium.yaml") {
  try {
    const sim::Medium medium(read_medium(yaml, file), 9.80665, 1);
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "";
}

}  // namespace test_support
