// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/completion.hpp"

#include <gmock/gmock.h>

#include <cstdio>

#include "tests/scratch_folder.hpp"
#include "tools/command_line/checks.hpp"

namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

/// A program with commands on two levels, and options with values of each kind.
class Completion : public testing::Test {
 protected:
  Completion() {
    app_.add_subcommand("run", "Run: it's [quick]")
        ->add_option("--bus", text_, "the bus")
        ->type_name("BUS")
        ->check(command_line::one_of({"lcm", "none"}));
    CLI::App* edit = app_.add_subcommand("edit", "Edit");
    edit->add_subcommand("trim", "Trim")->add_option("--out", text_, "folder")->type_name("DIR");
    CLI::App* check = app_.add_subcommand("check", "Check");
    check->add_option("WORLD", text_, "a world");
    check->add_flag("-q,--quiet", flag_, "say less");
  }

  /// What bash offers after these words, the last of which is being typed.
  std::vector<std::string> offers(const std::string& words) const {
    const test_support::ScratchFolder folder;
    const std::string script = folder.file("script");
    std::FILE* out = std::fopen(script.c_str(), "w");
    std::fputs((command_line::bash_completion(app_, {{"WORLD", "printf 'bay\\nyard\\n'"}}) + "cd " + folder.file("") +
                "\nmkdir results\ntouch 'b c.yaml'\nCOMP_WORDS=(" + words +
                ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_tool\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n")
                   .c_str(),
               out);
    std::fclose(out);
    std::vector<std::string> found;
    std::FILE* in = popen(("bash " + script).c_str(), "r");
    char line[256];
    while (std::fgets(line, sizeof line, in)) found.emplace_back(line, std::char_traits<char>::length(line) - 1);
    EXPECT_EQ(pclose(in), 0);
    return found;
  }

  std::string text_;
  bool flag_ = false;
  CLI::App app_{"A tool.", "tool"};
};

TEST_F(Completion, OffersTheCommandsThatBeginAsTheWordDoes) {
  EXPECT_THAT(offers("tool e"), UnorderedElementsAre("edit"));
  EXPECT_THAT(offers("tool ''"), UnorderedElementsAre("run", "edit", "check", "-h", "--help"));
  EXPECT_THAT(offers("tool edit t"), UnorderedElementsAre("trim"));
}

TEST_F(Completion, OffersTheWordsOfAnOptionAlsoAfterAnEqualsSign) {
  EXPECT_THAT(offers("tool run --bus ''"), UnorderedElementsAre("lcm", "none"));
  EXPECT_THAT(offers("tool run --bus = ''"), UnorderedElementsAre("lcm", "none"));
  EXPECT_THAT(offers("tool run --bus = n"), UnorderedElementsAre("none"));
  EXPECT_THAT(offers("tool run --b"), UnorderedElementsAre("--bus"));
}

TEST_F(Completion, OffersFoldersAndTheWordsOfACommand) {
  EXPECT_THAT(offers("tool edit trim --out r"), UnorderedElementsAre("results"));
  EXPECT_THAT(offers("tool check b"), UnorderedElementsAre("bay", "b c.yaml"));
  EXPECT_THAT(offers("tool check --q"), UnorderedElementsAre("--quiet"));
}

TEST_F(Completion, OfZshHasAFunctionPerCommandAndQuotesWhatItsSpecificationsWouldRead) {
  const std::string text = command_line::zsh_completion(app_, {});
  EXPECT_THAT(text, HasSubstr("#compdef tool\n"));
  EXPECT_THAT(text, HasSubstr("_tool_edit_trim() {"));
  EXPECT_THAT(text, HasSubstr("'--out=[folder]:DIR:_files -/'"));
  EXPECT_THAT(text, HasSubstr("'run:Run: it'\\''s [quick]'"));
  EXPECT_THAT(text, HasSubstr("'--bus=[the bus]:BUS:(lcm none)'"));
}

}  // namespace
