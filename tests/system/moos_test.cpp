// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/bridges/moos/small_moosdb.hpp"
#include "tests/own_ports.hpp"
#include "tests/system/shoal_program.hpp"

namespace {

using namespace system_test;
using moos_test::Msg;
using moos_test::SmallMoosClient;
using moos_test::SmallMoosDb;
using testing::HasSubstr;
using testing::Not;

int moos_port() {
  return test_support::own_port(5);
}

/// A helm that steers along waypoints through a MOOSDB, and answers each SHOAL_TIME: in place of pHelmIvP.
class StandInHelm {
 public:
  explicit StandInHelm(std::vector<std::pair<double, double>> waypoints)
      : waypoints_(std::move(waypoints)), thread_([this] { run(); }) {}
  ~StandInHelm() {
    stop_ = true;
    thread_.join();
  }
  /// Waypoints that were passed, closer than 5 m.
  std::size_t passed() const { return passed_; }

 private:
  void run() {
    while (!stop_) try {
        SmallMoosClient client(moos_port(), "stand_in_helm", {"NAV_X", "NAV_Y", "SHOAL_TIME"});
        while (!stop_ && !client.over())
          for (const Msg& msg : client.receive(50ms)) take(client, msg);
      } catch (const std::runtime_error&) {
        std::this_thread::sleep_for(20ms);  // no MOOSDB yet
      }
  }
  void take(SmallMoosClient& client, const Msg& msg) {
    if (msg.key == "NAV_X") x_ = msg.value;
    if (msg.key == "NAV_Y") y_ = msg.value;
    if (msg.key != "SHOAL_TIME") return;
    if (passed_ < waypoints_.size() && !std::isnan(x_) && !std::isnan(y_)) steer(client);
    client.notify("HELM_TIME", msg.value);
  }
  void steer(SmallMoosClient& client) {
    const auto [to_x, to_y] = waypoints_[passed_];
    if (std::hypot(to_x - x_, to_y - y_) < 5) ++passed_;
    const double heading_deg = std::atan2(to_x - x_, to_y - y_) * 180 / std::numbers::pi;
    client.notify("DESIRED_HEADING", heading_deg < 0 ? heading_deg + 360 : heading_deg);
    client.notify("DESIRED_SPEED", passed_ < waypoints_.size() ? 1.5 : 0.0);
  }

  const std::vector<std::pair<double, double>> waypoints_;
  double x_ = std::nan(""), y_ = std::nan("");
  std::atomic<std::size_t> passed_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

/// `shoal run` of the alpha mission with its bridge.
std::vector<std::string> alpha_run(const std::string& duration_s, const std::vector<std::string>& more) {
  std::vector<std::string> words{"run",        source("worlds/moos_alpha.yaml"),
                                 "--launch",   "--no-plots",
                                 "--lcm-url",  own_url(),
                                 "--duration", duration_s,
                                 "--set",      "bridges.moos.args.port=" + std::to_string(moos_port()),
                                 "--set",      "lockstep.timeout_s=1000",
                                 "--set",      "bridges.moos.args.moos=" + source("worlds/moos_alpha.moos")};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

const std::vector<std::string> in_lockstep{"--speed", "max",
                                           "--set",   "bridges.moos.client=alpha",
                                           "--set",   "bridges.moos.args.lockstep=true",
                                           "--set",   "bridges.moos.args.answer=HELM_TIME"};

TEST(Moos, AHelmOfTheCommunitySailsTheAlphaMissionAndTheRunRepeats) {
  std::string hash;
  for (int run = 0; run < 2; ++run) {
    SmallMoosDb db(moos_port());
    const StandInHelm helm({{60, -40}, {60, -100}, {110, -100}});
    // 72 + 60 + 50 m at 1.5 m/s take 122 s.
    const Ended ended = run_shoal(alpha_run("180", in_lockstep));
    EXPECT_EQ(ended.exit_code, 0) << ended.output << ended.errors;
    EXPECT_EQ(helm.passed(), 3U) << ended.errors;
    EXPECT_THAT(ended.output, Not(HasSubstr("not repeatable")));
    EXPECT_THAT(db.last("NODE_REPORT_LOCAL").first.text, HasSubstr("NAME=alpha,TYPE=usv,"));
    EXPECT_NEAR(db.last("NAV_LAT").first.value, 43.8253 - 100 / 111'100.0, 2e-4);  // a degree has 111.1 km here
    EXPECT_EQ(db.written("SHOAL_TIME"), 1801);                                     // ten a second, and the start
    if (run == 0)
      hash = run_hash_in(ended);
    else
      EXPECT_EQ(run_hash_in(ended), hash);
  }
}

TEST(Moos, AFreeRunSurvivesARestartOfTheMoosdbAndItsRecordReplays) {
  const ScratchFolder folder;
  auto db = std::make_unique<SmallMoosDb>(moos_port());
  const StandInHelm helm({{20, -10}, {20, -40}});
  std::vector<std::string> words = alpha_run("60", {"--speed", "4", "--record", folder.file("alpha.lcm")});
  words.insert(words.begin(), built("shoal"));
  Program run(words);
  ASSERT_TRUE(await([&] { return helm.passed() == 1; }, timeout)) << run.errors();
  db.reset();
  db = std::make_unique<SmallMoosDb>(moos_port());
  ASSERT_TRUE(await([&] { return helm.passed() == 2 || !run.running(); }, timeout)) << run.errors();
  EXPECT_EQ(run.wait(), 0) << run.errors();
  EXPECT_EQ(helm.passed(), 2U) << run.errors();
  EXPECT_GT(db->written("NAV_X"), 0);  // in the new MOOSDB
  EXPECT_THAT(run.output(), HasSubstr("not repeatable: bridge moos"));
  EXPECT_THAT(run.errors(), HasSubstr("trying again each second"));
  const Ended replay = run_shoal({"replay", folder.file("alpha.lcm")});
  EXPECT_EQ(replay.exit_code, 0) << replay.output << replay.errors;
  EXPECT_THAT(replay.output + replay.errors, HasSubstr("equal"));
}

TEST(Moos, AWorldWithAnotherOriginEndsTheBridgeWithOneMessage) {
  const ScratchFolder folder;
  const std::string file = folder.file("other.moos");
  write_file(file, "LatOrigin = 42.3584\nLongOrigin = -71.0876\n");
  const Ended ended =
      run_shoal(alpha_run("20", {"--speed", "max", "--set", "bridges.moos.args.moos=" + file, "--set",
                                 "bridges.moos.client=alpha", "--set", "bridges.moos.args.lockstep=true"}));
  EXPECT_EQ(ended.exit_code, 1) << ended.output << ended.errors;  // a program of the world has failed
  EXPECT_THAT(ended.errors, HasSubstr("LatOrigin and LongOrigin are 42.3584, -71.0876, and 'origin' of world "
                                      "'moos_alpha' is 43.8253, -70.3304"));
}

TEST(Moos, OnlyTheCommandLineNamesAnotherMachine) {
  const ScratchFolder folder;
  const std::string file = folder.file("far.moos");
  write_file(file, "ServerHost = 192.0.2.1\n");  // an address for documentation: no machine has it
  Program bridge({built("shoal-moos"), "--name", "alpha", "--moos", file, "--lcm-url", own_url()});
  EXPECT_EQ(bridge.wait(), 2);
  EXPECT_THAT(bridge.errors(), HasSubstr("far.moos:1: 'ServerHost' is another machine, '192.0.2.1'"));
  const Ended world = run_shoal(alpha_run("1", {"--set", "bridges.moos.args.peer=192.0.2.1"}));
  EXPECT_EQ(world.exit_code, 2);
  EXPECT_THAT(world.errors, HasSubstr("bridge 'moos': program 'shoal-moos': unknown argument 'peer'"));
}

TEST(FrontSeat, ABackSeatSteersTheBoat) {
  const std::string port = std::to_string(test_support::own_port(6));
  std::vector<std::string> words{built("shoal"), "run",     source("worlds/moos_alpha.yaml"),
                                 "--lcm-url",    own_url(), "--duration",
                                 "forever",      "--speed", "10"};
  Program run(words);
  Program seat({built("shoal-frontseat"), "--name", "alpha", "--port", port, "--lcm-url", own_url()});
  ASSERT_TRUE(await([&] { return seat.errors().find("at 127.0.0.1:" + port) != std::string::npos; }, timeout));
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = moos_test::loopback(std::stoi(port));
  ASSERT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  const timeval wait{240, 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
  const auto write = [&](const std::string& line) {
    EXPECT_EQ(send(fd, line.data(), line.size(), MSG_NOSIGNAL), static_cast<ssize_t>(line.size()));
  };
  std::string text;
  const auto read_until = [&](const auto& condition) {
    char bytes[4096];
    for (ssize_t count = 1; count > 0 && !condition() && text.size() < 1'000'000;) {
      count = recv(fd, bytes, sizeof bytes, 0);
      if (count > 0) text.append(bytes, static_cast<std::size_t>(count));
    }
    return condition();
  };
  write("START,LAT:43.8253,LON:-70.3304,DURATION:0,FREQ:10,WARP:10\r\n");
  // A command before the run has begun would reach no one.
  EXPECT_TRUE(read_until([&] { return text.find("NAV,LAT:43.825") != std::string::npos; })) << seat.errors();
  write("CMD,HEADING:200,SPEED:1,DEPTH:0\r\n");
  const auto turned = [&] {  // NAV,...,HEADING:199.8,SPEED:1.0
    const auto at = text.rfind("HEADING:", text.rfind('\n'));
    return at != std::string::npos && std::abs(std::stod(text.substr(at + 8)) - 200) < 5;
  };
  EXPECT_TRUE(read_until(turned)) << text.substr(0, 1000) << seat.errors();
  close(fd);
  EXPECT_THAT(text, testing::StartsWith("CTRL,STATE:PAYLOAD\r\n"));
  EXPECT_THAT(text, HasSubstr("\r\nCMD,RESULT:OK\r\n"));
  EXPECT_EQ(control({"quit"}).exit_code, 0);
  EXPECT_EQ(run.wait(), 0) << run.errors();
}

}  // namespace
