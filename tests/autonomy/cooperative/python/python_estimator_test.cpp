// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "autonomy/cooperative/driver/navigator.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace navigation;
using test::nav_second;
using test::nav_setup;
using test::received_from;
using test::started;

std::string error_of(const std::string& algorithm) {
  try {
    started(algorithm, nav_setup(2, 0, {0, 0}, 1))->now(0);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

/// A class `Mine` with these lines in its own file.
std::string python_with(const test_support::ScratchFolder& folder, const std::string& name, const std::string& lines) {
  std::ofstream(folder.file(name + ".py")) << "class Mine:\n" << lines;
  return "python:" + folder.file(name) + ".Mine";
}

TEST(PythonEstimator, IsNotListedAmongTheAlgorithmsOfTheProgram) {
  const test_support::ScratchFolder folder;
  const std::string name = python_with(folder, "listed", "  def __init__(self):\n    pass\n");
  EXPECT_EQ(&algorithm_named(name), &algorithm_named(name));
  for (const Algorithm* algorithm : all_algorithms()) EXPECT_FALSE(algorithm->name.starts_with("python:"));
}

TEST(PythonEstimator, TheExampleIsTheNaiveFilter) {
  const std::string example = "python:" + test_support::source_path("examples/navigation/naive.Naive");
  navigation::Setup setup = nav_setup(2, 0, {10, 20}, 2);
  setup.team[0].errors = {.heading_bias_rad = 0.05,
                          .heading_walk_radprts = 0.001,
                          .slow_heading_rad = 0.02,
                          .slow_heading_time_s = 20,
                          .speed_scale = 0.03,
                          .clock_s = 0.001,
                          .clock_drift = 1e-6,
                          .clock_walk_srts = 1e-6};
  const auto python = started(example, setup), cpp = started("naive", setup);
  const Bytes payload = started("naive", nav_setup(2, 1, {-300, 50}, 3))->make_payload(0, 100);
  for (Estimator* each : {python.get(), cpp.get()}) {
    Matrix2 q;
    q << 0.2, 0.05, 0.05, 0.1;
    each->predict(10 * nav_second, {1, -0.5}, q);
    each->on_range(received_from(1, payload, 325, 1, 10 * nav_second));
    each->predict(20 * nav_second, {1, -0.5}, q);
    each->fix(20 * nav_second, {31, 9}, 2);
  }
  const Estimate a = python->now(21 * nav_second), b = cpp->now(21 * nav_second);
  EXPECT_LT(
      (a.p_W - b.p_W).norm(),
      0.01);  // the other one turns velocities by sine and cosine, and adds the variance of the bend, 3 (5 / 650)^2 m^2
  EXPECT_LT((a.P - b.P).norm(), 0.01);
  EXPECT_EQ(python->make_payload(20 * nav_second, 100).size(), position_bytes);
}

TEST(PythonEstimator, ACopyIsIndependent) {
  const auto first =
      started("python:" + test_support::source_path("examples/navigation/naive.Naive"), nav_setup(2, 0, {0, 0}, 1));
  const auto copy = first->clone();
  first->predict(nav_second, {1, 0}, Matrix2::Zero());
  EXPECT_NEAR(first->now(nav_second).p_W.x(), 1, 1e-12);
  EXPECT_NEAR(copy->now(0).p_W.x(), 0, 1e-12);
}

TEST(PythonEstimator, AMistakeIsSaidWithItsLine) {
  const test_support::ScratchFolder folder;
  const std::string start = "  def start(self, s): self.x = s.position\n";
  EXPECT_NE(error_of(python_with(folder, "a", start + "  def now(self, t): return self.y, 1\n"))
                .find(".Mine: AttributeError: 'Mine' object has no attribute 'y' (a.py:3)"),
            std::string::npos);
  EXPECT_NE(error_of(python_with(folder, "b", "  def start(self, s) return\n")).find("SyntaxError"), std::string::npos);
  EXPECT_NE(
      error_of(python_with(folder, "c", start + "  def now(self, t): return [float('nan'), 0], [[1, 0], [0, 1]]\n"))
          .find("not finite"),
      std::string::npos);
  EXPECT_NE(error_of(python_with(folder, "n", start + "  def now(self, t): return [0, 0], [[-1, 0], [0, 1]]\n"))
                .find("symmetric and positive definite"),
            std::string::npos);
  EXPECT_NE(error_of(python_with(folder, "o", start + "  def now(self, t): return [0, 0, 0], [[1, 0], [0, 1]]\n"))
                .find("two coordinates"),
            std::string::npos);
}

TEST(PythonEstimator, OnlyAValueErrorOfItsStartMeansThatItCannotWork) {
  const test_support::ScratchFolder folder;
  const auto start = [&](const std::string& name, const std::string& lines) {
    started(python_with(folder, name, lines), nav_setup(2, 0, {0, 0}, 1))->now(0);
  };
  EXPECT_THROW(start("f", "  def start(self, s): self.y\n"), EstimatorFailure);
  EXPECT_THROW(start("g", "  def start(self, s): pass\n  def now(self, t): raise ValueError('no')\n"),
               EstimatorFailure);
  try {
    start("h", "  def start(self, s): raise ValueError('needs a third vehicle')\n");
    FAIL();
  } catch (const EstimatorFailure&) {
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("needs a third vehicle"), std::string::npos);
  }
}

TEST(PythonEstimator, AClassMayHaveDataclassesAndKnowsTheErrorsOfTheTeam) {
  const test_support::ScratchFolder folder;
  const std::string file = folder.file("z");
  std::ofstream(file + ".py") << "from __future__ import annotations\n"
                                 "from dataclasses import dataclass\n"
                                 "@dataclass\n"
                                 "class State:\n"
                                 "  x: float = 3\n"
                                 "class Mine:\n"
                                 "  def start(self, s): self.s = State(s.team_errors[1]['clock_s'] + s.seed)\n"
                                 "  def now(self, t): return [self.s.x, 0], [[1, 0], [0, 1]]\n";
  navigation::Setup setup = nav_setup(2, 0, {0, 0}, 1);
  setup.team[1].errors.clock_s = 0.25;
  setup.seed = 7;
  EXPECT_EQ(started("python:" + file + ".Mine", setup)->now(0).p_W.x(), 7.25);
}

TEST(PythonEstimator, AFileThatEndsItsInterpreterIsSaid) {
  const test_support::ScratchFolder folder;
  python_with(folder, "q", "  pass\nimport os\nos._exit(0)\n");
  EXPECT_NE(error_of("python:" + folder.file("q") + ".Mine").find("its interpreter has ended"), std::string::npos);
}

/// Sets an environment variable for a scope.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
  ~Environment() { unsetenv(name_); }

 private:
  const char* name_;
};

TEST(PythonEstimator, AClassThatNeverReturnsIsSaidAfterTheLimit) {
  const test_support::ScratchFolder folder;
  const std::string start = "  def start(self, s): pass\n", sleep = "import time; time.sleep(1000)\n";
  // Long enough for the interpreter to start.
  const Environment limit("SHOAL_PYTHON_LIMIT_S", "3");
  EXPECT_NE(error_of(python_with(folder, "s", start + "  def now(self, t): " + sleep))
                .find("s.Mine: no answer within 3 s to now() or a call before it; SHOAL_PYTHON_LIMIT_S is the limit"),
            std::string::npos);
  // One that takes no calls: they fill the pipe, of 64 kB.
  const auto stuck =
      started(python_with(folder, "m", start + "  def predict(self, t, v, q): " + sleep), nav_setup(2, 0, {0, 0}, 1));
  EXPECT_THROW(
      {
        for (int i = 1; i < 10'000; ++i) stuck->predict(i * nav_second, {1, 0}, Matrix2::Zero());
      },
      std::invalid_argument);
}

TEST(PythonEstimator, AWrongLimitIsSaid) {
  const test_support::ScratchFolder folder;
  const std::string source = python_with(folder, "w", "  def start(self, s): pass\n");
  for (const char* wrong : {"soon", "0", "nan", ""}) {
    const Environment limit("SHOAL_PYTHON_LIMIT_S", wrong);
    EXPECT_EQ(error_of(source),
              std::string("SHOAL_PYTHON_LIMIT_S must be a number from 0.01 to 1e6, got '") + wrong + "'");
  }
}

TEST(PythonEstimator, TheTimeOfTheInterpreterCounts) {
  const test_support::ScratchFolder folder;
  const std::string source = python_with(folder, "t",
                                         "  def start(self, s): pass\n"
                                         "  def now(self, t):\n"
                                         "    import time\n"
                                         "    end = time.process_time() + 0.05\n"
                                         "    while time.process_time() < end: pass\n"
                                         "    return [0, 0], [[1, 0], [0, 1]]\n");
  const auto own = started(source, nav_setup(2, 0, {0, 0}, 1));
  const AlgorithmClock clock(algorithm_named(source));
  own->now(0);
  EXPECT_GE(clock.elapsed_s(), 0.05);
}

TEST(PythonEstimator, WhatIsNotThereIsSaid) {
  EXPECT_NE(error_of("python:/nowhere/file.Mine").find("FileNotFoundError"), std::string::npos);
  EXPECT_EQ(error_of("python:Mine"), "an algorithm in Python is python:FILE.Class, got 'python:Mine'");
  const test_support::ScratchFolder folder;
  python_with(folder, "d", "  pass\n");
  EXPECT_NE(error_of("python:" + folder.file("d") + ".Other").find("has no class Other"), std::string::npos);
}

TEST(PythonEstimator, PlainListsAreEnough) {
  const test_support::ScratchFolder folder;
  const auto own =
      started(python_with(folder, "e",
                          "  def start(self, s): self.x = list(s.position); self.t = s.time\n"
                          "  def predict(self, t, v, q): self.x[0] += v[0] * (t - self.t); self.t = t; print('moved')\n"
                          "  def make_payload(self, t, max_bytes): return bytes([1, 2, max_bytes])\n"
                          "  def now(self, t): return self.x, [[1, 0], [0, 1]]\n"),
              nav_setup(2, 0, {5, 0}, 1));
  own->predict(2 * nav_second, {1, 0}, Matrix2::Zero());
  own->on_bearing({});
  EXPECT_NEAR(own->now(2 * nav_second).p_W.x(), 7, 1e-9);
  EXPECT_EQ(own->make_payload(2 * nav_second, 22), (Bytes{1, 2, 22}));
}

}  // namespace
