// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "sim/device/device_registry.hpp"
#include "tests/project_paths.hpp"

// docs/device_checks.md names every device, and only tests that exist.

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// `Suite.Name` of every test of the devices.
std::set<std::string> device_tests() {
  static const std::regex test(R"(TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(test_support::source_path("tests/devices"))) {
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator match(text.begin(), text.end(), test), end; match != end; ++match)
      names.insert((*match)[1].str() + "." + (*match)[2].str());
  }
  return names;
}

TEST(DeviceChecks, EveryDeviceIsInTheTable) {
  const std::string page = text_of(test_support::source_path("docs/device_checks.md"));
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all())
    EXPECT_NE(page.find("\n| `" + type->name + "` |"), std::string::npos) << type->name;
}

TEST(DeviceChecks, EveryTestInTheTableExists) {
  static const std::regex named(R"(`(\w+\.\w+)`)");
  const std::string page = text_of(test_support::source_path("docs/device_checks.md"));
  const std::set<std::string> tests = device_tests();
  int found = 0;
  for (std::sregex_iterator match(page.begin(), page.end(), named), end; match != end; ++match, ++found)
    EXPECT_TRUE(tests.contains((*match)[1])) << (*match)[1];
  EXPECT_GE(found, 40);
}

}  // namespace
