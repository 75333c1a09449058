// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/tools/command_line/arguments_fixture.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/help.hpp"
#include "tools/command_line/parse.hpp"

namespace {

using namespace arguments_fixture;
using namespace command_line;

using Words = std::vector<std::string>;

std::string wrong(const Words& words) {
  App app;
  return read_arguments(app.app, words).wrong;
}

TEST(Arguments, NamesWhatIsUnknownAndWhatWasMeant) {
  EXPECT_EQ(wrong({"rum"}), "unknown command 'rum'; did you mean 'run'?");
  EXPECT_EQ(wrong({"zzzzzz"}), "unknown command 'zzzzzz'; known commands: run, log");
  EXPECT_EQ(wrong({"a.yaml"}), "unknown command 'a.yaml'; did you mean 'prog run a.yaml'?");
  EXPECT_EQ(wrong({"log", "inof"}), "unknown command 'inof'; did you mean 'info'?");
  EXPECT_EQ(wrong({"run", "--durration", "3"}), "unknown option '--durration'; did you mean '--duration'?");
  EXPECT_EQ(wrong({"run", "--durration=3"}), "unknown option '--durration'; did you mean '--duration'?");
  EXPECT_EQ(wrong({"run", "-duration", "3"}), "unknown option '-duration'; did you mean '--duration'?");
  EXPECT_EQ(wrong({"run", "--dur", "3"}), "unknown option '--dur'; did you mean '--duration'?");
  EXPECT_EQ(wrong({"run", "--frobnicate"}), "unknown option '--frobnicate'");
  EXPECT_EQ(wrong({"--quiet"}), "unknown option '--quiet'");
  EXPECT_EQ(wrong({"run", "a", "b"}), "unexpected argument 'b'; it follows WORLD");
  EXPECT_EQ(wrong({"log", "csv", "x"}), "unexpected argument 'x'; it takes options only");
}

TEST(Arguments, MustBeThereAndOnlyOnce) {
  EXPECT_EQ(wrong({}), "needs a command: run or log");
  EXPECT_EQ(wrong({"log"}), "needs a command: info or csv");
  EXPECT_EQ(wrong({"log", "info"}), "LOG is required");
  EXPECT_EQ(wrong({"log", "csv"}), "--out is required");
  EXPECT_EQ(wrong({"run", "--duration"}), "--duration needs a value: --duration S");
  EXPECT_EQ(wrong({"run", "--record", "--quiet"}), "--record needs a value: --record FILE; '--quiet' follows it");
  EXPECT_EQ(wrong({"run", "--duration", "1", "--duration=2"}), "--duration is given twice");
  EXPECT_EQ(wrong({"run", "--quiet=yes"}), "--quiet takes no value, got 'yes'");
  EXPECT_EQ(wrong({"run", ""}), "WORLD must not be empty");
  EXPECT_EQ(wrong({"run", "--record", ""}), "--record must not be empty");
  EXPECT_EQ(wrong({"run", "--quiet", "--quiet", "--set", "a=1", "--set", "b=2"}), "");
}

TEST(Arguments, StayOnOneLineAndCommandNoTerminal) {
  EXPECT_EQ(wrong({"ru\n\x1b[31m"}), "unknown command 'ru\\n\\x1b[31m'; known commands: run, log");
  EXPECT_EQ(wrong({"run", "--größe"}), "unknown option '--größe'");
  EXPECT_LT(wrong({std::string(1'000'000, 'x')}).size(), 200u);
}

TEST(Arguments, ReachTheOptionsAsTheyWereGiven) {
  const auto parsed = [](const Words& words, const auto& look) {
    App app;
    Arguments arguments = read_arguments(app.app, words);
    ASSERT_EQ(arguments.wrong, "");
    app.app.parse(std::move(arguments.for_cli11));
    look(app);
  };
  parsed({"run", "--duration", "-4.5", "w"}, [](const App& app) {
    EXPECT_EQ(app.number, -4.5);
    EXPECT_EQ(app.place, "w");
  });
  parsed({"run", "--set", "x=-1,2", "w", "--record", "-"}, [](const App& app) {
    EXPECT_EQ(app.sets, Words{"x=-1,2"});
    EXPECT_EQ(app.file, "-");
  });
  parsed({"run", "--title=", "w"}, [](const App& app) {
    EXPECT_EQ(app.title, "");
    EXPECT_EQ(app.place, "w");  // CLI11 alone would take it for the value of --title
  });
  parsed({"run", "--record=--odd", "--", "--quiet"}, [](const App& app) {
    EXPECT_EQ(app.file, "--odd");
    EXPECT_EQ(app.place, "--quiet");
    EXPECT_FALSE(app.quiet);
  });
  parsed({"run", "++"}, [](const App& app) { EXPECT_EQ(app.place, "++"); });
  parsed({"run", "run", "--no-plots"}, [](const App& app) {
    EXPECT_EQ(app.place, "run");
    EXPECT_FALSE(app.plots);
  });
}

TEST(Arguments, AskForHelpInEveryPlace) {
  for (const Words& words :
       {Words{"run", "--help"}, {"run", "--frob", "--help"}, {"run", "-h", "a", "b"}, {"help", "run"}}) {
    App app;
    const Arguments arguments = read_arguments(app.app, words);
    EXPECT_TRUE(arguments.help);
    EXPECT_EQ(command_path(*arguments.command), "prog run");
  }
}

}  // namespace
