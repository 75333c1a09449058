// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

#include "tests/cross_check/exact.hpp"
#include "tests/cross_check/experiments.hpp"
#include "tests/project_paths.hpp"

namespace cross_check {

void PrintTo(const Experiment& experiment, std::ostream* out) {
  *out << experiment.name;
}

namespace {

using std::numbers::pi;

const double any = std::numeric_limits<double>::infinity();

/// Largest error of each quantity of an experiment, with steps of 1 ms and 5 ms.
struct Bars {
  std::vector<double> at_1ms, at_5ms;
  Method method = Method::shoal;
};

const std::map<std::string, Bars>& bars() {
  static const std::map<std::string, Bars> all{
      // The step of free bodies is exact in a parabola.
      {"throw", {{1e-9, 1e-9}, {1e-9, 1e-9}}},
      // It keeps the momentum and the energy, and is of second order in the rate: (h w)^2 / 12 of the period and, near
      // the
      // unstable axis, a few times that.
      {"tumbling", {{5e-5, 1e-6, 1e-9}, {1.25e-3, 1e-6, 1e-9}}},
      // First order in the 0.06 rad or 0.3 rad of a step.  The top falls over with the longer step.
      {"top", {{0.02 * 1.744, 25}, {0.1 * 1.744, any}}},
      // 0.01 % and 1 % of the period; the sway of the energy of ODE's step, h omega / 2, and losses in the
      // joint.
      {"pendulum", {{0.0003, 0.002}, {0.05, 0.06}}},
      // Gaps: a joint that moves with v leaves its circle by v^2 / r h^2 / 2 in a step.
      {"double_pendulum", {{0.003, 0.5}, {0.12, 10}}},
      // Explicit damping: the decay rate and the phase are off by the order of h omega.
      {"spring", {{0.001, 0.0003}, {0.005, 0.0015}}},
      // Half the first step, v h / 2; at rest friction holds.
      {"slope", {{0.001, 0.001}, {0.005, 0.001}}},
      // A ball turns back up to v h deep, h late, and comes up with half the speed, 2 h later; twice until the second
      // top.
      {"bounce", {{0.0045, 0.0045, 0.006}, {0.022, 0.022, 0.03}}},
      // v h / 2 of ODE's step at 4.8 m/s.
      {"rolling", {{0.0026, 0.0026}, {0.0125, 0.0125}}},
      // Five times the layer of 0.5 mm in which contacts stay, and jitter of the iterative solver, which steps where
      // the
      // exact one gives up.
      {"stack", {{0.003, 1, 10}, {0.003, 10, 50}}},
  };
  return all;
}

class InTheExperiment : public testing::TestWithParam<Experiment> {};

INSTANTIATE_TEST_SUITE_P(CrossCheck, InTheExperiment, testing::ValuesIn(experiments()),
                         [](const auto& info) { return info.param.name; });

TEST_P(InTheExperiment, ShoalIsNearTheClosedForm) {
  const Experiment& experiment = GetParam();
  const Bars& of = bars().at(experiment.name);
  for (const auto& [step_s, limits] : {std::pair{0.001, of.at_1ms}, {0.005, of.at_5ms}}) {
    const std::vector<double> values = run(experiment, of.method, step_s);
    ASSERT_EQ(values.size(), experiment.quantities.size());
    ASSERT_EQ(limits.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_LE(std::abs(values[i] - experiment.quantities[i].exact), limits[i])
          << experiment.quantities[i].name << " with " << step_s << " s";
  }
}

// That the models of both engines and the closed forms are of the same experiment: where nothing touches, RK4 with 1 ms
// is almost exact.
TEST_P(InTheExperiment, MujocosRungeKuttaMethodAgreesWithTheClosedForm) {
  static const std::map<std::string, std::vector<double>> limits{
      {"throw", {1e-9, 1e-9}},    {"tumbling", {1e-8, 0.01, 1e-9}},  {"top", {0.001, 0.001}},
      {"pendulum", {1e-8, 1e-9}}, {"double_pendulum", {1e-8, 1e-9}}, {"spring", {1e-8, 1e-8}},
      {"slope", {0.001, 30}},     {"bounce", {0.01, 0.001, 0.05}},   {"rolling", {0.003, 0.003}},
      {"stack", {0.003, 0.1, 1}}};
  if (mujoco_version().empty()) GTEST_SKIP() << "the build has not found libmujoco-dev";
  const Experiment& experiment = GetParam();
  const std::vector<double> values = run(experiment, Method::mujoco_rk4, 0.001);
  const std::vector<double>& limit = limits.at(experiment.name);
  ASSERT_EQ(limit.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_LE(std::abs(values[i] - experiment.quantities[i].exact), limit[i]) << experiment.quantities[i].name;
}

/// Returns the value of a quantity by Shoal at 5 ms in the table of the page; none: the table lacks it.
std::optional<double> value_on_page(const Experiment& experiment, const Quantity& quantity) {
  std::ifstream in(test_support::source_path("docs/models/cross_check/runs.csv"));
  const std::string start = std::string(experiment.name) + ",5,Shoal,", name = quantity.name;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(start) || !(line.ends_with("," + name) || line.ends_with(",\"" + name + "\""))) continue;
    std::istringstream cells(line.substr(start.size()));
    std::string cell;
    for (int i = 0; i < 3; ++i) std::getline(cells, cell, ',');  // time of a step, closed form, value
    return std::stod(cell);
  }
  return std::nullopt;
}

// A page of an older version of the physics is refused.  Chaotic motion depends on the compiler's rounding.
TEST_P(InTheExperiment, ThePageHasTheFiguresOfThisVersion) {
  const Experiment& experiment = GetParam();
  const bool is_compared = experiment.name != "double_pendulum" && experiment.name != "stack";
  const std::vector<double> values =
      is_compared ? run(experiment, Method::shoal, 0.005) : std::vector<double>(experiment.quantities.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Quantity& quantity = experiment.quantities[i];
    const std::optional<double> of_page = value_on_page(experiment, quantity);
    ASSERT_TRUE(of_page) << "no row of Shoal with " << quantity.name;
    if (!is_compared) continue;
    const double error = values[i] - quantity.exact;
    EXPECT_NEAR(*of_page, values[i], 0.05 * std::abs(error) + 1e-5 * std::abs(values[i]) + 1e-8)
        << quantity.name << ": run cross_check --page docs/models/cross_check.md";
  }
}

TEST(CrossCheckExact, SmallSwingsHaveThePeriodOfTheLinearPendulum) {
  EXPECT_NEAR(pendulum_period_s(2, 1e-4), pi, 1e-8);
  // T / T0 = 1.5276 to 1.5277 for 135 degrees in tables; 1 + a^2/16 + 11 a^4/3072 to fourth order.
  EXPECT_NEAR(pendulum_period_s(1, 0.3) / (2 * pi), 1 + 0.09 / 16 + 11 * 0.0081 / 3072, 1e-6);
}

TEST(CrossCheckExact, ASymmetricBodyTumblesWithItsNutation) {
  // Euler's equations of a body with equal moments I about x and y: the rate is (I3 - I) w3 / I.
  const double rate = (3 - 2) * 5.0 / 2;
  EXPECT_NEAR(tumbling_period_s({2, 2, 3}, {0.3, 0.4, 5}), 2 * pi / rate, 1e-12);
  const double other_rate = (3 - 2) * 5.0 / 3;
  EXPECT_NEAR(tumbling_period_s({2, 3, 3}, {5, 0.4, 0.3}), 2 * pi / other_rate, 1e-12);
}

TEST(CrossCheckExact, AFastTopPrecessesByTorqueOverAngularMomentum) {
  EXPECT_NEAR(precession_radps(0.05, 0.02, 1e5, 0.5, 2), 2 / (0.02 * 1e5), 1e-9);
  // The closed form fulfils the equation of steady precession.
  const double rate = precession_radps(0.05, 0.02, 60, 0.5, 2);
  EXPECT_NEAR(0.05 * std::cos(0.5) * rate * rate - 0.02 * 60 * rate + 2, 0, 1e-12);
}

}  // namespace
}  // namespace cross_check
