// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_config.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "experiment/report/report_page.hpp"
#include "experiment/results/results.hpp"
#include "experiment/study/study_curves.hpp"
#include "experiment/study/study_results.hpp"
#include "tests/experiment/study/study_folder.hpp"

namespace {

using namespace study_folder;

using testing::HasSubstr;

TEST(StudyConfig, ReportsWhatIsWrong) {
  const auto error = [](const std::string& more, const std::string& seeds = "[1]") {
    return StudyFolder(more, seeds).error();
  };
  EXPECT_EQ(error(two_cases), "");
  EXPECT_THAT(error("", "[]"), HasSubstr("study.yaml:4:8: 'seeds' must have at least one seed"));
  EXPECT_THAT(error("", "[1, 1]"), HasSubstr("'seeds' must differ from each other"));
  EXPECT_THAT(error("", "~"), HasSubstr("study.yaml:4:8: 'seeds' must have at least one seed"));
  EXPECT_THAT(error("plots: [{name: p, figure: ''}]\n"), HasSubstr("'figure' must not be empty"));
  EXPECT_THAT(error("plots: [{name: p, metrics: [], over: time}]\n"), HasSubstr("'metrics' must not be empty"));
  EXPECT_THAT(error("", "[1.5]"), HasSubstr("'seeds' must be whole numbers, got 1.5"));
  EXPECT_THAT(error("", "[-1]"), HasSubstr("must be >= 0"));
  EXPECT_THAT(error("", "{first: 3}"), HasSubstr("missing key 'count'"));
  EXPECT_THAT(error("", "{count: 0}"), HasSubstr("'count' must be >= 1"));
  EXPECT_THAT(error("sedes: 3\n"), HasSubstr("unknown key 'sedes'"));
  EXPECT_THAT(error("cases: [{name: a}, {name: a}]\n"), HasSubstr("duplicate case 'a'"));
  EXPECT_THAT(error("cases: [{name: ../a}]\n"), HasSubstr("a name must be made of"));
  EXPECT_THAT(error("cases: [{name: a, set: 3}]\n"), HasSubstr("'set' must be a map, got '3'"));
  EXPECT_THAT(error("cases: [{name: a, set: {vehicles.r9.name: x}}]\n"), HasSubstr("r9"));
  EXPECT_THAT(error("cases: [{name: a, set: {physics.step_s: -1}}]\n"), HasSubstr("'step_s' must be"));
  EXPECT_THAT(error("cases: [{name: a, set: {run.duration_s: forever}}]\n"),
              HasSubstr("case 'a': its world runs without end"));
  EXPECT_THAT(error("figures: [e.rms]\n"), HasSubstr("study.yaml:5:10: 'figures' names nothing in this world: 'e.rms'; "
                                                     "known: e.final_m, e.max_gap_s, e.max_m, e.per_distance_percent"));
  EXPECT_THAT(error("plots: [{name: p}]\n"), HasSubstr("plot 'p': needs either 'figure' or 'metrics'"));
  EXPECT_THAT(error("plots: [{name: p, metrics: [e]}]\n"), HasSubstr("'metrics' are drawn over 'distance' or 'time'"));
  EXPECT_THAT(error("plots: [{name: p, metrics: [f], over: time}]\n"), HasSubstr("names nothing in this world: 'f'"));
  EXPECT_THAT(error("plots: [{name: p, figure: passed, cases: [b]}]\n"), HasSubstr("names no case 'b'"));
}

TEST(StudyConfig, ReportsWhatIsWrongWithFactorsAndTheirDesign) {
  const auto error = [](const std::string& factor, const std::string& more = "") {
    return StudyFolder("factors:\n  - {name: g, paths: [physics.gravity_mps2], " + factor + "}\n" + more).error();
  };
  EXPECT_EQ(error("values: [1, 2]"), "");
  EXPECT_EQ(error("from: 1, to: 2, levels: 3"), "");
  EXPECT_EQ(error("from: 1, to: 2", "design: {type: sobol, points: 7}\n"), "");
  EXPECT_THAT(error("from: 1, to: 2"), HasSubstr("study.yaml:6:5: factor 'g': a range in a grid needs 'levels'"));
  EXPECT_THAT(error("values: []"), HasSubstr("'values' must not be empty"));
  EXPECT_THAT(error("from: 1"), HasSubstr("factor 'g': has 'from' but no 'to'"));
  EXPECT_THAT(error("from: 2, to: 1, levels: 2"), HasSubstr("'to' must be greater than 'from', got 1"));
  EXPECT_THAT(error("values: [1], from: 1, to: 2"), HasSubstr("needs either 'values' or 'from' and 'to', not both"));
  EXPECT_THAT(error("from: 0, to: 1, levels: 2, scale: log"), HasSubstr("'from' must be > 0 with 'scale: log', got 0"));
  EXPECT_THAT(error("values: [1, x]"), HasSubstr("factor 'g': value x: "));
  EXPECT_THAT(error("values: [1]", "design: {type: random}\n"), HasSubstr("needs 'points'"));
  EXPECT_THAT(error("values: [1]", "design: {points: 3}\n"), HasSubstr("a grid has no 'points'"));
  EXPECT_THAT(error("values: [1]", "design: {type: sobol, points: 3, seed: 2}\n"),
              HasSubstr("only the designs random and latin_hypercube have a 'seed'"));
  EXPECT_THAT(StudyFolder("design: {type: grid}\n").error(), HasSubstr("'design' needs 'factors'"));
  EXPECT_THAT(StudyFolder("factors: [{name: seed, paths: [a], values: [1]}]\n").error(),
              HasSubstr("'name' must not be that of another column of the tables, got 'seed'"));
  EXPECT_THAT(StudyFolder("batch: 5\n").error(), HasSubstr("'batch' needs 'until'"));
  EXPECT_THAT(StudyFolder("until: ci(e.rms) < 5 %\n").error(),
              HasSubstr("'until' names nothing in this world: 'e.rms'"));
}

TEST(StudyConfig, PointsAtTheMistakeInARule) {
  const auto error = [](const std::string& rule) {
    const std::string text = StudyFolder("pass: ['" + rule + "']\n", "[1]").error();
    const std::size_t at = text.find("study.yaml:5:");
    return at == std::string::npos ? text : text.substr(at + 13);
  };
  EXPECT_EQ(error("mean(world.passed) == 1"), "");
  EXPECT_EQ(error("max(world.e.rms_m) < 0.5 * min(world.e.rms_m)"), "");
  // The text begins at column 9.
  EXPECT_EQ(error("avg(world.e.rms_m) < 1"),
            "9: rule 1: unknown statistic 'avg'; known statistics: mean, std, min, max, median");
  EXPECT_THAT(error("meam(world.e.rms_m) < 1"), HasSubstr("did you mean 'mean'?"));
  EXPECT_EQ(error("max(word.e.rms_m) < 1"),
            "13: rule 1: unknown case 'word'; known cases: world; did you mean 'world'?");
  EXPECT_EQ(error("1 > max(world.x.rms_m)"), "23: rule 1: unknown metric 'x'; known metrics: e");
  EXPECT_THAT(error("max(world.e.rms) < 1"), HasSubstr("21: rule 1: metric 'e' has no figure 'rms'; figures: rms_m, "));
  EXPECT_THAT(error("max(world.e) < 1"), HasSubstr("19: rule 1: 'e' is a metric; a rule names one of its figures"));
  EXPECT_EQ(error("max(world) < 1"), "13: rule 1: case 'world' needs one of its figures, such as world.passed");
  const std::string known = "'; statistics: mean, std, min, max, median";
  const std::string needs = "9: rule 1: a rule of a study needs a statistic over the seeds, such as 'mean(";
  EXPECT_EQ(error("world.e.rms_m < 1"), needs + "world.e.rms_m)" + known);
  EXPECT_EQ(error("e.rms_m < 1"), needs + "world.e.rms_m)" + known);
  EXPECT_EQ(error("passed == 1"), needs + "world.passed)" + known);
  EXPECT_THAT(error("nan < 1"), HasSubstr("9: rule 1: 'nan' is neither a number nor a statistic"));
  EXPECT_EQ(error("max(world.e.rms_m)"), "27: rule 1: the rule has no comparison; write one of < <= > >= == !=");
}

TEST(StudyConfig, RefusesRulesThatAreNoText) {
  EXPECT_THAT(StudyFolder("pass: [{case: a, figure: e.rms_m, below: 1}]\n", "[1]").error(),
              HasSubstr("rule 1: a rule is text, a comparison such as"));
  EXPECT_THAT(StudyFolder("pass: passed\n").error(), HasSubstr("'pass' must be a list of rules, got 'passed'"));
}

using namespace study_folder;

using testing::ElementsAre;
using testing::HasSubstr;

TEST(StudyConfig, ReadsRangesOfSeeds) {
  const auto seeds = [](const std::string& text) {
    return experiment::load_study(StudyFolder("", text).path()).config.seeds;
  };
  EXPECT_THAT(seeds("3-6"), ElementsAre(3, 4, 5, 6));
  EXPECT_THAT(seeds("7 - 7"), ElementsAre(7));
  EXPECT_THAT(seeds("[1-3, 8]"), ElementsAre(1, 2, 3, 8));
  const auto error = [](const std::string& text) { return StudyFolder("", text).error(); };
  EXPECT_THAT(error("10-1"), HasSubstr("study.yaml:4:8: 'seeds' must be ranges from the lower to the higher seed, got "
                                       "'10-1'"));
  EXPECT_THAT(error("[1-3, 2]"), HasSubstr("'seeds' must differ from each other"));
  EXPECT_THAT(error("[1-3, x]"), HasSubstr("'seeds' must be whole numbers from 0 to 2^53 or ranges such as 1-10, got "
                                           "'x'"));
  EXPECT_THAT(error("1-200000"), HasSubstr("'seeds' must be at most 100000"));
}

TEST(StudyConfig, TakesSeedsAndDurationOfTheCommandLineInstead) {
  EXPECT_THAT(experiment::parse_seeds("1-3,8"), ElementsAre(1, 2, 3, 8));
  EXPECT_THROW(experiment::parse_seeds("1,"), std::invalid_argument);
  EXPECT_THROW(experiment::parse_seeds("1,1"), std::invalid_argument);
  EXPECT_THROW(experiment::parse_seeds("-1"), std::invalid_argument);
  const experiment::LoadedStudy study = experiment::load_study(StudyFolder("").path(), {{5}, 0.5});
  EXPECT_THAT(study.config.seeds, ElementsAre(5));
  EXPECT_EQ(study.config.duration_s, 0.5);
}

TEST(StudyConfig, ReadsSeedsAsAListOrARange) {
  EXPECT_THAT(experiment::load_study(StudyFolder("").path()).config.seeds, ElementsAre(1, 2));
  EXPECT_THAT(experiment::load_study(StudyFolder("", "{first: 5, count: 3}").path()).config.seeds,
              ElementsAre(5, 6, 7));
}

}  // namespace
