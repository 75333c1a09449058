// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/project_paths.hpp"

// The headers of ODE are read by the rooms that call it.  Devices, plugins and all else reach none of them.

namespace {

namespace fs = std::filesystem;

using Includes = std::map<std::string, std::vector<std::string>>;

/// What each source below `folders` includes, as it is written, by its path from the top.
Includes includes_below(const std::vector<std::string>& folders) {
  static const std::regex include(R"(\s*#\s*include\s*[<"]([^>"]+)[>"].*)");
  const fs::path root = test_support::source_path("");
  Includes includes;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
      std::vector<std::string>& of_file = includes[entry.path().lexically_relative(root).string()];
      std::ifstream text(entry.path());
      for (std::string line; std::getline(text, line);) {
        std::smatch match;
        if (std::regex_match(line, match, include)) of_file.push_back(match[1]);
      }
    }
  }
  return includes;
}

/// The way of includes from a file to a header of ODE, such as ` > sim/a.hpp > ode/ode.h`; nullopt: there is none.
std::optional<std::string> direction_to_ode(const std::string& file, const Includes& includes,
                                            std::set<std::string>& seen) {
  const auto found = includes.find(file);
  if (found == includes.end() || !seen.insert(file).second) return std::nullopt;
  for (const std::string& include : found->second) {
    if (include.starts_with("ode/")) return " > " + include;
    if (const auto distance = direction_to_ode(include, includes, seen)) return " > " + include + *distance;
  }
  return std::nullopt;
}

bool may_read_ode(const std::string& file) {
  for (const char* room : {"sim/ode/", "sim/rays/", "sim/collision/", "sim/physics/"})
    if (file.starts_with(room)) return true;
  return false;
}

TEST(OdeHeaders, AreReadOnlyByTheRoomsThatCallOde) {
  const Includes includes = includes_below({"sim", "messages", "devices", "bridges", "experiment", "autonomy", "viewer",
                                            "motion", "verification", "tools", "examples"});
  ASSERT_GT(includes.size(), 500u);  // the folders were found
  int readers = 0;
  for (const auto& [file, of_file] : includes) {
    std::set<std::string> seen;
    const auto distance = direction_to_ode(file, includes, seen);
    if (distance) ++readers;
    if (distance && !may_read_ode(file)) ADD_FAILURE() << file << *distance;
  }
  EXPECT_GT(readers, 10);  // ways are found
}

}  // namespace
