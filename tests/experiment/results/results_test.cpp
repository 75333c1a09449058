// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/results.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "experiment/results/results_folder.hpp"
#include "experiment/run/runner.hpp"
#include "sim/config/config_node.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/experiment/results/quiet_runs.hpp"

namespace {

using namespace quiet_runs;

using lcm_test::ScratchFolder;

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(RunWorld, EndsByAnEventWithItsVerdictAndTheRecordsOfZones) {
  for (const bool passed : {true, false}) {
    const auto world = small_world(
        "zones: [{name: goal, shape: sphere, radius_m: 1, finish: true}]\n"
        "events: [{name: stop, at: 0.2, do: [{end: {reason: enough, passed: " +
        std::string(passed ? "true" : "false") + "}}]}]\n");
    const experiment::Summary summary = experiment::run_world(world, quiet_run());
    EXPECT_EQ(summary.ended, "event");
    EXPECT_EQ(summary.exit_code, passed ? 0 : 1);
    EXPECT_EQ(summary.steps, 201);  // the step in which the event fires is done
    const auto json = nlohmann::json::parse(summary.to_json());
    EXPECT_EQ(json["event"]["text"], "enough");
    EXPECT_EQ(json["passed"], passed);
    EXPECT_EQ(json["zones"]["r1"]["finish_s"], 0);
    EXPECT_THAT(summary.to_text(), testing::HasSubstr("r1 finished at 0.00 s"));
  }
}

TEST(Summary, HasTheSameKeysForEveryWorld) {
  experiment::Summary summary;
  summary.world = "harbor";
  summary.seed = 3;
  summary.steps = 1000;
  summary.sim_time_s = 10;
  summary.stepped_s = 10;
  summary.wall_s = 2;
  summary.state_hash = 0x0123456789abcdef;
  summary.run_hash = 0xfedcba9876543210;
  summary.metrics["position.rms_m"] = 0.25;
  summary.verdicts = {{"position.rms_m < 1", true, "left 0.25, right 1, margin 0.75", 0.25, 1, 0.75}, {"a", true}};
  summary.processes = {{"pilot", "exited with code 1", 2.5}};
  const auto json = nlohmann::ordered_json::parse(summary.to_json());
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys, testing::ElementsAre("world", "description", "seed", "steps", "sim_time_s", "duration_s", "wall_s",
                                         "real_time_factor", "run_hash", "state_hash", "messages", "dropped_messages",
                                         "bad_messages", "quick_steps", "metrics", "rules", "contacts", "contact_pairs",
                                         "processes", "control", "modem_dropped_messages", "serial_dropped_bytes",
                                         "judged", "passed", "ended", "error", "exit_code", "shoal", "build"));
  EXPECT_EQ(json["world"], "harbor");
  EXPECT_EQ(json["seed"], 3);
  EXPECT_EQ(json["steps"], 1000);
  EXPECT_EQ(json["real_time_factor"], 5);
  EXPECT_EQ(json["state_hash"], "0123456789abcdef");
  EXPECT_EQ(json["run_hash"], "fedcba9876543210");
  EXPECT_EQ(json["metrics"]["position.rms_m"], 0.25);
  EXPECT_EQ(json["rules"][0]["rule"], "position.rms_m < 1");
  EXPECT_EQ(json["rules"][0]["passed"], true);
  EXPECT_EQ(json["rules"][0]["left"], 0.25);
  EXPECT_EQ(json["rules"][0]["right"], 1);
  EXPECT_EQ(json["rules"][0]["margin"], 0.75);
  EXPECT_EQ(json["rules"][0]["result"], "left 0.25, right 1, margin 0.75");
  EXPECT_TRUE(json["rules"][1]["left"].is_null());
  EXPECT_THAT(summary.to_text(),
              testing::HasSubstr("passed: position.rms_m < 1 (left 0.25, right 1, margin 0.75)\n  passed: a\n"));
  EXPECT_EQ(json["processes"][0]["name"], "pilot");
  EXPECT_EQ(json["processes"][0]["how"], "exited with code 1");
  EXPECT_EQ(json["processes"][0]["sim_time_s"], 2.5);
  EXPECT_EQ(json["passed"], true);
  EXPECT_THAT(summary.to_text(), testing::HasSubstr("process 'pilot' exited with code 1 at 2.50 s"));
}

TEST(Summary, SaysWhatMakesARunNotRepeatable) {
  experiment::Summary summary;
  EXPECT_THAT(summary.to_text(), testing::Not(testing::HasSubstr("repeatable")));
  summary.not_repeatable = {"bridge moos"};
  EXPECT_THAT(summary.to_text(), testing::HasSubstr("\n  not repeatable: bridge moos\n"));
  EXPECT_EQ(nlohmann::json::parse(summary.to_json())["not_repeatable"], nlohmann::json({"bridge moos"}));
}

TEST(Summary, ListsEffectsOfSoundAndMessagesThatShadowsTook) {
  experiment::Summary summary;
  summary.acoustics.emplace();
  summary.acoustics->lost["shadow"] = 1;
  summary.acoustic_effects = {"propagation"};
  summary.shadowed = {{12.5, "boat/modem", "auv/modem", 431}};
  const auto json = nlohmann::json::parse(summary.to_json());
  EXPECT_EQ(json["acoustics"]["effects"], nlohmann::json({"propagation"}));
  EXPECT_EQ(json["acoustics"]["lost"]["shadow"], 1);
  EXPECT_EQ(json["acoustics"]["shadowed"][0]["to"], "auv/modem");
}

TEST(Summary, AProgramThatFailedIsARuleThatFailedAlsoWithoutOtherRules) {
  experiment::Summary summary;
  summary.processes = {{"done", "exited with code 0", 1, false}};
  summary.judge_processes();
  EXPECT_FALSE(summary.judged());
  EXPECT_EQ(summary.judgement(), experiment::Judgement::not_judged);
  summary.processes.push_back({"pilot", "exited with code 2", 0.5, true});
  experiment::Summary ruled = summary;
  summary.judge_processes();
  EXPECT_EQ(summary.judgement(), experiment::Judgement::failed);
  EXPECT_THAT(summary.to_text(),
              testing::HasSubstr("FAILED: process 'pilot' must not fail; it exited with code 2 at 0.50 s"));
  summary = ruled;
  summary.verdicts = {{"a", true}};
  summary.judge_processes();
  ASSERT_EQ(summary.verdicts.size(), 2u);
  EXPECT_EQ(summary.verdicts[1].rule, "process 'pilot' must not fail; it exited with code 2 at 0.50 s");
  EXPECT_EQ(summary.judgement(), experiment::Judgement::failed);
  const auto json = nlohmann::json::parse(summary.to_json());
  EXPECT_EQ(json["judged"], true);
  EXPECT_EQ(json["processes"][0]["failed"], false);
  EXPECT_EQ(json["processes"][1]["failed"], true);
}

TEST(Summary, NamesWhatTheRecordLacksInOneLine) {
  experiment::Summary summary;
  EXPECT_THAT(summary.to_text(), testing::Not(testing::HasSubstr("not in the record")));
  EXPECT_FALSE(nlohmann::json::parse(summary.to_json()).contains("not_recorded"));
  summary.not_recorded = {"a", "b"};
  EXPECT_THAT(summary.to_text(), testing::HasSubstr("\n  not in the record: a; b\n"));
  summary.not_recorded = {"a", "b", "c", "d", "e", "f", "g"};
  EXPECT_THAT(summary.to_text(),
              testing::HasSubstr("not in the record: a; b; c; d; e; and 2 more, see summary.json\n"));
  EXPECT_EQ(nlohmann::json::parse(summary.to_json())["not_recorded"].size(), 7u);
}

TEST(Summary, KeepsTheWarningsOfTheEndIfThereWereAny) {
  experiment::Summary summary;
  EXPECT_FALSE(nlohmann::json::parse(summary.to_json()).contains("warnings"));
  summary.warnings = {"device 'a/gps': no fix in 60 s"};
  EXPECT_EQ(nlohmann::json::parse(summary.to_json())["warnings"], nlohmann::json({"device 'a/gps': no fix in 60 s"}));
}

TEST(Summary, ReportsWhatBecameOfAcousticPackets) {
  experiment::Summary summary;
  EXPECT_FALSE(nlohmann::json::parse(summary.to_json()).contains("acoustics"));
  summary.acoustics.emplace();
  EXPECT_EQ(nlohmann::json::parse(summary.to_json())["acoustics"]["lost"], nlohmann::json::object());
  summary.acoustics->sent = 5;
  summary.acoustics->received = 3;
  summary.acoustics->unsent = 1;
  summary.acoustics->lost = {{"busy", 0}, {"noise", 2}};
  summary.serial_dropped_bytes = 7;
  summary.modem_dropped_messages = 4;
  const auto json = nlohmann::json::parse(summary.to_json());
  EXPECT_EQ(json["acoustics"],
            nlohmann::json::parse(R"({"sent": 5, "received": 3, "unsent": 1, "lost": {"noise": 2}, "effects": []})"));
  EXPECT_EQ(json["serial_dropped_bytes"], 7);
  EXPECT_EQ(json["modem_dropped_messages"], 4);
  EXPECT_THAT(summary.to_text(),
              testing::HasSubstr("acoustic packets: 5 sent, 3 received, 2 lost (noise), 1 not sent\n"));
  EXPECT_THAT(summary.to_text(), testing::HasSubstr("  7 bytes of serial ports were not read\n"));
  EXPECT_THAT(summary.to_text(), testing::HasSubstr("  4 messages were dropped from full queues of modems\n"));
}

TEST(RunWorld, CountsAcousticPacketsOnlyWhereThereAreModems) {
  EXPECT_FALSE(experiment::run_world(small_world(), quiet_run()).acoustics);
}

TEST(Summary, AFigureThatIsNoNumberIsNull) {
  experiment::Summary summary;
  summary.metrics["position.rms_m"] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(nlohmann::json::parse(summary.to_json())["metrics"]["position.rms_m"].is_null());
}

TEST(Summary, PassesOnlyWhenEveryRuleHoldsAndNothingBroke) {
  experiment::Summary summary;
  summary.verdicts = {{"a", true}};
  EXPECT_EQ(nlohmann::json::parse(summary.to_json())["passed"], true);
  summary.exit_code = 5;
  EXPECT_EQ(nlohmann::json::parse(summary.to_json())["passed"], false);
  summary.exit_code = 0;
  summary.verdicts = {{"a", true}, {"b", false}};
  EXPECT_EQ(nlohmann::json::parse(summary.to_json())["passed"], false);
  EXPECT_THAT(summary.to_text(), testing::HasSubstr("FAILED: b"));
}

TEST(Summary, WithoutRulesNothingHasPassed) {
  experiment::Summary summary;
  const auto json = nlohmann::json::parse(summary.to_json());
  EXPECT_TRUE(json.at("passed").is_null()) << json.at("passed");
  EXPECT_EQ(json.at("judged"), false);
  EXPECT_EQ(json.value("not_judged", ""), "the world has no rules");
  EXPECT_THAT(summary.to_text(), testing::HasSubstr("  not judged: the world has no rules\n"));
}

TEST(RunWorld, WithoutItsProgramsIsNotJudged) {
  const auto world = small_world(
      "metrics: [{name: distance, type: distance, vehicle: r1}]\npass: [distance.travelled_m > 1000]\n"
      "processes: [{name: pilot, command: [sleep, '1000']}]\n");
  const experiment::Summary summary = experiment::run_world(world, quiet_run());
  EXPECT_EQ(summary.exit_code, 0);
  const auto json = nlohmann::json::parse(summary.to_json());
  EXPECT_TRUE(json.at("passed").is_null());
  EXPECT_EQ(json.value("not_judged", ""), "its programs took no part: see --launch and --await");
}

TEST(Results, AreLeftByARun) {
  const ScratchFolder folder;
  const auto loaded =
      small_world("metrics:\n  - {name: position, type: position_error, vehicle: r1, channel: r1.estimate}\n");
  auto options = quiet_run();
  options.results = folder.file("a/results");
  const experiment::Summary summary = experiment::run_world(loaded, options);
  EXPECT_EQ(summary.exit_code, 0) << summary.error;
  const auto text = [&](const std::string& name) { return text_of_file(options.results + "/" + name); };

  EXPECT_EQ(text("summary.json"), summary.to_json());
  const auto json = nlohmann::json::parse(text("summary.json"));
  EXPECT_EQ(json["world"], "small");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["steps"], 500);
  EXPECT_EQ(json["sim_time_s"], 0.5);
  EXPECT_EQ(json["ended"], "duration");

  EXPECT_THAT(text("metrics.csv"), testing::StartsWith("metric,value\nposition.final_m,nan\n"));
  EXPECT_THAT(text("errors.csv"), testing::StartsWith("time_s,metric,error_m,"));
  EXPECT_THAT(text("tracks.csv"), testing::StartsWith("time_s,vehicle,x_m,y_m,z_m,yaw_rad\n0.100000,r1,"));
  EXPECT_EQ(lines_in(text("tracks.csv")), 6u);  // a header and 5 rows: 10 Hz over 0.5 s
  EXPECT_THAT(text("tracks.png"), testing::StartsWith("\x89PNG"));
  EXPECT_NO_THROW(sim::load_world(options.results + "/world.yaml"));
}

TEST(Results, AreLeftByARunThatFailed) {
  const ScratchFolder folder;
  const auto loaded = small_world(
      "metrics:\n  - {name: position, type: position_error, vehicle: r1, channel: r1.estimate}\n"
      "pass:\n  - position.rms_m < 1\n");
  auto options = quiet_run();
  options.results = folder.file("results");
  EXPECT_EQ(experiment::run_world(loaded, options).exit_code, 1);  // no estimate came
  const auto json = nlohmann::json::parse(text_of_file(options.results + "/summary.json"));
  EXPECT_EQ(json["exit_code"], 1);
  EXPECT_EQ(json["passed"], false);
}

TEST(Results, ReportARunThatCouldNotBeBuilt) {
  const ScratchFolder folder;
  const auto loaded = small_world();
  auto options = quiet_run();
  options.results = folder.file("results");
  options.record = folder.file("no/such/folder.lcm");
  EXPECT_EQ(experiment::run_world(loaded, options).exit_code, 4);
  const auto json = nlohmann::json::parse(text_of_file(options.results + "/summary.json"));
  EXPECT_EQ(json["passed"], false);
  EXPECT_EQ(json["exit_code"], 4);
  EXPECT_THAT(json["error"], testing::HasSubstr("folder.lcm"));
}

TEST(Results, DoNotChangeTheRun) {
  const ScratchFolder folder;
  const auto loaded = small_world();
  auto options = quiet_run();
  const experiment::Summary without = experiment::run_world(loaded, options);
  options.results = folder.file("results");
  options.record = folder.file("run.lcm");
  EXPECT_EQ(experiment::run_world(loaded, options).state_hash, without.state_hash);
}

TEST(Summary, IsWrittenWhateverAClientCallsItself) {
  experiment::Summary summary;
  summary.clients.push_back({.client = "pilot\xff"});
  summary.audit.push_back({1, "quit", "operator\xff", "", ""});
  const auto json = nlohmann::json::parse(summary.to_json());
  EXPECT_EQ(json["clients"][0]["name"], "pilot\xef\xbf\xbd");  // U+FFFD, the replacement character
  EXPECT_EQ(json["control"]["audit"][0]["client"], "operator\xef\xbf\xbd");
}

TEST(Summary, DoesNotPassWhenAClientGaveTwoAnswersToOneTick) {
  experiment::Summary summary;
  summary.verdicts.push_back({"a rule", true});
  summary.clients.push_back({.client = "pilot"});
  summary.judge_clients();
  EXPECT_EQ(summary.judgement(), experiment::Judgement::passed);
  summary.clients[0].contradictions = 2;
  summary.judge_clients();
  EXPECT_EQ(summary.judgement(), experiment::Judgement::failed);
  EXPECT_EQ(summary.verdicts.back().rule,
            "client 'pilot' must give one answer to each tick; another program gave 2 different ones under its name");
}

}  // namespace
