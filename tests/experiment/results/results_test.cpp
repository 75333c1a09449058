// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/results.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "experiment/results/earlier_run.hpp"
#include "experiment/run/runner.hpp"
#include "messages/yaml/message_writer.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

namespace fs = std::filesystem;

using lcm_test::ScratchFolder;

std::string text_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

sim::LoadedWorld small_world(const std::string& more = "") {
  return sim::load_world_text(
      test::rover_world("        - {name: lidar, type: lidar}\n", "", "",
                        "name: small\nrun: {duration_s: 0.5, track_rate_hz: 10, seed: 7}\n" + more),
      "small.yaml");
}

experiment::RunOptions quiet_run() {
  experiment::RunOptions options;
  options.bus = "none";
  options.quiet = true;
  return options;
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

TEST(Results, NameWhatCannotBeWritten) {
  const auto loaded = small_world();
  auto options = quiet_run();
  options.results = "/proc/nowhere";
  const experiment::Summary summary = experiment::run_world(loaded, options);
  EXPECT_EQ(summary.exit_code, 4);
  EXPECT_THAT(summary.error, testing::HasSubstr("cannot write results to '/proc/nowhere"));
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

TEST(Results, ReplaceThoseOfAnEarlierRun) {
  const ScratchFolder folder;
  const auto loaded = small_world();
  auto options = quiet_run();
  options.results = folder.file("results");
  EXPECT_EQ(experiment::run_world(loaded, options).exit_code, 0);
  options.launch = true;
  EXPECT_EQ(experiment::run_world(loaded, options).exit_code, 2);
  const auto json = nlohmann::json::parse(text_of_file(options.results + "/summary.json"));
  EXPECT_EQ(json["ended"], "configuration");
  EXPECT_EQ(json["steps"], 0);
  for (const char* file : {"metrics.csv", "errors.csv", "tracks.csv", "tracks.png"})
    EXPECT_FALSE(fs::exists(options.results + "/" + file)) << file;
}

TEST(Results, AreNeverMixedWithThoseOfAnotherWorld) {
  const ScratchFolder folder;
  auto options = quiet_run();
  options.results = folder.file("results");
  const auto path = [&](const std::string& file) { return options.results + "/" + file; };
  experiment::run_world(small_world("processes: [{name: guest, command: [guest]}, {name: guide, command: [guide]}]\n"),
                        options);
  fs::create_directory(path("branch0"));
  fs::create_directory(path("branch1"));
  for (const char* file : {"guest.log", "guide.log", "report.html", "run.html", "branch0/summary.json",
                           "branch1/tracks.csv", "branch1/mine.txt", "mine.log", "mine.lcm", "branching.txt"})
    std::ofstream(path(file)) << "of the earlier run\n";
  experiment::run_world(small_world(), options);
  for (const char* file : {"guest.log", "guide.log", "report.html", "run.html", "branch0", "branch1/tracks.csv"})
    EXPECT_FALSE(fs::exists(path(file))) << file;
  // What no run writes by itself is kept.
  for (const char* file : {"branch1/mine.txt", "mine.log", "mine.lcm", "branching.txt"})
    EXPECT_TRUE(fs::exists(path(file))) << file;
  EXPECT_TRUE(fs::exists(path("summary.json")));
  EXPECT_THAT(text_of_file(path("world.yaml")), testing::Not(testing::HasSubstr("guest")));
}

TEST(Results, OfAnEarlierRunAreGoneWhenARunIsKilled) {
  const ScratchFolder folder;
  const auto loaded = small_world();
  auto options = quiet_run();
  options.results = folder.file("results");
  EXPECT_EQ(experiment::run_world(loaded, options).exit_code, 0);
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  experiment::remove_earlier_run(options.results);
  {
    const experiment::Results killed(options.results, world);
  }  // as far as a run comes that is killed in its first step
  for (const char* file : {"summary.json", "metrics.csv", "errors.csv", "tracks.png"})
    EXPECT_FALSE(fs::exists(options.results + "/" + file)) << file;
  EXPECT_TRUE(fs::exists(options.results + "/world.yaml"));
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
