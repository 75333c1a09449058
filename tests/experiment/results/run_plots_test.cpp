// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/run_plots.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "experiment/results/results.hpp"
#include "experiment/results/results_folder.hpp"
#include "experiment/run/runner.hpp"
#include "messages/yaml/message_writer.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/experiment/results/quiet_runs.hpp"

namespace {

using namespace quiet_runs;

namespace fs = std::filesystem;

using lcm_test::ScratchFolder;

TEST(Results, ShowErrorsWithWhatTheEstimateSaysOfThem) {
  const ScratchFolder folder;
  sim::LoadOptions load;
  load.encode_message = shoal::encode_own_message;
  // Always 3 m east and 4 m north of a rover that stands: with P = diag(9, 16) the NEES is 1 + 1.
  const auto loaded = sim::load_world_text(
      test::rover_world("        - {name: lidar, type: lidar}\n", "", "",
                        "run: {duration_s: 1}\n"
                        "events:\n"
                        "  - {name: think, every: 0.1, do: [{publish: {channel: est, type: shoal.estimate_t, value: "
                        "{position_m: [3, 4, 0], covariance_m2: [9, 0, 0, 0, 16, 0, 0, 0, 1]}}}]}\n"
                        "metrics:\n"
                        "  - {name: e, type: position_error, vehicle: r1, channel: est}\n"
                        "  - {name: c, type: consistency, vehicle: r1, channel: est}\n"),
      "small.yaml", load);
  auto options = quiet_run();
  options.results = folder.file("results");
  const experiment::Summary summary = experiment::run_world(loaded, options);
  EXPECT_EQ(summary.exit_code, 0) << summary.error;
  EXPECT_NEAR(summary.metrics.at("e.rms_m"), 5, 1e-3);  // a rover that stands may creep
  EXPECT_NEAR(summary.metrics.at("c.nees_mean"), 2, 1e-3);
  const std::string errors = text_of_file(options.results + "/errors.csv");
  EXPECT_THAT(errors, testing::StartsWith("time_s,metric,error_m,estimate_x_m,estimate_y_m,truth_x_m,truth_y_m,"
                                          "estimate_z_m,truth_z_m,travelled_m,sigma_m,nees\n"));
  EXPECT_THAT(errors, testing::HasSubstr(",5.000000,"));  // sigma: the root of 9 + 16
  EXPECT_THAT(errors, testing::HasSubstr(",2.000"));
  for (const char* image : {"tracks.png", "errors.png", "nees.png"})
    EXPECT_THAT(text_of_file(options.results + "/" + image), testing::StartsWith("\x89PNG")) << image;
  options.plots = false;
  EXPECT_EQ(experiment::run_world(loaded, options).exit_code, 0);
  EXPECT_FALSE(fs::exists(options.results + "/nees.png"));
}

TEST(Results, ErrorsThatAreVeryDifferentHaveALogarithmicAxis) {
  for (const bool very : {true, false}) {
    const ScratchFolder folder;
    sim::LoadOptions load;
    load.encode_message = shoal::encode_own_message;
    const auto loaded = sim::load_world_text(
        test::rover_world(
            "        - {name: lidar, type: lidar}\n", "", "",
            "run: {duration_s: 1}\n"
            "events:\n"
            "  - {name: near, every: 0.1, do: [{publish: {channel: near, type: shoal.pose_t, value: {pos: [1, 0, "
            "0]}}}]}\n"
            "  - {name: far, every: 0.1, do: [{publish: {channel: far, type: shoal.pose_t, value: {pos: [" +
                std::string(very ? "6" : "4") +
                ", 0, 0]}}}]}\n"
                "metrics:\n"
                "  - {name: n, type: position_error, vehicle: r1, channel: near}\n"
                "  - {name: f, type: position_error, vehicle: r1, channel: far}\n"),
        "small.yaml", load);
    auto options = quiet_run();
    options.results = folder.file("results");
    experiment::run_world(loaded, options);
    const std::string script = text_of_file(options.results + "/plot.gp");
    EXPECT_EQ(script.find("\nset logscale y") != script.npos, very) << script;
    EXPECT_THAT(text_of_file(options.results + "/errors.png"), testing::StartsWith("\x89PNG"));
  }
}

TEST(Results, NamesInAWorldAreNoCommands) {
  const ScratchFolder folder;
  const std::string made = folder.file("made");
  auto loaded = small_world();
  loaded.config.name = "x'; system \"touch " + made + "\"; set title '\n!touch " + made + "\n`touch " + made + "`";
  auto options = quiet_run();
  options.results = folder.file("results");
  EXPECT_EQ(experiment::run_world(loaded, options).exit_code, 0);
  EXPECT_FALSE(fs::exists(made));
  EXPECT_THAT(text_of_file(options.results + "/tracks.png"), testing::StartsWith("\x89PNG"));
}

}  // namespace
