// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/log/event_log.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "tests/system/shoal_program.hpp"

// LCM's own logger and player work with Shoal as with any program.

namespace {

using namespace system_test;
using testing::HasSubstr;

/// The payloads of each channel of a log, which must be whole.
std::map<std::string, std::vector<sim::Bytes>> payloads_in(const std::string& path) {
  std::map<std::string, std::vector<sim::Bytes>> payloads;
  bridges::EventLogReader log(path);
  while (const auto event = log.next()) payloads[event->channel].push_back(event->payload);
  EXPECT_TRUE(log.problems().empty());
  return payloads;
}

/// Plays a log with lcm-logplayer and decodes what a listener receives.
std::map<std::string, int> played_back(const std::string& path, const std::string& speed) {
  bridges::LcmListener listener(own_url(2));
  listener.listen_to_all();
  Program player({"lcm-logplayer", "--speed=" + speed, "--lcm-url=" + own_url(2), path});
  std::map<std::string, int> received;
  while (true) {
    const bool over = !player.running();
    const auto message = listener.next(over ? 200ms : 20ms);
    if (!message && over) break;
    if (!message) continue;
    ++received[message->channel];
    if (message->channel == "rover1.odometry") {
      const auto odometry = shoal::decode<shoal::odometry_t>(message->payload, shoal::Finite::any);
      EXPECT_GT(odometry.utime, 0);
    } else if (message->channel == "rover1.lidar") {
      const auto lidar = shoal::decode<shoal::planar_lidar_t>(message->payload, shoal::Finite::any);
      EXPECT_EQ(lidar.nranges, 180);
    } else if (message->channel == "sim.state") {
      const auto state = shoal::decode<shoal::sim_state_t>(message->payload, shoal::Finite::any);
      EXPECT_EQ(state.count, 3);
    }
  }
  EXPECT_EQ(player.wait(), 0) << player.errors();
  return received;
}

TEST(LcmTools, LogAndPlayBackARunWithItsProcesses) {
  const ScratchFolder folder;
  Program logger({"lcm-logger", "--force", "--flush-interval=20", "--lcm-url=" + own_url(), folder.file("logger.lcm")});
  // It listens when the first probe is in the file.
  bridges::LcmListener probe(own_url());
  ASSERT_TRUE(await([&] {
    probe.publish("probe", lcm_test::bytes_of("are you there"));
    std::error_code error;
    const auto size = std::filesystem::file_size(folder.file("logger.lcm"), error);
    return !error && size > 0;
  }));
  const Ended ended = run_shoal({"run", source("worlds/coop_land.yaml"), "--launch", "--duration", "8", "--speed", "4",
                                 "--lcm-url", own_url(), "--record", folder.file("shoal.lcm")});
  EXPECT_TRUE(ended.exit_code == 0 || ended.exit_code == 1) << ended.errors;
  logger.send_signal(SIGINT);
  logger.wait();

  auto recorded = payloads_in(folder.file("shoal.lcm"));
  auto logged = payloads_in(folder.file("logger.lcm"));
  EXPECT_EQ(recorded["rover1.odometry"].size(), 160u);  // 20 Hz for 8 s
  // lcm-logger keeps 30 messages at most and loses some on a busy machine; what it has is what we recorded.
  for (const char* channel : {"rover1.odometry", "rover1.lidar", "sim.state"}) {
    EXPECT_GT(logged[channel].size(), 0u) << channel;
    for (const sim::Bytes& payload : logged[channel])
      EXPECT_EQ(std::count(recorded[channel].begin(), recorded[channel].end(), payload), 1) << channel;
  }
  for (const char* channel : {"rover1.drive.cmd", "rover3.estimate"}) {
    EXPECT_GT(logged[channel].size(), 0u) << channel;
    EXPECT_GE(recorded[channel].size(), 75u) << channel;  // 10 Hz for 8 s, less the start
  }

  for (const char* log : {"logger.lcm", "shoal.lcm"}) {
    const auto received = played_back(folder.file(log), "8");
    for (const char* channel : {"rover1.odometry", "rover1.lidar", "sim.state"})
      EXPECT_GT(received.count(channel), 0u) << log << " " << channel;
  }
}

TEST(LcmTools, InfoAndCsvReadARecord) {
  const ScratchFolder folder;
  const std::string log = folder.file("run.lcm");
  ASSERT_EQ(run_shoal({"run", source("worlds/minimal.yaml"), "--duration", "2", "--speed", "max", "--bus", "none",
                       "--record", log})
                .exit_code,
            0);
  const Ended info = run_shoal({"log", "info", log});
  EXPECT_EQ(info.exit_code, 0) << info.errors;
  for (const char* text : {"world minimal, seed 1", "rover1.odometry", "shoal.odometry_t", "sim.info"})
    EXPECT_NE(info.output.find(text), std::string::npos) << text << " in " << info.output;
  const Ended csv = run_shoal({"log", "csv", log, "rover1.odometry"});
  EXPECT_EQ(csv.exit_code, 0) << csv.errors;
  EXPECT_EQ(csv.output.substr(0, 16), "log_utime,utime,");
  EXPECT_EQ(std::count(csv.output.begin(), csv.output.end(), '\n'), 1 + 40);  // 20 Hz for 2 s
  EXPECT_EQ(run_shoal({"log", "csv", log, "rover9.odometry"}).exit_code, 4);
  EXPECT_EQ(run_shoal({"log", "info", folder.file("no.lcm")}).exit_code, 4);
}

TEST(LcmTools, TimesThatGoBackAndTimesThatRosCannotHoldAreReported) {
  const ScratchFolder folder;
  const auto record = [&](const std::string& name, const std::string& epoch) {
    return run_shoal({"run", source("worlds/minimal.yaml"), "--duration", "2", "--speed", "max", "--bus", "none",
                      "--set", "epoch=" + epoch, "--record", folder.file(name)});
  };
  ASSERT_EQ(record("a.lcm", "2026-01-01T00:00:00Z").exit_code, 0);
  write_file(folder.file("joined.lcm"), text_of_file(folder.file("a.lcm")) + text_of_file(folder.file("a.lcm")));
  const Ended info = run_shoal({"log", "info", folder.file("joined.lcm")});
  EXPECT_EQ(info.exit_code, 0) << info.errors;
  EXPECT_THAT(info.output, HasSubstr(" bytes, 2.000 s\n"));  // from the earliest to the latest
  EXPECT_THAT(info.errors, HasSubstr("joined.lcm: time goes back by 2 s at event "));
  // An epoch after the end of 32-bit seconds.
  ASSERT_EQ(record("late.lcm", "2040-01-01T00:00:00Z").exit_code, 0);
  const Ended mcap = run_shoal({"log", "mcap", folder.file("late.lcm"), "--out", folder.file("late.mcap")});
  EXPECT_EQ(mcap.exit_code, 4);
  EXPECT_THAT(mcap.errors,
              HasSubstr("the time 2040-01-01T00:00:00Z is outside of 1970-01-01T00:00:00Z to 2038-01-19T"));
  const Ended run = record("late.mcap", "2040-01-01T00:00:00Z");
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_THAT(run.errors, HasSubstr("late.mcap: the 'epoch' of the world cannot be recorded: the time 2040-01-01T"));
}

TEST(LcmTools, SpyShowsWhatIsOnTheBus) {
  Program spy({built("shoal"), "spy", "rover1.odometry", "--lcm-url", own_url()});
  Program shoal(
      {built("shoal"), "run", source("worlds/minimal.yaml"), "--duration", "forever", "--lcm-url", own_url()});
  EXPECT_TRUE(await([&] { return spy.output().find("shoal.odometry_t\n  utime=") != std::string::npos; }, timeout));
  spy.send_signal(SIGINT);
  EXPECT_EQ(spy.wait(), 0);
  shoal.send_signal(SIGINT);
  EXPECT_EQ(shoal.wait(), 130);
}

TEST(LcmTools, DoctorSaysThatLcmIsUsableHere) {
  const Ended ended = run_shoal({"doctor", "--lcm-url", own_url()});
  EXPECT_EQ(ended.exit_code, 0) << ended.output << ended.errors;
}

TEST(LcmTools, DoctorSaysThatTheFolderCannotBeWritten) {
  Program doctor({"env", "-C", "/proc", built("shoal"), "doctor", "--lcm-url", own_url()});
  EXPECT_EQ(doctor.wait(), 0) << doctor.output();
  EXPECT_THAT(doctor.output(),
              testing::ContainsRegex("warning folder: /proc cannot be written: .*; choose another folder"));
}

TEST(LcmTools, DoctorSaysThatTheDiskIsFull) {
  const ScratchFolder folder;
  const std::string disk = folder.file("disk");
  std::filesystem::create_directory(disk);
  const std::vector<std::string> enter = {
      "unshare", "-rm", "sh", "-c", "mount -t tmpfs -o size=64k tmpfs \"$0\" && cd \"$0\" && exec \"$@\"", disk};
  const auto inside = [&enter](std::vector<std::string> command) {
    command.insert(command.begin(), enter.begin(), enter.end());
    return command;
  };
  if (Program(inside({"true"})).wait() != 0) GTEST_SKIP() << "unshare -rm is not permitted here";
  Program doctor(inside({built("shoal"), "doctor", "--lcm-url", own_url()}));
  EXPECT_EQ(doctor.wait(), 0) << doctor.output();
  EXPECT_THAT(doctor.output(), testing::HasSubstr(disk + " has 0.0 GB free; free some space, or choose another"));
}

TEST(LcmTools, TheViewersScriptSaysWhatIsMissing) {
  Program without_jars({"env", "SHOAL_JAVA_FOLDER=/nowhere", source("tools/lcm-spy")});
  EXPECT_EQ(without_jars.wait(), 4);
  EXPECT_NE(
      without_jars.errors().find("/nowhere/lcm.jar is missing; install it with: sudo apt-get install liblcm-java"),
      std::string::npos)
      << without_jars.errors();
  Program misspelled({source("tools/lcm-spy"), "--url"});
  EXPECT_EQ(misspelled.wait(), 2);
}

TEST(LcmTools, TheViewersScriptMakesAClassOfEachType) {
  if (!std::filesystem::exists("/usr/share/java/lcm.jar") || !std::filesystem::exists("/usr/share/java/jchart2d.jar") ||
      !std::filesystem::exists("/usr/bin/javac"))
    GTEST_SKIP() << "liblcm-java or javac is not installed";
  Program script({source("tools/lcm-spy"), "--types-only"});
  ASSERT_EQ(script.wait(), 0) << script.errors();
  std::string folder = script.output();
  folder.erase(folder.find_last_not_of('\n') + 1);
  for (const auto& file : std::filesystem::directory_iterator(source("messages"))) {
    if (file.path().extension() != ".lcm") continue;
    EXPECT_TRUE(std::filesystem::exists(folder + "/shoal/" + file.path().stem().string() + ".class")) << file.path();
  }
}

}  // namespace
