// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <istream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "shoal/message_schema.hpp"
#include "tests/project_paths.hpp"

// The classes that lcm-gen makes have no constructors: numbers and lengths of arrays of an object have any value until
// they are set.  So every object of such a class has an initializer, such as `shoal::pose_t pose{};`.

namespace {

/// Names of all types without package, such as `pose_t`.
std::set<std::string> names_of_types() {
  std::set<std::string> names;
  for (const auto& [name, schema] : shoal::embedded_types().all()) names.insert(name.substr(name.rfind('.') + 1));
  return names;
}

/// `path`: from the top of the source tree.  One line for each object of a generated class without an initializer.
std::vector<std::string> offenders_in(const std::string& path, std::istream& text) {
  static const std::set<std::string> types = names_of_types();
  static const std::regex object(R"((?:^|[^\w:.])(?:shoal::)?(\w+_t) +\w+(?:\[\w*\])*(?:, *\w+(?:\[\w*\])*)*;)");
  std::vector<std::string> offenders;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    std::smatch match;
    if (line.find("_t ") == std::string::npos || !std::regex_search(line, match, object)) continue;
    if (types.contains(match[1]))
      offenders.push_back(path + ":" + std::to_string(number) + ": '" + match[1].str() + "' needs an initializer, {}");
  }
  return offenders;
}

std::vector<std::string> offenders_in_text(const std::string& text) {
  std::istringstream stream(text);
  return offenders_in("a.cpp", stream);
}

TEST(InitializedMessages, EveryObjectOfAGeneratedClassHasAnInitializer) {
  const std::filesystem::path root = test_support::source_path("");
  int files = 0;
  for (const char* folder : {"sim", "messages", "devices", "bridges", "experiment", "autonomy", "viewer", "motion",
                             "verification", "tools", "python", "examples", "tests"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (!entry.is_regular_file() || (extension != ".cpp" && extension != ".hpp")) continue;
      if (entry.path().filename() == "initialized_messages_test.cpp") continue;
      ++files;
      std::ifstream text(entry.path());
      for (const std::string& offender : offenders_in(entry.path().lexically_relative(root).string(), text))
        ADD_FAILURE() << offender;
    }
  EXPECT_GT(files, 1000);  // the folders were found
}

TEST(InitializedMessages, NamesAnOffender) {
  EXPECT_THAT(offenders_in_text("\n  shoal::sim_scores_t scores_;\n"),
              testing::ElementsAre("a.cpp:2: 'sim_scores_t' needs an initializer, {}"));
  for (const char* text :
       {"pose_t pose;", "static thread_local shoal::sim_state_t state;  // reused", "shoal::sim_state_t there, own;",
        "  shoal::pose_t poses[3];", "if (is_old) { shoal::pose_t pose; }"})
    EXPECT_EQ(offenders_in_text(text).size(), 1u) << text;
}

TEST(InitializedMessages, LetsPassWhatIsInitializedOrNoObject) {
  for (const char* text :
       {"shoal::pose_t pose{};", "std::optional<shoal::pose_t> pose;", "std::vector<shoal::pose_t> poses;",
        "void take(shoal::pose_t pose);", "const shoal::pose_t& pose;", "using shoal::pose_t;", "std::size_t count;",
        "auto pose = shoal::decode<shoal::pose_t>(payload, any);"})
    EXPECT_TRUE(offenders_in_text(text).empty()) << text;
}

}  // namespace
