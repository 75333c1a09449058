// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/gnuplot.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using lcm_test::ScratchFolder;
using namespace std::chrono_literals;

const auto never = [] { return false; };

bool run(const ScratchFolder& folder, const std::string& script, std::chrono::milliseconds limit,
         const std::function<bool()>& give_up) {
  std::ofstream(folder.file("plot.gp")) << script;
  return experiment::run_gnuplot(folder.file(""), "plot.gp", limit, give_up);
}

TEST(Gnuplot, TextsAreQuoted) {
  EXPECT_EQ(experiment::gnuplot_text("harbor"), "'harbor'");
  EXPECT_EQ(experiment::gnuplot_text("it's"), "'it''s'");
  EXPECT_EQ(experiment::gnuplot_text("a\nb\x7f"), "'a b '");
}

TEST(Gnuplot, AxisOfErrorsIsLogarithmicWhereTheyAreVeryDifferent) {
  EXPECT_EQ(experiment::axis_of_errors({1, 5}), "set yrange [0:*]\n");
  EXPECT_EQ(experiment::axis_of_errors({6, 1}), "set logscale y\nset yrange [0.05:*]\n");
  for (const std::vector<double>& errors_m : {std::vector<double>{}, {3}, {0, 3}})
    EXPECT_EQ(experiment::axis_of_errors(errors_m), "set yrange [0:*]\n");
}

TEST(Gnuplot, ReportsWhetherTheScriptRan) {
  const ScratchFolder folder;
  EXPECT_TRUE(run(folder, "x = 1\n", 30s, never));
  EXPECT_FALSE(run(folder, "nonsense\n", 30s, never));
}

TEST(Gnuplot, IsKilledWhenItTakesTooLong) {
  const ScratchFolder folder;
  EXPECT_FALSE(run(folder, "do for [i = 1:1000000000] {x = i}\n", 200ms, never));
}

TEST(Gnuplot, IsKilledWhenItWaits) {
  const ScratchFolder folder;
  EXPECT_FALSE(run(folder, "pause 1000\n", 20ms, never));
}

TEST(Gnuplot, IsKilledWhenNoOneWaits) {
  const ScratchFolder folder;
  int looks = 0;
  EXPECT_FALSE(run(folder, "pause 1000\n", 30s, [&] { return ++looks > 20; }));
  EXPECT_EQ(looks, 21);  // and no more
}

}  // namespace
