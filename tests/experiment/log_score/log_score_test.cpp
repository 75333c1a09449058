// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/log_score/log_score.hpp"

#include <gmock/gmock.h>
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <fstream>

#include "experiment/score/scoring.hpp"
#include "shoal/pose_t.hpp"
#include "tests/devices/comms/modem_fixture.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A submarine and, 100 m east of it, a boat with GPS; both stand still.
std::string scored_sea() {
  return test::modem_sea({{"auv", "[0, 0, -10]",
                           "{name: dvl, type: dvl, scale_std: 0.03}, {name: modem, type: acoustic_modem}, "
                           "{name: ahrs, type: ahrs, heading_noise: {bias_std: 0.05}}",
                           ""},
                          {"boat", "[100, 0, 0]",
                           "{name: gps, type: gps, position_m: [0, 0, 1], horizontal_noise: {gaussian_std: 0.5}}, "
                           "{name: modem, type: acoustic_modem, position_m: [0, 0, -1]}",
                           ""}},
                         "metrics:\n"
                         "  - {name: bound, type: bound, vehicle: auv, start_std_m: 10}\n"
                         "  - {name: mine, type: position_error, vehicle: auv, channel: est}\n"
                         "  - {name: trust, type: consistency, vehicle: auv, channel: est}\n"
                         "  - {name: other, type: position_error, vehicle: boat, channel: other}\n"
                         "  - {name: ratio, type: bound_ratio, metric: mine, bound: bound}\n"
                         "pass: [mine.rms_m < 6]\n");
}

/// A run of 8 s in which the boat sends a packet, and the submarine is believed 5 m north of where it is.
class LogScoreTest : public testing::Test {
 protected:
  LogScoreTest() {
    test::RecordedRun run(scored_sea(), options_.log = folder_.file("run.lcm"));
    experiment::Scoring scoring(run.world);
    run.run(
        800,
        [&](std::int64_t step) {
          if (step > 0) scoring.after_step();
          if (step == 200) run.send("boat.modem.cmd", test::bytes_to("here"));
          if (step != 700) return;
          shoal::pose_t pose{};
          pose.utime = run.world.epoch_us() + run.world.now().count();
          pose.pos[1] = 5;
          run.send("est", pose);
        },
        [&] { scoring.after_step(); });
    live_ = scoring.figures();
    options_.quiet = true;
  }
  /// Scores a file of estimates in place of `mine`.
  experiment::LogScore score(const std::string& text) {
    options_.estimate = folder_.file("mine.csv");
    options_.metric = "mine";
    std::ofstream(options_.estimate) << text;
    return experiment::score_log(options_);
  }

  test_support::ScratchFolder folder_;
  experiment::LogScoreOptions options_;
  experiment::Figures live_;
};

std::string texts_of(const experiment::Figures& figures) {
  std::string text;
  for (const auto& [name, value] : figures) text += fmt::format("{} {}\n", name, value);
  return text;
}

TEST_F(LogScoreTest, HasTheFiguresOfTheRun) {
  const experiment::LogScore score = experiment::score_log(options_);
  EXPECT_EQ(texts_of(score.figures), texts_of(live_));
  EXPECT_EQ(score.figures.at("bound.ranges"), 1);
  EXPECT_NEAR(score.figures.at("ratio.ratio"), 5 / score.figures.at("bound.rms_m"), 1e-3);
  ASSERT_EQ(score.verdicts.size(), 1u);
  EXPECT_TRUE(score.verdicts[0].passed);
  EXPECT_THAT(score.to_json(), HasSubstr("\"mine.rms_m\": 5"));
}

TEST_F(LogScoreTest, TakesEstimatesOfAFile) {
  const experiment::LogScore scored = score("t,x,y,xx,xy,yy\n1,3,4,1,0,1\n2,0,0,1,0,1\n3,0,7,1,0,1\n");
  EXPECT_NEAR(scored.figures.at("mine.rms_m"), std::sqrt((25.0 + 0 + 49) / 3), 1e-3);
  EXPECT_NEAR(scored.figures.at("trust.nees_mean"), (25.0 + 0 + 49) / 3, 1e-2);
  EXPECT_EQ(scored.figures.at("mine.samples"), 3);
  EXPECT_EQ(scored.figures.at("bound.rms_m"), live_.at("bound.rms_m"));
}

TEST_F(LogScoreTest, TakesTimesOfTheYear) {
  // 2026-01-01, the epoch of a world, is 1767225600 s.
  EXPECT_EQ(score("t,x,y\n1767225601,3,4\n").figures.at("mine.samples"), 1);
}

TEST_F(LogScoreTest, SaysWhatItDidNotScore) {
  EXPECT_THAT(
      score("t,x,y\n1,3,4\n99,0,0\n").notes,
      ElementsAre(HasSubstr("mine.csv has no covariance: trust has no figures"), HasSubstr("1 of 2 estimates in")));
}

TEST_F(LogScoreTest, RefusesAnEstimateWithoutItsMetric) {
  const auto error = [&](const std::string& metric) -> std::string {
    options_.estimate = "none.csv";
    options_.metric = metric;
    try {
      experiment::score_log(options_);
      return "none";
    } catch (const std::exception& problem) {
      return problem.what();
    }
  };
  EXPECT_EQ(error(""), "--metric is needed: the world scores several estimates: mine, other");
  EXPECT_EQ(error("mien"),
            "--metric: the world has no position_error 'mien'; it has: mine, other; did you mean 'mine'?");
  EXPECT_THAT(error("mine"), HasSubstr("none.csv"));
}

TEST_F(LogScoreTest, WritesTrajectories) {
  options_.tum = folder_.file("tum");
  options_.mrclam = folder_.file("mrclam");
  experiment::score_log(options_);
  const auto text = [](const std::string& path) {
    std::ifstream file(path);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_THAT(text(options_.tum + "/mine.txt"), HasSubstr("\n7.000000 0.000000 5.000000 0.000000 0.000000000"));
  EXPECT_THAT(text(options_.tum + "/boat_truth.txt"), HasSubstr("\n7.900000 100.0000"));
  EXPECT_THAT(text(options_.mrclam + "/Barcodes.dat"), HasSubstr("1\t5\n2\t14\n"));
  EXPECT_THAT(text(options_.mrclam + "/Robot2_Groundtruth.dat"), HasSubstr("# boat\n"));
}

}  // namespace
