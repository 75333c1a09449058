// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/run_metrics.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <limits>

#include "experiment/results/run_record.hpp"
#include "sim/world_file/metric_registry.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::ElementsAre;

/// A run with the figures of these metrics of the type distance, each 5, and its world.
experiment::RunRecord run_in(const test_support::ScratchFolder& folder, const std::vector<std::string>& names,
                             const std::string& world) {
  experiment::RunRecord run;
  run.directory = folder.file("");
  for (const std::string& name : names)
    for (const sim::FigureKind& figure : sim::MetricRegistry::instance().find("distance")->figures)
      run.metrics[name + "." + figure.name] = 5;
  if (!world.empty()) std::ofstream(folder.file("world.yaml")) << world;
  return run;
}

std::vector<std::string> names_of(const std::vector<experiment::RunMetric>& metrics) {
  std::vector<std::string> names;
  for (const experiment::RunMetric& metric : metrics) names.push_back(metric.name);
  return names;
}

TEST(RunMetrics, HaveTheTypeThatTheirFiguresTell) {
  const test_support::ScratchFolder folder;
  const auto metrics = experiment::metrics_of(run_in(folder, {"way"}, ""));
  ASSERT_EQ(metrics.size(), 1u);
  ASSERT_NE(metrics[0].kind, nullptr);
  EXPECT_EQ(metrics[0].kind->word, "distance");
  EXPECT_EQ(metrics[0].value(metrics[0].figures.front().name), 5);
  EXPECT_FALSE(metrics[0].value("no_such_figure"));
}

TEST(RunMetrics, AreInTheOrderOfTheWorldWithItsVehicles) {
  const test_support::ScratchFolder folder;
  EXPECT_THAT(names_of(experiment::metrics_of(run_in(folder, {"a", "b"}, ""))), ElementsAre("a", "b"));
  const auto metrics = experiment::metrics_of(run_in(
      folder, {"a", "b"}, "metrics: [{name: b, type: distance, vehicle: r1}, {name: a, vehicle: r2, channel: c}]\n"));
  EXPECT_THAT(names_of(metrics), ElementsAre("b", "a"));
  EXPECT_EQ(metrics[0].vehicle, "r1");
  EXPECT_EQ(metrics[1].channel, "c");
  EXPECT_EQ(metrics[1].dimensions, 2);
}

TEST(RunMetrics, ValuesThatAreNoneStayUnset) {
  const test_support::ScratchFolder folder;
  experiment::RunRecord run;
  run.directory = folder.file("");
  run.metrics = {{"own.x", std::nullopt}, {"own.y", std::numeric_limits<double>::infinity()}, {"plain", 3}};
  const auto metrics = experiment::metrics_of(run);
  ASSERT_THAT(names_of(metrics), ElementsAre("own", "plain"));
  EXPECT_EQ(metrics[0].kind, nullptr);
  EXPECT_FALSE(metrics[0].value("x"));
  EXPECT_FALSE(metrics[0].value("y"));
  EXPECT_EQ(metrics[1].value(""), 3);
}

TEST(RunMetrics, UnitsAreThoseOfKnownFiguresThatHaveOne) {
  std::vector<std::string> figures{"own.thing"};
  for (const sim::FigureKind& figure : sim::MetricRegistry::instance().find("distance")->figures)
    figures.push_back("way." + figure.name);
  const auto units = experiment::units_of(figures);
  EXPECT_FALSE(units.contains("own.thing"));
  EXPECT_EQ(units.at("way." + sim::MetricRegistry::instance().find("distance")->figures.front().name), "m");
}

TEST(RunMetrics, NumbersHaveFourDigitsOrAreWhole) {
  EXPECT_EQ(experiment::figure_text(0.912345), "0.9123");
  EXPECT_EQ(experiment::figure_text(12), "12");
  EXPECT_EQ(experiment::figure_text(12345.6), "12346");
  EXPECT_EQ(experiment::figure_text(1e20), "1e+20");
  EXPECT_EQ(experiment::figure_text(std::nullopt), "none");
  EXPECT_EQ(experiment::figure_text(std::numeric_limits<double>::quiet_NaN()), "none");
}

TEST(RunMetrics, AUnitFollowsItsNumber) {
  const sim::FigureKind meters{"rms_m", "m", "an error"}, ratio{"share", "1", "a share"};
  EXPECT_EQ(experiment::figure_with_unit({"rms_m", 0.5, &meters}), "0.5 m");
  EXPECT_EQ(experiment::figure_with_unit({"share", 0.5, &ratio}), "0.5");
  EXPECT_EQ(experiment::figure_with_unit({"own", 0.5, nullptr}), "0.5");
  EXPECT_EQ(experiment::figure_with_unit({"rms_m", std::nullopt, &meters}), "none");
}

}  // namespace
