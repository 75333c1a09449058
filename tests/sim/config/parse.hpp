// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sim/config/config_node.hpp"
#include "sim/config/diagnostics.hpp"

namespace test {

/// A document that must be free of mistakes.
inline sim::ConfigNode parse(const std::string& text) {
  sim::Diagnostics diagnostics;
  sim::ConfigNode node = sim::parse_config_text(text, "w.yaml", diagnostics);
  EXPECT_EQ(diagnostics.lines(), std::vector<std::string>{}) << text;
  return node;
}

}  // namespace test
