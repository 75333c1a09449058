// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/gauss_markov.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/fidelity/closed_forms.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using sim::Time;
using sim::Vector3d;
using test::closed_forms_of;
using test::expect_closed_form;

sim::GaussMarkov process() {
  return {sim::Vector3d(1, 2, 3), 0.05, sim::Random(1, "process")};  // a tick each millisecond
}

TEST(GaussMarkov, AFarTimeIsReachedAtOnceAndHasTheSameValues) {
  sim::GaussMarkov stepped = process(), at_once = process();
  for (std::int64_t us = 0; us <= 200'000'000; us += 100'000) stepped.advance_to(Time{us});
  at_once.advance_to(Time{200'000'000});
  EXPECT_EQ(at_once.values(), stepped.values());
  at_once.advance_to(Time{std::int64_t{1} << 62});  // would take thousands of years tick by tick
  EXPECT_TRUE(at_once.values().allFinite());
}

TEST(GaussMarkov, IsDiscretisedExactly) {
  // std = sigma_w / sqrt(2 mu), T = 1 / mu.
  for (const auto& form : closed_forms_of("gauss_markov", "exact_discrete_noise_std")) {
    const double mu = form.at("mu"), std = form.at("sigma_w") / std::sqrt(2 * mu);
    EXPECT_NEAR(sim::fresh_std(std, form.at("dt"), 1 / mu), form.expected, 1e-11);
  }
  for (const auto& form : closed_forms_of("gauss_markov", "autocorrelation"))
    EXPECT_NEAR(sim::kept_share(form.at("lag"), 1 / form.at("mu")), form.expected, 1e-10);
}

TEST(GaussMarkov, HasItsVarianceAndCorrelation) {
  sim::GaussMarkov process(Vector3d(0.05, 0.05, 0.05), 50, sim::Random(3, "test"));
  // 3 x 1e5 samples a second apart, T = 50 s: of 2e3 x 3 independent ones each, the standard error of the variance is
  // sqrt(2 / 6000) = 2 %.  The tolerance is that of closed_forms.csv, which is 5 of them.
  double squares = 0, products = 0;
  std::vector<Vector3d> values;
  for (int i = 0; i < 100000; ++i) {
    process.advance_to(Time{std::int64_t{i} * 1000000});
    values.push_back(process.values());
  }
  for (std::size_t i = 0; i + 10 < values.size(); ++i) {
    squares += values[i].squaredNorm();
    products += values[i].dot(values[i + 10]);
  }
  expect_closed_form(squares / (3.0 * 99990), "gauss_markov", "sigma_w=0.01;mu=0.02", "stationary_variance");
  expect_closed_form(products / squares, "gauss_markov", "mu=0.02;lag=10", "autocorrelation");
}

TEST(GaussMarkov, DoesNotDependOnTheStepsThatLedThere) {
  sim::GaussMarkov fine(Vector3d::Ones(), 7, sim::Random(3, "test")),
      coarse(Vector3d::Ones(), 7, sim::Random(3, "test"));
  for (int ms = 0; ms <= 20000; ms += 5) fine.advance_to(Time{std::int64_t{ms} * 1000});
  coarse.advance_to(Time{20000000});
  EXPECT_EQ(fine.values(), coarse.values());
  EXPECT_EQ(test::state_hash_of(fine), test::state_hash_of(coarse));
}

}  // namespace
