// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/summary_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "bridges/control/run_audit.hpp"
#include "experiment/results/results.hpp"
#include "experiment/results/results_folder.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/score/rule_verdict.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/experiment/results/quiet_runs.hpp"

namespace {

using namespace quiet_runs;

namespace fs = std::filesystem;

using lcm_test::ScratchFolder;

TEST(Results, NameWhatCannotBeWritten) {
  const auto loaded = small_world();
  auto options = quiet_run();
  options.results = "/proc/nowhere";
  const experiment::Summary summary = experiment::run_world(loaded, options);
  EXPECT_EQ(summary.exit_code, 4);
  EXPECT_THAT(summary.error, testing::HasSubstr("cannot write results to '/proc/nowhere"));
}

TEST(Results, AFullDiskEndsTheRunAndTheRestIsWritten) {
  const ScratchFolder folder;
  auto loaded = small_world();
  loaded.config.run.duration_s = 20;
  auto options = quiet_run();
  options.results = folder.file("results");
  fs::create_directory(options.results);
  fs::create_symlink("/dev/full", options.results + "/tracks.csv");
  const experiment::Summary summary = experiment::run_world(loaded, options);
  EXPECT_EQ(summary.exit_code, 4);
  EXPECT_EQ(summary.steps, 1000);  // the first look
  EXPECT_THAT(summary.error, testing::HasSubstr("tracks.csv': No space left on device"));
  EXPECT_EQ(text_of_file(options.results + "/summary.json"), summary.to_json());
  EXPECT_THAT(text_of_file(options.results + "/metrics.csv"), testing::StartsWith("metric,value\n"));
  EXPECT_TRUE(fs::exists(options.results + "/world.yaml"));
}

TEST(Results, OneFileThatCannotBeWrittenDoesNotLoseTheOthers) {
  const ScratchFolder folder;
  const auto loaded = small_world();
  auto options = quiet_run();
  options.results = folder.file("results");
  fs::create_directories(options.results + "/metrics.csv");
  const experiment::Summary summary = experiment::run_world(loaded, options);
  EXPECT_EQ(summary.exit_code, 4);
  EXPECT_THAT(summary.error, testing::HasSubstr("metrics.csv"));
  EXPECT_EQ(text_of_file(options.results + "/summary.json"), summary.to_json());
  EXPECT_TRUE(fs::exists(options.results + "/world.yaml"));
  EXPECT_TRUE(fs::exists(options.results + "/tracks.png"));
}

bridges::AuditEntry entry(const std::string& kind, const std::string& text, const std::string& client,
                          const std::string& signer) {
  bridges::AuditEntry made;
  made.sim_time_s = 12.3;
  made.kind = kind;
  made.text = text;
  made.client = client;
  made.signer = signer;
  return made;
}

TEST(AuditText, SaysWhoDidWhatAndWhen) {
  EXPECT_EQ(experiment::audit_text(entry("quit", "", "control", "")),
            "quit at 12.30 s by " + bridges::who_asked("control", ""));
  EXPECT_EQ(experiment::audit_text(entry("remove", "auv1", "control", "ops")),
            "remove auv1 at 12.30 s by " + bridges::who_asked("control", "ops"));
}

TEST(AuditText, AContradictionIsASentenceOfItsOwn) {
  EXPECT_EQ(experiment::audit_text(entry("contradiction", "client 'a' gave two answers", "a", "")),
            "client 'a' gave two answers (at 12.30 s)");
}

TEST(AuditText, OfTheSummaryHasEveryPart) {
  EXPECT_EQ(experiment::audit_json({entry("quit", "t", "c", "s")}).dump(),
            R"([{"sim_time_s":12.3,"kind":"quit","client":"c","signed_by":"s","text":"t"}])");
  EXPECT_EQ(experiment::audit_json({}).dump(), "[]");
}

TEST(VerdictJson, HasBothSidesOfTheRule) {
  experiment::RuleVerdict verdict;
  verdict.rule = "e.rms_m < 2";
  verdict.passed = true;
  verdict.left = 1.5;
  verdict.right = 2;
  verdict.margin = 0.5;
  verdict.result = "1.5 < 2";
  EXPECT_EQ(experiment::json_of(verdict).dump(),
            R"({"rule":"e.rms_m < 2","passed":true,"left":1.5,"right":2.0,"margin":0.5,"result":"1.5 < 2"})");
}

TEST(VerdictJson, WhatIsUnknownIsNull) {
  experiment::RuleVerdict verdict;
  verdict.left = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(experiment::json_of(verdict).dump().find(R"("left":null)"), std::string::npos);
}

}  // namespace
