// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "bridges/log/event_log.hpp"
#include "shoal/acoustic_received_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_state_t.hpp"
#include "tests/system/shoal_program.hpp"

namespace {

using system_test::built;
using system_test::Ended;
using system_test::own_url;
using system_test::run_shoal;
using system_test::ScratchFolder;
using system_test::source;
using system_test::text_of_file;
using testing::HasSubstr;

Ended run_nav(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), built("shoal-nav"));
  system_test::Program program(std::move(arguments));
  const int exit_code = program.wait();
  return {exit_code, program.output(), program.errors()};
}

/// The estimates in a log: payloads with their times, by channel.
std::map<std::string, std::vector<std::pair<std::int64_t, sim::Bytes>>> estimates_in(const std::string& log) {
  std::map<std::string, std::vector<std::pair<std::int64_t, sim::Bytes>>> estimates;
  bridges::EventLogReader reader(log);
  while (auto event = reader.next())
    if (event->channel.ends_with(".estimate")) estimates[event->channel].emplace_back(event->utime, event->payload);
  return estimates;
}

TEST(Nav, EstimatesFromTheRecordAreThoseOfTheRunByteForByte) {
  const ScratchFolder folder;
  const std::string record = folder.file("dive.lcm");
  const Ended live = run_shoal({"run", source("worlds/benchmark/03_team_dive.yaml"), "--launch", "--duration", "200",
                                "--lcm-url", own_url(8), "--record", record});
  EXPECT_EQ(live.exit_code, 1) << live.errors;  // too short for its rules
  const Ended offline = run_nav({"--log", record, "--algorithm", "iu,naive", "--out", folder.file("out")});
  ASSERT_EQ(offline.exit_code, 0) << offline.errors;
  const auto of_run = estimates_in(record), of_record = estimates_in(folder.file("out/iu.lcm"));
  ASSERT_EQ(of_run.size(), 4U);  // also that of the craft that no metric uses
  for (const auto& [channel, estimates] : of_run) {
    // From the first fix on, within the first second: the programs know the world from the start.
    EXPECT_GE(estimates.size(), 399U) << channel;
    EXPECT_EQ(of_record.at(channel), estimates) << channel;
  }
  EXPECT_NE(estimates_in(folder.file("out/naive.lcm")), of_run);
  // An MCAP file of the record gives the same.
  ASSERT_EQ(run_shoal({"log", "mcap", record, "--out", folder.file("dive.mcap")}).exit_code, 0);
  const Ended of_mcap =
      run_nav({"--log", folder.file("dive.mcap"), "--algorithm", "iu", "--out", folder.file("of_mcap")});
  ASSERT_EQ(of_mcap.exit_code, 0) << of_mcap.errors;
  EXPECT_EQ(estimates_in(folder.file("of_mcap/iu.lcm")), of_record);
  EXPECT_THAT(text_of_file(folder.file("out/iu/auv1.csv")), HasSubstr("time_s,utime,x_m,"));
  EXPECT_THAT(text_of_file(folder.file("out/iu/auv1.tum")), HasSubstr("# t x y z qx qy qz qw\n"));
  EXPECT_THAT(text_of_file(folder.file("out/iu/Robot4_Estimate.dat")), HasSubstr("# craft\n# Time [s]\tx [m]\t"));
}

TEST(Nav, ARecordHasTheArgumentsOfThePrograms) {
  const ScratchFolder folder;
  const std::string record = folder.file("thermocline.lcm");
  const Ended live =
      run_shoal({"run", source("worlds/benchmark/09_thermocline.yaml"), "--launch", "--duration", "100", "--set",
                 "processes.auv1.args.start_m=[400, 0]", "--lcm-url", own_url(8), "--record", record});
  EXPECT_EQ(live.exit_code, 1) << live.errors;  // too short for its rules
  for (const char* sound : {"", "straight"}) {
    std::vector<std::string> arguments{"--log", record, "--algorithm", "naive", "--out", folder.file("out")};
    if (*sound != 0) arguments.insert(arguments.end(), {"--sound", sound});
    ASSERT_EQ(run_nav(arguments).exit_code, 0);
    const auto of_run = estimates_in(record), of_record = estimates_in(folder.file("out/naive.lcm"));
    ASSERT_EQ(of_run.size(), 3U);
    for (const auto& [channel, estimates] : of_run) {
      EXPECT_EQ(estimates.size(), 100U) << channel;                   // period_s: 1
      const bool equal = *sound == 0 || channel == "craft.estimate";  // sound: rays; the craft receives no sound
      EXPECT_EQ(of_record.at(channel) == estimates, equal) << channel;
    }
  }
}

/// Horizontal distances (m) of the AUV and the craft of `shadow` at the arrival of each packet.
std::vector<double> distances_of_packets(const std::string& log) {
  bridges::EventLogReader reader(log);
  std::vector<double> distances_m;
  std::map<std::int64_t, double> by_time;
  while (auto event = reader.next()) {
    if (event->channel == "sim.state") {
      const auto state = shoal::decode<shoal::sim_state_t>(event->payload, shoal::Finite::any);
      const auto &auv = state.position_m[0], &craft = state.position_m[1];
      by_time[state.utime] = std::hypot(auv[0] - craft[0], auv[1] - craft[1]);
    } else if (event->channel == "auv.modem") {
      const auto packet = shoal::decode<shoal::acoustic_received_t>(event->payload, shoal::Finite::any);
      distances_m.push_back(std::prev(by_time.upper_bound(packet.utime))->second);
    }
  }
  return distances_m;
}

TEST(Nav, WhereTheBottomAbsorbsDeliveriesEndAtTheEdgeOfTheShadow) {
  const ScratchFolder folder;
  const std::string record = folder.file("shadow.lcm");
  const std::vector<std::string> run{"run",
                                     source("worlds/benchmark/10_shadow.yaml"),
                                     "--launch",
                                     "--duration",
                                     "600",
                                     "--lcm-url",
                                     own_url(8),
                                     "--record",
                                     record,
                                     "--set",
                                     "acoustics.multipath.bottom.loss_dB=80"};
  run_shoal(run);
  const std::vector<double> distances_m = distances_of_packets(record);
  ASSERT_GT(distances_m.size(), 10U);
  // Rays end at 370 m.  Sound is diffracted as far as a ray misses the craft's modem, 1 m deep, by less than half of
  // sqrt(0.06 m x 400 m), 2.4 m: with g = 1.8 / s the edge moves by sqrt(2 c / g) (sqrt(3.4) - sqrt(1)) = 35 m.
  const double last_m = *std::max_element(distances_m.begin(), distances_m.end());
  EXPECT_GT(last_m, 370 - 10);
  EXPECT_LT(last_m, 370 + 35 + 10);
}

/// Two AUVs with GPS at the surface and a craft, for a minute; `seed` by the study.
std::string short_dive() {
  std::string vehicles, processes, metrics;
  for (const int slot : {0, 1}) {
    const std::string name = "auv" + std::to_string(slot + 1), north = std::to_string(40 * slot);
    vehicles += "  - {name: " + name + ", file: " + source("vehicles/benchmark_auv.yaml") + ", position_m: [0, " +
                north + ", -0.05]}\n";
    processes += "  - {name: " + name + ", client: " + name + ", program: shoal-nav, args: {name: " + name +
                 ", algorithm: iu, frame_bytes: 64, waypoints_m: [[200, " + north +
                 "]], depth_m: 5, surface_s: 5, slot: " + std::to_string(slot) + ", slots: 2, slot_s: 5}}\n";
    metrics += "  - {name: bound_" + name + ", type: bound, vehicle: " + name + ", from_s: 30}\n";
  }
  return "shoal: 1\nname: short_dive\nrun: {duration_s: 60}\nphysics: {step_s: 0.1}\nmedium: {water: {}}\n"
         "objects: [{name: bottom, fixed: true, position_m: [0, 0, -40], parts: [{shape: plane}]}]\nvehicles:\n" +
         vehicles + "processes:\n" + processes + "lockstep: {timeout_s: 1000, join_timeout_s: 1000}\nmetrics:\n" +
         metrics;
}

TEST(Nav, AStudyRunsAlgorithmsOnTheRecordOfEachRunAndVerifiesThem) {
  const ScratchFolder folder;
  system_test::write_file(folder.file("dive.yaml"), short_dive());
  system_test::write_file(folder.file("study.yaml"),
                          "shoal: 1\nstudy: dives\nworlds: [dive.yaml]\nlaunch: true\nseeds: [1, 2]\n"
                          "algorithms: [dr, iu, cekf]\npairs: dr\npass: [max(dive.cekf.rms_m) < 20]\n");
  std::vector<std::string> command{
      "study",        folder.file("study.yaml"), "--output",     folder.file("out"), "--jobs", "1",
      "--allow-path", folder.file(""),           "--allow-path", source("vehicles")};
  const Ended ended = run_shoal(command);
  ASSERT_EQ(ended.exit_code, 0) << ended.errors << ended.output;
  EXPECT_THAT(ended.output, HasSubstr("dive   cekf              2  "));
  EXPECT_THAT(text_of_file(folder.file("out/algorithms.md")), HasSubstr("| dive | `iu` |"));
  EXPECT_THAT(text_of_file(folder.file("out/report.html")), HasSubstr("<h2>Algorithms</h2>"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("out/runs/dive/seed_1/algorithms.lcm")));  // it is large
  // The same runs again are equal bit for bit, and a changed digit is found.
  command[3] = folder.file("again");
  command.insert(command.end(), {"--verify", folder.file("out"), "--case", "dive"});
  const Ended verified = run_shoal(command);
  EXPECT_EQ(verified.exit_code, 0) << verified.errors << verified.output;
  EXPECT_THAT(verified.output, HasSubstr("dive, seed 2: equal: run hash "));
  EXPECT_THAT(verified.output, HasSubstr("2 of 2 runs are equal\nalgorithms.csv: 3 rows are those of study.csv\n"));
  std::string algorithms = text_of_file(folder.file("out/algorithms.csv"));
  algorithms.replace(algorithms.find("\ndive,iu,2,") + 9, 1, "3");
  system_test::write_file(folder.file("out/algorithms.csv"), algorithms);
  std::string table = text_of_file(folder.file("out/study.csv"));
  table.insert(table.rfind("\ndive,2,") + 7, "1");  // seed 2 becomes seed 12
  system_test::write_file(folder.file("out/study.csv"), table);
  const Ended different = run_shoal(command);
  EXPECT_EQ(different.exit_code, 1);
  EXPECT_THAT(different.output, HasSubstr("dive, seed 2: the table has no such run\n1 of 2 runs are equal\n"));
  EXPECT_THAT(different.output, HasSubstr("algorithms.csv:3: 'runs' is '3', study.csv gives '2'\n"));
}

TEST(Nav, AStudyOfAnUnknownAlgorithmIsRefusedBeforeItsRuns) {
  const ScratchFolder folder;
  system_test::write_file(folder.file("dive.yaml"), short_dive());
  system_test::write_file(folder.file("study.yaml"),
                          "shoal: 1\nstudy: dives\nworlds: [dive.yaml]\nlaunch: true\nseeds: [1]\n"
                          "algorithms: [dr, kalman]\n");
  const std::vector<std::string> command{"study",        folder.file("study.yaml"), "--output",     folder.file("out"),
                                         "--allow-path", folder.file(""),           "--allow-path", source("vehicles")};
  const Ended ended = run_shoal(command);
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("study.yaml:6:13: 'algorithms': unknown algorithm 'kalman'; known algorithms:"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("out")));
}

TEST(Nav, ListsItsAlgorithms) {
  const Ended all = run_nav({"--list"});
  EXPECT_EQ(all.exit_code, 0);
  EXPECT_THAT(all.output, HasSubstr("cekf       centralized extended Kalman filter"));
  EXPECT_EQ(run_nav({"--list", "--algorithm", "luck"}).exit_code, 2);
}

TEST(Nav, WrongUsageIsExitCodeTwoAndSaysWhat) {
  const std::vector<std::pair<std::vector<std::string>, const char*>> mistakes = {
      {{}, "--name is required"},
      {{"--name", "a", "--circle-m", "[0,0,10]", "--algorithm", "luck"}, "unknown algorithm 'luck'"},
      {{"--name", "a", "--circle-m", "[0,0,10]", "--algorithm", "cekf"}, "cekf has the measurements of all vehicles"},
      {{"--name", "a", "--circle-m", "[0,0,10]", "--frame-bytes", "10"}, "--frame-bytes"},
      {{"--name", "a", "--follow", "b", "--follow-offset-m", "[0,10]"}, "--follow needs frames with the state"},
      {{"--name", "a", "--circle-m", "[0,0,10]", "--algorithm", "python:Mine"}, "python:FILE.Class"},
      {{"--log", "a.lcm"}, "--algorithm is required"},
      {{"--log", "a.lcm", "--algorithm", "naive", "--frame-bytes", "300"}, "--frame-bytes"},
  };
  for (const auto& [arguments, reports] : mistakes) {
    const Ended ended = run_nav(arguments);
    EXPECT_EQ(ended.exit_code, 2) << reports;
    EXPECT_THAT(ended.errors, HasSubstr(reports));
  }
}

TEST(Nav, AnAlgorithmWhosePayloadDoesNotFitIsRefused) {
  const ScratchFolder folder;
  const std::string record = folder.file("short.lcm");
  run_shoal(
      {"run", source("worlds/benchmark/03_team_dive.yaml"), "--duration", "1", "--bus", "none", "--record", record});
  const Ended ended = run_nav({"--log", record, "--algorithm", "osm", "--frame-bytes", "32"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("osm needs frames with 57 bytes of payload, these have 22"));
  const Ended unknown = run_nav({"--log", record, "--algorithm", "kalman"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("unknown algorithm 'kalman'; known algorithms: cekf,"));
}

/// Rows of the table by algorithm and vehicle: rms, m.
std::map<std::string, double> rms_in(const std::string& output) {
  std::map<std::string, double> rms;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string algorithm, vehicle;
    double rms_m = 0, nees = 0, inside = 0;
    if (words >> algorithm >> vehicle >> rms_m >> nees >> inside) rms[algorithm + " " + vehicle] = rms_m;
  }
  return rms;
}

TEST(Nav, RoversOfARecordNavigateByWhatTheySawAndReceived) {
  const ScratchFolder folder;
  const std::string record = folder.file("land.lcm");
  const Ended run = run_shoal({"run", source("worlds/benchmark/13_coop_land.yaml"), "--launch", "--duration", "100",
                               "--lcm-url", own_url(9), "--record", record});
  ASSERT_LE(run.exit_code, 1) << run.errors;
  const std::vector<std::string> arguments = {"--log",    record, "--algorithm", "dr,naive,ci,luft,cekf",
                                              "--from-s", "30",   "--out",       folder.file("out")};
  const Ended ended = run_nav(arguments);
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("benchmark_coop_land: 3 vehicles"));
  const auto rms_m = rms_in(ended.output);
  ASSERT_EQ(rms_m.size(), 15U) << ended.output;
  // Rover 3 has no GPS: by odometry alone it is wrong by a meter after a corner or two.
  for (const char* algorithm : {"naive", "ci", "luft", "cekf"})
    EXPECT_LT(rms_m.at(std::string(algorithm) + " rover3"), 0.6 * rms_m.at("dr rover3")) << algorithm;
  EXPECT_TRUE(std::filesystem::exists(folder.file("out/cekf/rover3.csv")));
  const auto first = estimates_in(folder.file("out/luft.lcm"));
  EXPECT_EQ(first.size(), 3U);
  ASSERT_EQ(run_nav(arguments).exit_code, 0);
  EXPECT_EQ(estimates_in(folder.file("out/luft.lcm")), first);
}

/// Two robots, of which the first drives east by 0.1 m/s, says 0.11, and sees the second, which stands.
void write_data_set(const ScratchFolder& folder) {
  constexpr double start_s = 1248272272;
  std::map<std::string, std::string> files = {{"Barcodes.dat", "# Subject # Barcode #\n1 5\n2 14\n6 72\n"},
                                              {"Landmark_Groundtruth.dat", "6 3.0 4.0 0.0001 0.0001\n"}};
  for (int i = 0; i <= 1000; ++i) {
    const double t = start_s + 0.1 * i;
    files["Robot1_Groundtruth.dat"] += fmt::format("{:.3f} {:.4f} 2.0 0.0\n", t, 1 + 0.01 * i);
    files["Robot2_Groundtruth.dat"] += fmt::format("{:.3f} 12.0 4.0 1.5\n", t);
    files["Robot1_Odometry.dat"] += fmt::format("{:.3f} 0.11 0.0\n", t);
    files["Robot2_Odometry.dat"] += fmt::format("{:.3f} 0.0 0.0\n", t);
    if (i % 10 != 5) continue;
    const double x_m = 11 - 0.01 * i, y_m = 2;
    files["Robot1_Measurement.dat"] +=
        fmt::format("{:.3f} 14 {:.4f} {:.4f}\n{:.3f} 72 3.0 0.1\n", t, std::hypot(x_m, y_m), std::atan2(y_m, x_m), t);
    files["Robot2_Measurement.dat"] += "# nothing\n";
  }
  for (const auto& [name, text] : files) std::ofstream(folder.file(name)) << text;
}

TEST(Nav, RobotsOfAnImportedDataSetNavigateByWhatTheySaw) {
  const ScratchFolder folder;
  write_data_set(folder);
  const std::string record = folder.file("robots.lcm");
  const Ended import = run_shoal({"import", "mrclam", folder.file("."), "--output", record});
  ASSERT_EQ(import.exit_code, 0) << import.errors;
  const Ended ended = run_nav({"--log", record, "--algorithm", "dr,naive,ci,luft,cekf", "--from-s", "50"});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  const auto rms_m = rms_in(ended.output);
  ASSERT_EQ(rms_m.size(), 10U) << ended.output;
  // 10 % too much of 10 m, at 50 to 100 s.
  EXPECT_NEAR(rms_m.at("dr robot1"), 0.76, 0.05);
  // The second robot is as uncertain of its own motion: a filter of both shares the difference.
  for (const char* algorithm : {"naive", "ci", "luft", "cekf"})
    EXPECT_LT(rms_m.at(std::string(algorithm) + " robot1"), 0.6) << algorithm;
}

TEST(Nav, AWorldWithoutAVehicleThatItCanNavigateIsRefused) {
  const ScratchFolder folder;
  const std::string record = folder.file("segway.lcm");
  run_shoal({"run", source("worlds/segway.yaml"), "--duration", "1", "--bus", "none", "--record", record});
  const Ended ended = run_nav({"--log", record, "--algorithm", "dr"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("has no vehicle that shoal-nav can navigate"));
}

TEST(Nav, ALogThatIsNotOfARunIsRefused) {
  EXPECT_EQ(run_nav({"--log", "/nonexistent/a.lcm", "--algorithm", "dr"}).exit_code, 4);
  const Ended ended = run_nav({"--log", source("README.md"), "--algorithm", "dr"});
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_THAT(ended.errors, HasSubstr("README.md: is not an LCM log"));
  const ScratchFolder folder;
  system_test::write_file(folder.file("a.mcap"), "not one");
  const Ended mcap = run_nav({"--log", folder.file("a.mcap"), "--algorithm", "dr"});
  EXPECT_EQ(mcap.exit_code, 4);
  EXPECT_THAT(mcap.errors, HasSubstr("a.mcap: is not an MCAP file"));
}

}  // namespace
