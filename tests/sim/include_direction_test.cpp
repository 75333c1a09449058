// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/project_paths.hpp"

// Includes point down: tools -> bridges, devices, sim; bridges -> sim; devices -> sim.  `shoal` are the
// generated messages, `lcm` is LCM itself.

namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> may_include = {
    {"sim", {"sim"}},
    {"devices", {"devices", "sim", "shoal"}},
    {"bridges", {"bridges", "sim", "shoal", "lcm"}},
    {"tools", {"tools", "bridges", "devices", "sim", "shoal"}},
};
const std::set<std::string> known_folders = {"sim", "devices", "bridges", "tools", "tests", "shoal", "lcm"};

/// `path`: from the top of the source tree.  One line for each include that points up.
std::vector<std::string> offenders_in(const std::string& path, std::istream& text) {
  static const std::regex include(R"(\s*#\s*include\s*[<"](?:\.\./)*([^/>"]+)/.*)");
  const std::string folder = path.substr(0, path.find('/'));
  const std::set<std::string>& allowed = may_include.at(folder);
  std::vector<std::string> offenders;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    std::smatch match;
    if (!std::regex_match(line, match, include)) continue;
    const std::string target = match[1];
    if (known_folders.contains(target) && !allowed.contains(target))
      offenders.push_back(path + ":" + std::to_string(number) + ": " + folder + "/ must not include " + target + "/");
  }
  return offenders;
}

std::vector<std::string> offenders_in_text(const std::string& path, const std::string& text) {
  std::istringstream stream(text);
  return offenders_in(path, stream);
}

bool is_source(const fs::path& path) {
  return path.extension() == ".hpp" || path.extension() == ".cpp" || path.extension() == ".h" ||
         path.extension() == ".c";
}

TEST(IncludeDirection, PointsDownEverywhere) {
  const fs::path root = test_support::source_path("");
  int files = 0;
  for (const auto& [folder, allowed] : may_include)
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      ++files;
      std::ifstream text(entry.path());
      for (const std::string& offender : offenders_in(entry.path().lexically_relative(root).string(), text))
        ADD_FAILURE() << offender;
    }
  EXPECT_GT(files, 100);  // the folders were found
}

TEST(IncludeDirection, NamesAnOffender) {
  EXPECT_EQ(offenders_in_text("sim/world.cpp", "#include \"sim/world.hpp\"\n#include \"devices/ranging/lidar.hpp\"\n"),
            std::vector<std::string>{"sim/world.cpp:2: sim/ must not include devices/"});
  EXPECT_EQ(offenders_in_text("devices/ranging/lidar.cpp", "\n#  include <lcm/lcm.h>\n"),
            std::vector<std::string>{"devices/ranging/lidar.cpp:2: devices/ must not include lcm/"});
  EXPECT_EQ(offenders_in_text("sim/bus/bus.hpp", "#include \"shoal/pose_t.hpp\"\n"),
            std::vector<std::string>{"sim/bus/bus.hpp:1: sim/ must not include shoal/"});
  EXPECT_EQ(offenders_in_text("bridges/lcm/a.cpp", "#include \"../../tools/a.hpp\"\n#include \"tests/b.hpp\"\n").size(),
            2u);
}

TEST(IncludeDirection, LetsPassWhatIsAllowed) {
  EXPECT_TRUE(offenders_in_text("bridges/lcm/a.cpp", "#include <lcm/lcm.h>\n#include \"sim/base/time.hpp\"\n").empty());
  EXPECT_TRUE(
      offenders_in_text("sim/a.cpp", "#include <sys/stat.h>\n#include <ode/ode.h>\n// #include \"tools/a.hpp\"\n")
          .empty());
}

}  // namespace
