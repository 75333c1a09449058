// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>
#include <regex>

#include "tests/project_paths.hpp"
#include "tests/system/shoal_program.hpp"

// The commands of docs/guides/time_control.md do what the page says.

namespace {

using namespace system_test;
using testing::HasSubstr;
using testing::SizeIs;

/// From a heading of the page to the next.
std::string section(const std::string& heading) {
  const std::string page = text_of_file(source("docs/guides/time_control.md"));
  const std::size_t begin = page.find("\n## " + heading + "\n");
  if (begin == std::string::npos) throw std::runtime_error("no heading " + heading);
  return page.substr(begin, page.find("\n## ", begin + 4) - begin);
}

struct PageCommand {
  std::string text;
  std::string answer;  ///< what the comment behind it says
};

/// The lines of a section that begin with `shoal`.
std::vector<PageCommand> commands_in(const std::string& text) {
  static const std::regex line("\n(shoal [^\n#]*[^\n# ])(?: +# ([^\n]*))?");
  std::vector<PageCommand> commands;
  for (auto found = std::sregex_iterator(text.begin(), text.end(), line); found != std::sregex_iterator(); ++found)
    commands.push_back({(*found)[1], (*found)[2]});
  return commands;
}

/// The commands within its sentences.
std::vector<std::string> commands_between(const std::string& text) {
  static const std::regex quoted("`(shoal [^`]*)`");
  std::vector<std::string> commands;
  for (auto found = std::sregex_iterator(text.begin(), text.end(), quoted); found != std::sregex_iterator(); ++found)
    commands.push_back((*found)[1]);
  return commands;
}

/// A folder like the one of the source, in which files may be written.
class Page : public testing::Test {
 protected:
  Page() {
    for (const char* name : {"worlds", "vehicles"})
      std::filesystem::create_directory_symlink(source(name), folder_.file(name));
  }
  std::vector<std::string> shell(const std::string& command) const {
    const std::string programs = std::filesystem::path(built("shoal")).parent_path();
    return {"sh", "-c",
            "cd '" + folder_.file("") + "' && export LCM_DEFAULT_URL='" + own_url() + "' PATH='" + programs +
                "':$PATH && exec " + command};
  }
  Ended run(const std::string& command) const {
    Program program(shell(command));
    const int exit_code = program.wait();
    return {exit_code, program.output(), program.errors()};
  }

  ScratchFolder folder_;
};

TEST_F(Page, AWorkedSessionEndsAsItSays) {
  const std::string text = section("A worked session");
  const std::vector<PageCommand> commands = commands_in(text);
  ASSERT_THAT(commands, SizeIs(5));
  Program run_itself(shell(commands.front().text + " --paused"));  // else the test would race with its 40 s
  EXPECT_TRUE(await([&] { return run("shoal control where --timeout 0.5").exit_code == 0; }, timeout));
  for (std::size_t i = 1; i < commands.size(); ++i) {
    const Ended ended = run(commands[i].text);
    EXPECT_EQ(ended.exit_code, 0) << commands[i].text << ended.errors;
    EXPECT_THAT(ended.output, HasSubstr(commands[i].answer));
    const auto stands = [&] { return run("shoal control where").output.find(", paused") != std::string::npos; };
    EXPECT_TRUE(!commands[i].text.starts_with("shoal control until") || await(stands, timeout));
  }
  EXPECT_EQ(run_itself.wait(), 0) << run_itself.errors();
  for (const char* file : {"out/summary.json", "out/branch0/summary.json", "out.lcm", "out.branch1.lcm"}) {
    EXPECT_THAT(text, HasSubstr(file));
    EXPECT_TRUE(std::filesystem::exists(folder_.file(file))) << file;
  }
  const std::vector<std::string> after = commands_between(text);
  ASSERT_THAT(after, SizeIs(2));
  for (const std::string& command : after) {
    const Ended ended = run(command);
    EXPECT_EQ(ended.exit_code, 0) << command << ended.errors;
  }
}

TEST_F(Page, SnapshotFilesContinueAsItSays) {
  const std::vector<PageCommand> commands = commands_in(section("Snapshot files"));
  ASSERT_THAT(commands, SizeIs(4));
  std::vector<Ended> ended;
  for (const PageCommand& command : commands) {
    ended.push_back(run(command.text));
    EXPECT_EQ(ended.back().exit_code, 0) << command.text << ended.back().errors;
  }
  EXPECT_EQ(run_hash_in(ended[2]), run_hash_in(ended[0]));
}

}  // namespace
