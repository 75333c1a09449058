// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>

#include "tests/system/shoal_program.hpp"

namespace {

namespace fs = std::filesystem;

using namespace system_test;
using testing::HasSubstr;
using testing::Not;

/// A study of a rover that stands; `more`: keys of the study, `world`: keys of the world.
struct StudyFolder {
  explicit StudyFolder(const std::string& more, const std::string& world = "") {
    write_file(folder.file("world.yaml"),
               "shoal: 1\nrun: {duration_s: 1}\n"
               "objects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n"
               "vehicles: [{name: rover1, file: " +
                   source("vehicles/rover.yaml") +
                   "}]\n"
                   "metrics: [{name: distance, type: distance, vehicle: rover1}]\n" +
                   world);
    write_study(more);
  }
  void write_study(const std::string& more) const {
    write_file(folder.file("study.yaml"), "shoal: 1\nstudy: tiny\nworld: world.yaml\n" + more);
  }
  Ended run(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{
        "study", folder.file("study.yaml"), "--output", folder.file("out"), "--allow-path", folder.file("")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_shoal(arguments);
  }
  std::string text(const std::string& file) const { return text_of_file(folder.file("out/" + file)); }

  ScratchFolder folder;
};

const std::string two_cases = "seeds: [1, 2]\ncases: [{name: a}, {name: b, set: {run.duration_s: 2}}]\n";

TEST(Study, RunsAWorldForEverySeedAndCase) {
  const StudyFolder study(two_cases +
                          "plots: [{name: ways, figure: distance.travelled_m}]\n"
                          "pass: [mean(a.distance.travelled_m) < 1]\n");
  const Ended ended = study.run({"--jobs", "2"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("study tiny: 4 runs"));
  EXPECT_THAT(ended.output, HasSubstr("passed: mean(a.distance.travelled_m) < 1 (left "));
  EXPECT_THAT(ended.errors, HasSubstr("[4/4] "));
  EXPECT_THAT(study.text("study.csv"), HasSubstr("\na,1,0,,duration,1,"));
  EXPECT_THAT(study.text("study.csv"), HasSubstr("\nb,2,0,,duration,2,"));
  EXPECT_THAT(study.text("study.json"), HasSubstr("\"passed\": true"));
  EXPECT_THAT(study.text("ways.png"), testing::StartsWith("\x89PNG"));
  EXPECT_FALSE(fs::exists(study.folder.file("out/runs/a/seed_1/tracks.png")));

  const Ended report = run_shoal({"report", study.folder.file("out")});
  EXPECT_EQ(report.exit_code, 0) << report.errors;
  EXPECT_THAT(study.text("report.html"), HasSubstr("<th scope=\"row\">b</th><td>2</td>"));
  EXPECT_THAT(study.text("report.html"), HasSubstr("data:image/png;base64,"));
}

TEST(Study, TakesSeedsAndDurationOfTheCommandLine) {
  const StudyFolder study("seeds: 1-100\n");
  const Ended ended = study.run({"--seeds", "3,7-8", "--duration", "0.5"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("study tiny: 3 runs"));
  EXPECT_THAT(study.text("study.csv"), HasSubstr("\nworld,7,0,"));
  EXPECT_THAT(study.text("study.csv"), HasSubstr(",duration,0.5,"));
  const Ended wrong = study.run({"--seeds", "8-7"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("must be ranges from the lower to the higher seed, got '8-7'"));
}

TEST(Study, SaysThatACaseWhoseSettingDoesNothingDoesNotDiffer) {
  const StudyFolder study("seeds: [1, 2]\ncases: [{name: a}, {name: b, set: {description: other}}]\n");
  const Ended ended = study.run();
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output,
              HasSubstr("note: cases 'a', 'b' do not differ: all runs gave the same result, although their "
                        "settings differ"));
  EXPECT_EQ(run_shoal({"report", study.folder.file("out")}).exit_code, 0);
  EXPECT_THAT(study.text("report.html"), HasSubstr("do not differ"));
}

TEST(Study, KeepsRunsThatAreDoneUntilSomethingChanges) {
  const StudyFolder study(two_cases);
  ASSERT_EQ(study.run().exit_code, 0);
  const auto runs = [](const Ended& ended) { return std::count(ended.errors.begin(), ended.errors.end(), '['); };
  EXPECT_EQ(runs(study.run()), 0);
  EXPECT_THAT(study.run().errors, HasSubstr("4 of 4 runs were already done"));
  fs::remove(study.folder.file("out/runs/b/seed_2/summary.json"));
  EXPECT_EQ(runs(study.run()), 1);
  study.write_study("seeds: [1, 2, 3]\ncases: [{name: a}, {name: b, set: {run.duration_s: 3}}]\n");
  EXPECT_EQ(runs(study.run()), 1 + 3);
  EXPECT_EQ(runs(study.run({"--fresh"})), 6);
}

TEST(Study, ExitCodeIs1WhenARuleFails) {
  const StudyFolder study("seeds: [1]\npass: [mean(world.distance.travelled_m) > 1000]\n");
  const Ended ended = study.run();
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.output, HasSubstr("FAILED: mean(world.distance.travelled_m) > 1000 (left "));
}

TEST(Study, ARunWhoseOwnRulesFailIsAResult) {
  const StudyFolder study("seeds: [1]\npass: [mean(world.passed) == 0]\n", "pass: [distance.travelled_m > 1000]\n");
  const Ended ended = study.run();
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.errors, HasSubstr("FAILED: distance.travelled_m > 1000 ("));
}

TEST(Study, AProgramThatFailedFailsItsRunAndTheStudy) {
  const StudyFolder study("seeds: [1, 2]\nlaunch: true\npass: [mean(world.distance.travelled_m) < 1e6]\n",
                          "pass: [distance.travelled_m < 1e6]\n"
                          "processes: [{name: pilot, client: pilot, command: [sh, -c, exit 3]}]\n"
                          "lockstep: {join_timeout_s: 1000}\n");
  const Ended ended = study.run();
  EXPECT_EQ(ended.exit_code, 1) << ended.errors;
  EXPECT_THAT(ended.errors, HasSubstr("FAILED: process 'pilot' must not fail; it exited with code 3"));
  EXPECT_THAT(ended.output, HasSubstr("FAILED: 2 of 2 runs had programs that failed"));
}

TEST(Study, ARunThatWasEndedByHandIsNoResult) {
  const StudyFolder study(
      "seeds: [1]\nlaunch: true\nduration_s: 1e9\npass: [mean(world.distance.travelled_m) < 1e6]\n",
      "processes: [{name: hand, command: [" + built("shoal") + ", control, quit, --lcm-url, '{lcm_url}']}]\n");
  const Ended ended = study.run();
  EXPECT_EQ(ended.exit_code, 4) << ended.errors;
  EXPECT_THAT(ended.errors, testing::ContainsRegex("no result: ended by quit at [0-9.]+ of 1000000000 s"));
}

TEST(Study, ExitCodeIs4WhenARunHasNoResult) {
  const StudyFolder study("seeds: [1]\nlaunch: true\n", "processes: [{name: ghost, command: [no-such-program]}]\n");
  const Ended ended = study.run();
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_THAT(ended.errors, HasSubstr("cannot start 'no-such-program'"));
  EXPECT_THAT(ended.output, HasSubstr("1 runs have no result"));
  EXPECT_THAT(study.text("study.json"), HasSubstr("no-such-program"));
}

TEST(Study, ExitCodeIs2ForAMistake) {
  const StudyFolder study("seeds: [1]\nfigures: [way.rms_m]\n");
  const Ended ended = study.run();
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("study.yaml:5:10: 'figures' names nothing in this world: 'way.rms_m'"));
  EXPECT_FALSE(fs::exists(study.folder.file("out")));
  EXPECT_EQ(run_shoal({"study", study.folder.file("none.yaml")}).exit_code, 2);
}

TEST(Study, IsCheckedAsWorldsAre) {
  const StudyFolder study(two_cases + "pass: [max(b.distance.travelled_m) < 1]\n");
  const std::string file = study.folder.file("study.yaml");
  const Ended good = run_shoal({"check", file, "--allow-path", study.folder.file("")});
  EXPECT_EQ(good.exit_code, 0) << good.errors;
  EXPECT_THAT(good.output, HasSubstr("study.yaml: study 'tiny' of "));
  EXPECT_THAT(good.output, HasSubstr(": 2 cases, 2 seeds, 4 runs, 1 rule\n"));
  study.write_study(two_cases + "pass: [max(b.distance.travelled) < 1]\n");
  const Ended bad = run_shoal({"check", file, "--allow-path", study.folder.file("")});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.errors, HasSubstr("study.yaml:6:23: rule 1: metric 'distance' has no figure 'travelled'; figures: "
                                    "travelled_m; did you mean 'travelled_m'?"));
  EXPECT_FALSE(fs::exists(study.folder.file("out")));
  for (const auto& entry : fs::directory_iterator(source("worlds/studies")))
    EXPECT_EQ(run_shoal({"check", entry.path().string()}).exit_code, 0) << entry.path();
}

TEST(Study, EndsItsRunsOnASignal) {
  const StudyFolder study("seeds: [1, 2]\nduration_s: 1e9\n");
  Program program(
      {built("shoal"), "study", study.folder.file("study.yaml"), "--output", study.folder.file("out"), "--jobs", "2"});
  const auto children = program.await_children(2);
  ASSERT_EQ(children.size(), 2u) << program.errors();
  program.send_signal(SIGINT);
  EXPECT_EQ(program.wait(), 130) << program.errors();
  for (const pid_t child : children) EXPECT_FALSE(is_running(child));
  EXPECT_THAT(program.errors(), HasSubstr("continues with the missing runs"));
}

TEST(Study, RunsOfAWorldWithASerialPortDoNotDisturbEachOther) {
  const ScratchFolder folder;
  write_file(folder.file("study.yaml"), "shoal: 1\nstudy: ports\nworld: " + source("worlds/micromodems.yaml") +
                                            "\nduration_s: 300\nseeds: {first: 1, count: 4}\n");
  const Ended ended = run_shoal({"study", folder.file("study.yaml"), "--output", folder.file("out"), "--jobs", "4"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors << ended.output;
}

/// A study with programs, of a world with a modem whose port is at `port`; the program notes that it found the port.
struct PortStudy {
  explicit PortStudy(const std::string& port) {
    write_file(folder.file("world.yaml"),
               "shoal: 1\nrun: {duration_s: 1e9}\nphysics: {gravity_mps2: 0}\nmedium: {water: {}}\nvehicles:\n"
               "  - name: m\n    position_m: [0, 0, -20]\n    model:\n      shoal: 1\n      vehicle: ball\n"
               "      bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}]\n"
               "      devices: [{name: modem, type: micromodem, serial: {path: \"" +
                   folder.file(port) +
                   "\"}}]\n"
                   "processes: [{name: host, on_exit: end, command: [sh, -c, \"test -e " +
                   folder.file(port) + " && touch " + folder.file("seen.{run}") + "\"]}]\n");
    write_file(folder.file("study.yaml"),
               "shoal: 1\nstudy: ports\nworld: world.yaml\nlaunch: true\nseeds: [1, 2]\ncases: [{name: a}]\n");
  }
  Ended run(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{
        "study", folder.file("study.yaml"), "--output", folder.file("out"), "--allow-path", folder.file("")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_shoal(arguments);
  }
  bool all_saw_their_port() const {
    return fs::exists(folder.file("seen.a-seed_1")) && fs::exists(folder.file("seen.a-seed_2"));
  }

  ScratchFolder folder;
};

TEST(Study, RefusesRunsAtOnceThatWouldHaveOneSerialPort) {
  const PortStudy study("{vehicle}.port");
  const Ended ended = study.run({"--jobs", "2"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("vehicle 'm': device 'modem': concurrent runs cannot share serial port '" +
                                      study.folder.file("m.port") + "': put {run} into its path, or use --jobs 1"));
  EXPECT_FALSE(fs::exists(study.folder.file("out")));
}

TEST(Study, WithoutJobsRunsThatHaveOneSerialPortGoOneAfterTheOther) {
  const PortStudy study("m.port");
  EXPECT_THAT(study.run().errors, Not(HasSubstr("is in use")));
  EXPECT_TRUE(study.all_saw_their_port());
}

TEST(Study, GivesEachRunASerialPortOfItsOwnWhereThePathNamesTheRun) {
  const PortStudy study("m.{run}");
  EXPECT_THAT(study.run({"--jobs", "2"}).errors, Not(HasSubstr("is in use")));
  EXPECT_TRUE(study.all_saw_their_port());
}

TEST(Study, OfTheCooperativeWorldContinuesWhereItWasStopped) {
  const ScratchFolder folder;
  const auto study = [&](const std::string& seeds) {
    write_file(folder.file("study.yaml"), "shoal: 1\nstudy: sea\nworld: " + source("worlds/coop_underwater.yaml") +
                                              "\nlaunch: true\nduration_s: 150\nseeds: " + seeds +
                                              "\nfigures: [cooperative.rms_m, link.received]\n"
                                              "pass: [min(world.link.received) > 5]\n");
    return run_shoal({"study", folder.file("study.yaml"), "--output", folder.file("out"), "--jobs", "2"});
  };
  ASSERT_EQ(study("[1]").exit_code, 0);
  const Ended second = study("[1, 2]");
  EXPECT_EQ(second.exit_code, 0) << second.errors << second.output;
  EXPECT_THAT(second.errors, HasSubstr("1 of 2 runs were already done"));
  const auto hash = [&](const char* seed) {
    return summary_value(folder.file("out/runs/world/seed_" + std::string(seed)), "state_hash");
  };
  EXPECT_NE(hash("1"), hash("2"));
}

TEST(Study, ItsRunsAndTheirProgramsEndWhenItIsKilled) {
  const ScratchFolder marks;
  const StudyFolder study(
      "seeds: [1]\nduration_s: 1e9\nlaunch: true\n",
      "processes: [{name: pilot, command: [sh, -c, 'echo $$ > " + marks.file("pid") + "; exec sleep 1000']}]\n");
  Program program({built("shoal"), "study", study.folder.file("study.yaml"), "--output", study.folder.file("out")});
  ASSERT_TRUE(await([&] { return text_of_file(marks.file("pid")).ends_with('\n'); }, timeout)) << program.errors();
  const auto runs = program.children();
  ASSERT_EQ(runs.size(), 1u);
  const pid_t pilot = std::stoi(text_of_file(marks.file("pid")));
  program.send_signal(SIGKILL);
  EXPECT_EQ(program.wait(), 128 + SIGKILL);
  EXPECT_TRUE(await([&] { return !is_running(runs[0]) && !is_running(pilot); }, timeout));
}

TEST(Run, ItsProgramsEndWhenItIsKilled) {
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"), endless_world("processes: [{name: pilot, command: [sleep, '1000']}]\n"));
  Program program({built("shoal"), "run", folder.file("world.yaml"), "--launch", "--lcm-url", own_url(2)});
  const auto children = program.await_children(1);
  ASSERT_EQ(children.size(), 1u) << program.errors();
  const pid_t pilot = children[0];
  program.send_signal(SIGKILL);
  EXPECT_EQ(program.wait(), 128 + SIGKILL);
  EXPECT_TRUE(await([&] { return !is_running(pilot); }, timeout));
}

TEST(Report, ExitCodesReportWhatIsWrong) {
  const ScratchFolder folder;
  EXPECT_EQ(run_shoal({"report"}).exit_code, 2);
  EXPECT_EQ(run_shoal({"report", folder.file("a"), folder.file("b")}).exit_code, 4);
  const Ended none = run_shoal({"report", folder.file("a")});
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_THAT(none.errors, HasSubstr("is not a folder"));
  ASSERT_EQ(run_shoal({"run", source("worlds/minimal.yaml"), "--bus", "none", "--duration", "1", "--results",
                       folder.file("run")})
                .exit_code,
            0);
  EXPECT_EQ(run_shoal({"report", folder.file("run"), "--output", folder.file("no/page.html")}).exit_code, 4);
  const Ended compared = run_shoal({"report", folder.file("run"), folder.file("run")});
  EXPECT_EQ(compared.output, folder.file("run/comparison.html") + "\n") << compared.errors;
  const Ended made = run_shoal({"report", folder.file("run"), "--output", folder.file("page.html")});
  EXPECT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_EQ(made.output, folder.file("page.html") + "\n");
  EXPECT_THAT(text_of_file(folder.file("page.html")), testing::EndsWith("</html>\n"));
}

}  // namespace
