// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bridges/lcm/lcm_listener.hpp"
#include "experiment/drive/input_events.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_state_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/system/on_terminal.hpp"
#include "tests/system/shoal_program.hpp"

// `shoal drive`, and driving from the live page.

namespace {

using namespace system_test;
using testing::HasSubstr;

class DriveTest : public testing::Test {
 protected:
  DriveTest() : lcm_(own_url()) {
    lcm_.listen("sim.state");
    lcm_.listen("rover1.drive.cmd");
  }

  void start(const std::vector<std::string>& options = {}, const std::string& more = "") {
    write_file(folder_.file("world.yaml"), endless_world(more));
    std::vector<std::string> arguments{built("shoal"), "run", folder_.file("world.yaml"), "--lcm-url", own_url(),
                                       "--record",     log_};
    arguments.insert(arguments.end(), options.begin(), options.end());
    run_ = std::make_unique<Program>(arguments);
    ASSERT_TRUE(await_state([](const shoal::sim_state_t&) { return true; })) << run_->errors();
  }

  /// Takes messages until a command of this kind comes.  `sign_of_life` is given meanwhile: each is good for 0.2 s, in
  /// which a busy machine may send no command.
  bool await_speed(const std::function<bool(double)>& holds, const std::function<void()>& sign_of_life = {}) {
    auto next = std::chrono::steady_clock::now();
    return await_message([&](const bridges::Received& message) {
      if (sign_of_life && std::chrono::steady_clock::now() >= next) {
        sign_of_life();
        next += 50ms;
      }
      if (message.channel != "rover1.drive.cmd") return false;
      last_mps_ = shoal::decode<shoal::twist_command_t>(message.payload, shoal::Finite::required).forward_mps;
      return holds(last_mps_);
    });
  }
  bool await_state(const std::function<bool(const shoal::sim_state_t&)>& holds) {
    return await_message([&](const bridges::Received& message) {
      return message.channel == "sim.state" &&
             holds(shoal::decode<shoal::sim_state_t>(message.payload, shoal::Finite::required));
    });
  }
  /// Waits until a vehicle has gone 0.3 m along x; of the commands to rover1 none may come on the bus of the world.
  bool await_move(std::size_t vehicle) {
    return await_message([&](const bridges::Received& message) {
      EXPECT_NE(message.channel, "rover1.drive.cmd");
      if (message.channel != "sim.state") return false;
      const auto state = shoal::decode<shoal::sim_state_t>(message.payload, shoal::Finite::required);
      return state.position_m.size() > vehicle && state.position_m[vehicle][0] > 0.3;
    });
  }
  bool await_message(const std::function<bool(const bridges::Received&)>& holds) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (std::chrono::steady_clock::now() < deadline)
      if (const auto message = lcm_.next(100ms); message && holds(*message)) return true;
    return false;
  }

  /// Waits for the address of the live page, and returns its token.
  std::string await_token() {
    EXPECT_TRUE(await([&] { return run_->errors().find("#t=") != std::string::npos; }, timeout));
    const std::string errors = run_->errors();
    const std::size_t token = errors.find("#t=") + 3, port = errors.find("127.0.0.1:") + 10;
    port_ = static_cast<std::uint16_t>(std::stoi(errors.substr(port)));
    return errors.substr(token, errors.find_first_of(" \n", token) - token);
  }
  web_test::Client page(const std::string& token) const {
    web_test::Client client(port_);
    client.upgrade();
    client.send_json({{"op", "hello"}, {"token", token}});
    return client;
  }
  static web_test::Json ahead(const std::string& vehicle) {
    return {{"op", "drive"}, {"id", 7}, {"vehicle", vehicle}, {"kind", "twist"}, {"values", {{"forward", 0.5}}}};
  }

  /// Ends the run, and proves that its log can be repeated.
  void replay() {
    EXPECT_EQ(control({"quit"}).exit_code, 0);
    EXPECT_EQ(run_->wait(), 0) << run_->errors();
    const Ended again = run_shoal({"replay", "--quiet", log_});
    EXPECT_EQ(again.exit_code, 0) << again.output << again.errors;
    EXPECT_THAT(again.output, HasSubstr("equal for "));
  }

  ScratchFolder folder_;
  const std::string log_ = folder_.file("run.lcm");
  bridges::LcmListener lcm_;
  std::unique_ptr<Program> run_;
  double last_mps_ = 0;
  std::uint16_t port_ = 0;
};

/// Keys of a world: the rover has its own bus.
std::string own_bus() {
  return "    bus: own\nbuses: [{name: own, lcm_url: '" + own_url(1) + "'}]\n";
}

/// Events of a gamepad: the left shoulder button is held from 0.1 s to `until_s`, with the stick up.
std::string pad_events(double until_s) {
  std::string bytes;
  const auto add = [&bytes](double at_s, std::uint16_t type, std::uint16_t code, std::int32_t value) {
    const auto event = experiment::bytes_of({1'000'000 + std::llround(at_s * 1e6), type, code, value});
    bytes.append(reinterpret_cast<const char*>(event.data()), event.size());
  };
  add(0, experiment::InputEvent::axis, 1, -32768);
  add(0.1, experiment::InputEvent::button, 310, 1);
  add(until_s, experiment::InputEvent::button, 310, 0);
  add(until_s + 0.5, experiment::InputEvent::report, 0, 0);
  return bytes;
}

TEST_F(DriveTest, AGamepadDrivesARunThatReplaysEqual) {
  start();
  write_file(folder_.file("pad.events"), pad_events(1.5));
  const Ended drive = run_shoal({"drive", "rover1", "--events", folder_.file("pad.events"), "--lcm-url", own_url()});
  EXPECT_EQ(drive.exit_code, 0) << drive.errors;
  EXPECT_TRUE(await_speed([](double mps) { return mps == 1; }));
  EXPECT_TRUE(await_speed([](double mps) { return mps == 0; }));
  // It has moved, and stands.
  EXPECT_TRUE(await_state([](const shoal::sim_state_t& state) {
    return state.position_m[0][0] > 0.3 && std::abs(state.velocity_mps[0][0]) < 1e-3;
  }));
  replay();
}

TEST_F(DriveTest, KeysOfATerminalMoveUntilTheyAreReleased) {
  start();
  OnTerminal drive({built("shoal"), "drive", "rover1", "--lcm-url", own_url()});
  ASSERT_TRUE(drive.shows("hold 'space' to move"));
  ASSERT_TRUE(await([&] { return drive.is_raw(); }, timeout));
  const auto hold = [&] { drive.press(" "); };
  drive.press("w\x1b[A");
  EXPECT_TRUE(await_speed([](double mps) { return mps == 0.5; }, hold)) << last_mps_;
  // Nothing more comes from the terminal: it stops.
  EXPECT_TRUE(await_speed([](double mps) { return mps == 0; })) << last_mps_;
  EXPECT_TRUE(await_speed([](double mps) { return mps == 0.5; }, hold)) << last_mps_;
  kill(drive.pid(), SIGINT);
  EXPECT_EQ(drive.wait(), 0);
  EXPECT_TRUE(await_speed([](double mps) { return mps == 0; })) << last_mps_;
  replay();
}

TEST_F(DriveTest, APageDrivesAndStopsWhenItLeaves) {
  start({"--view", "--view-port", "0"});
  const std::string token = await_token();
  const web_test::Json command = ahead("rover1");
  const auto reply = [](web_test::Client& client) -> web_test::Json {
    while (const auto frame = client.read_frame())
      if (frame->is_text() && frame->json()["op"] == "reply") return frame->json();
    return {};
  };
  // Without the token it is refused.
  web_test::Client reader = page("");
  reader.send_json(command);
  const web_test::Json refused = reply(reader);
  EXPECT_EQ(refused["id"], 7);
  EXPECT_EQ(refused["ok"], false);
  // It drives, and stops without further messages, and when the page goes.
  web_test::Client driver = page(token);
  const auto drive = [&] { driver.send_json(command); };
  EXPECT_TRUE(await_speed([](double mps) { return mps == 0.5; }, drive)) << last_mps_;
  EXPECT_TRUE(await_speed([](double mps) { return mps == 0; })) << last_mps_;
  EXPECT_TRUE(await_speed([](double mps) { return mps == 0.5; }, drive)) << last_mps_;
  driver.reset();
  EXPECT_TRUE(await_speed([](double mps) { return mps == 0; })) << last_mps_;
  replay();
}

TEST_F(DriveTest, AVehicleWithItsOwnBusIsDrivenOnIt) {
  start({}, own_bus());
  write_file(folder_.file("pad.events"), pad_events(1.5));
  const Ended drive = run_shoal({"drive", "rover1", "--events", folder_.file("pad.events"), "--lcm-url", own_url()});
  EXPECT_EQ(drive.exit_code, 0) << drive.errors;
  EXPECT_TRUE(await_move(0));
  replay();
}

TEST_F(DriveTest, APageDrivesVehiclesWithTheirOwnBusAlsoSpawnedOnes) {
  start({"--view", "--view-port", "0"}, own_bus());
  EXPECT_THAT(control({"bus", "rover1"}).output, testing::StartsWith(own_url(1)));
  const Ended spawned = control({"spawn", "{name: guest, bus: own, position_m: [0, 5, 0], file: rover.yaml}"});
  ASSERT_EQ(spawned.exit_code, 0) << spawned.errors;
  web_test::Client driver = page(await_token());
  for (const std::size_t vehicle : {0, 1}) {
    // The dead-man key is held until the vehicle has moved.
    std::atomic<bool> holds = true;
    std::thread driving([&] {
      for (; holds; std::this_thread::sleep_for(50ms)) driver.send_json(ahead(vehicle == 0 ? "rover1" : "guest"));
    });
    EXPECT_TRUE(await_move(vehicle)) << vehicle;
    holds = false;
    driving.join();
  }
  replay();
}

/// The kind is not named: twist is the first one by which the Segway can be driven.
TEST_F(DriveTest, TheSegwayIsDrivenThroughTheProgramThatBalancesIt) {
  lcm_.listen("segway1.balance.cmd");
  run_ = std::make_unique<Program>(std::vector<std::string>{built("shoal"), "run", source("worlds/segway.yaml"),
                                                            "--launch", "--speed", "1", "--duration", "600", "--set",
                                                            "events=[]", "--lcm-url", own_url()});
  ASSERT_TRUE(await_state([](const shoal::sim_state_t&) { return true; })) << run_->errors();
  write_file(folder_.file("pad.events"), pad_events(1.5));
  const Ended drive = run_shoal({"drive", "segway1", "--events", folder_.file("pad.events"), "--lcm-url", own_url()});
  EXPECT_EQ(drive.exit_code, 0) << drive.errors;
  EXPECT_TRUE(await_message([](const bridges::Received& message) {
    return message.channel == "segway1.balance.cmd" &&
           shoal::decode<shoal::twist_command_t>(message.payload, shoal::Finite::required).forward_mps == 1;
  }));
  EXPECT_EQ(control({"quit"}).exit_code, 0);
  run_->wait();
}

TEST_F(DriveTest, SaysWhyAVehicleIsNotDriven) {
  start();
  write_file(folder_.file("pad.events"), pad_events(0.2));
  const auto drive = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"drive", "--lcm-url", own_url(), "--events", folder_.file("pad.events")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_shoal(arguments);
  };
  const Ended unknown = drive({"rover9"});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.errors, HasSubstr("there is no vehicle 'rover9'"));
  const Ended kind = drive({"rover1", "--kind", "helm"});
  EXPECT_EQ(kind.exit_code, 2);
  EXPECT_THAT(kind.errors, HasSubstr("vehicle 'rover1' cannot be driven by 'helm', only by: twist, thrust"));
  write_file(folder_.file("pad.yaml"), "rate_hz: 1\n");
  const Ended profile = drive({"rover1", "--profile", folder_.file("pad.yaml")});
  EXPECT_EQ(profile.exit_code, 2);
  EXPECT_THAT(profile.errors, HasSubstr("pad.yaml:1:10: drive profile: 'rate_hz' must be"));
}

TEST(DriveProfile, ThePrintedProfileIsRead) {
  const ScratchFolder folder;
  const Ended printed = run_shoal({"drive", "--print-profile"});
  EXPECT_EQ(printed.exit_code, 0);
  write_file(folder.file("pad.yaml"), printed.output);
  const Ended ended = run_shoal({"drive", "v", "--profile", folder.file("pad.yaml")});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("needs a terminal, or --gamepad or --events"));
}

}  // namespace
