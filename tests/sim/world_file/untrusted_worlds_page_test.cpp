// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "tests/project_paths.hpp"

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(StrangersPage, EachPromiseNamesATestThatIsThere) {
  std::string tests;
  for (const auto& entry : fs::recursive_directory_iterator(test_support::source_path("tests")))
    if (entry.path().string().ends_with("_test.cpp")) tests += text_of(entry.path());
  const std::string page = text_of(test_support::source_path("docs/guides/untrusted_worlds.md"));
  const std::regex named(R"(`([A-Za-z]+)\.([A-Z][A-Za-z]+|\*)`)");
  int found = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), named), end; at != end; ++at) {
    const std::string suite = (*at)[1], name = (*at)[2];
    const std::string start = "(" + suite + ", " + (name == "*" ? "" : name + ")");
    EXPECT_NE(tests.find(start), std::string::npos) << at->str();
    ++found;
  }
  EXPECT_GE(found, 15);
}

}  // namespace
