// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sim/config/config_node.hpp"

namespace include_fixture {

namespace fs = std::filesystem;

using Kind = sim::ConfigNode::Kind;

using Lines = std::vector<std::string>;

class IncludeTest : public testing::Test {
 protected:
  IncludeTest()
      : home_(fs::current_path()),
        directory_(fs::temp_directory_path() / ("shoal_include_" + std::to_string(getpid()))) {
    fs::create_directories(directory_);
    fs::current_path(directory_);  // so that messages hold short names
  }
  ~IncludeTest() override {
    fs::current_path(home_);
    fs::remove_all(directory_);
  }

  void write(const std::string& name, const std::string& text) {
    if (const fs::path folder = fs::path(name).parent_path(); !folder.empty()) fs::create_directories(folder);
    std::ofstream(name, std::ios::binary) << text;
  }

  sim::ConfigNode load(const std::string& name) {
    sim::Diagnostics diagnostics;
    sim::ConfigNode node = sim::load_config_file(name, diagnostics);
    EXPECT_EQ(diagnostics.lines(), Lines{});
    return node;
  }

  Lines errors_of(const std::string& name) {
    sim::Diagnostics diagnostics;
    EXPECT_EQ(sim::load_config_file(name, diagnostics).kind, Kind::null);
    return diagnostics.lines();
  }

 private:
  fs::path home_;
  fs::path directory_;
};

}  // namespace include_fixture
