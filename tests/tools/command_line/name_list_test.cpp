// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/name_list.hpp"

#include <gmock/gmock.h>

#include <CLI/CLI.hpp>

namespace {

using testing::ElementsAre;

std::vector<std::string> names_of(std::vector<std::string> words) {
  CLI::App app;
  std::vector<std::string> names;
  command_line::add_name_list(app, "--joints", names, "which");
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  app.parse(words);
  return names;
}

TEST(NameList, HasNamesBetweenCommas) {
  EXPECT_THAT(names_of({"--joints", "hip,knee"}), ElementsAre("hip", "knee"));
  EXPECT_THAT(names_of({"--joints", "hip", "--joints", "knee,toe"}), ElementsAre("hip", "knee", "toe"));
  EXPECT_THAT(names_of({}), testing::IsEmpty());
}

TEST(NameList, AnEmptyNameIsAnError) {
  for (const char* text : {",", "hip,", ",hip", "hip,,knee"})
    EXPECT_THROW(names_of({std::string("--joints=") + text}), CLI::ValidationError) << text;
}

}  // namespace
