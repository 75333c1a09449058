// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <stdlib.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "bridges/lcm/lcm_listener.hpp"
#include "shoal/image_t.hpp"
#include "shoal/imu_t.hpp"
#include "shoal/message_codec.hpp"
#include "tests/bridges/dds/own_domain.hpp"
#include "tests/system/shoal_program.hpp"

// `shoal-ros2` with Fast DDS at the other end: ros2_judge has no code of Shoal.

namespace {

using namespace system_test;
using testing::HasSubstr;

class Ros2Test : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(built("ros2_judge")))
      GTEST_SKIP() << "Fast DDS is not installed: nothing judges shoal-ros2";
    unsetenv("FASTRTPS_DEFAULT_PROFILES_FILE");  // the settings of a user who has set nothing
    setenv("ROS_DOMAIN_ID", std::to_string(dds_test::own_domain()).c_str(), 1);
    write_file(folder_.file("probe.yaml"), "include: " + source("vehicles/rover.yaml") +
                                               "\nshoal: 1\nvehicle: probe\n"
                                               "devices: [{name: imu, type: imu, preset: adis16470, rate_hz: 100}]\n");
  }
  void start_door(const std::vector<std::string>& options = {}) {
    std::vector<std::string> all{built("shoal-ros2"), "--lcm-url", own_url()};
    all.insert(all.end(), options.begin(), options.end());
    door_ = std::make_unique<Program>(all);
  }
  /// A run of a rover; `run`: keys of `run:`.
  std::unique_ptr<Program> run(const std::string& run, const std::vector<std::string>& options = {}) const {
    write_file(folder_.file("world.yaml"), "shoal: 1\nname: yard\nrun: {" + run +
                                               "}\nobjects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n"
                                               "vehicles: [{name: rover1, file: probe.yaml}]\n");
    std::vector<std::string> all{built("shoal"), "run", folder_.file("world.yaml"), "--lcm-url", own_url()};
    all.insert(all.end(), options.begin(), options.end());
    return std::make_unique<Program>(all);
  }
  std::unique_ptr<Program> judge(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all{built("ros2_judge"), std::to_string(dds_test::own_domain())};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return std::make_unique<Program>(all);
  }
  /// Publishes messages at a rate, the first with stamp 0 until the judge has received one, then with rising stamps
  /// until it has all that it counts: a busy machine may lose some.
  template <class Message>
  void publish(Program& judge, const std::string& channel, Message message, std::chrono::microseconds period) {
    bridges::LcmListener bus(own_url());
    auto next = std::chrono::steady_clock::now();
    while (judge.output().find("received") == std::string::npos) {
      if (!judge.output().empty()) message.utime += 1000;
      bus.publish(channel, shoal::encode(message));
      std::this_thread::sleep_until(next += period);
    }
  }
  void drive_a_rover() {
    start_door();
    const auto world = run("duration_s: forever, speed: 1");
    const auto driver = judge({"drive", "rover1"});
    EXPECT_EQ(driver->wait(), 0) << driver->output() << driver->errors() << door_->errors() << world->errors();
    // The clock is that of the world: its epoch, 2026-01-01, is 1767225600 s after 1970.
    EXPECT_THAT(driver->output(), HasSubstr("frame rover1/imu, child frame rover1, gravity 10 m/s2, clock 17672256"));
    world->send_signal(SIGINT);
    EXPECT_EQ(world->wait(), 130);
    door_->send_signal(SIGTERM);
    EXPECT_EQ(door_->wait(), 143);
    EXPECT_THAT(door_->errors(), HasSubstr("on this machine only"));
  }
  /// A run with a node in lockstep, to its end, which something happens to at 1 s; returns its hash.
  std::string run_in_lockstep(const std::function<void(std::unique_ptr<Program>& pilot)>& happens = {}) {
    start_door({"--lockstep", "pilot", "--period-s", "0.05"});
    auto pilot = judge({"lockstep", "pilot", "rover1"});
    const auto world = run("duration_s: 3, speed: max", {"--await", "shoal-ros2", "--paused"});
    run_until("1");
    if (happens) happens(pilot);
    control({"resume"});
    EXPECT_EQ(world->wait(), 0) << world->errors() << door_->errors() << pilot->errors();
    EXPECT_EQ(pilot->wait(), 0) << pilot->output() << pilot->errors() << door_->errors();
    EXPECT_EQ(door_->wait(), 0) << door_->errors();
    EXPECT_THAT(pilot->output(), testing::AllOf(HasSubstr(" ticks, x "), testing::Not(HasSubstr("x 0 m"))));
    return run_hash_in({0, world->output(), world->errors()});
  }

  ScratchFolder folder_;
  std::unique_ptr<Program> door_;
};

TEST_F(Ros2Test, AReaderOfFastDdsWithDefaultSettingsDrivesARoverByItsOdometry) {
  drive_a_rover();
}

TEST_F(Ros2Test, AReaderOfFastDdsAtTheLoopbackInterfaceDrivesARover) {
  setenv("FASTRTPS_DEFAULT_PROFILES_FILE", source("tests/system/ros2_judge/loopback.xml").c_str(), 1);
  drive_a_rover();
}

TEST_F(Ros2Test, MessagesOfASensorAt1kHzArriveInOrder) {
  start_door();
  const auto counter = judge({"imu", "/v/imu/imu", "3000"});
  publish(*counter, "v.imu", shoal::imu_t{}, 1ms);
  EXPECT_EQ(counter->wait(), 0) << counter->output() << counter->errors() << door_->errors();
}

TEST_F(Ros2Test, ImagesOf640By480At30HzArriveInOrder) {
  shoal::image_t image{};
  image.width = 640;
  image.height = 480;
  image.row_stride = 640 * 3;
  image.pixelformat = 859981650;  // RGB, 8 bits each
  image.size = image.row_stride * image.height;
  image.data.assign(static_cast<std::size_t>(image.size), 100);
  start_door();
  const auto counter = judge({"image", "/v/camera/image", "60"});
  publish(*counter, "v.camera", image, 33ms);
  EXPECT_EQ(counter->wait(), 0) << counter->output() << counter->errors() << door_->errors();
}

TEST_F(Ros2Test, RunsWithANodeInLockstepAreEqual) {
  EXPECT_EQ(run_in_lockstep(), run_in_lockstep());
}

TEST_F(Ros2Test, ALockstepThatIsRewoundEndsAsOneThatNeverWentBack) {
  const std::string straight = run_in_lockstep();
  const auto goes_back = [](std::unique_ptr<Program>&) {
    const Ended back = control({"rewind", "--value", "0.6"});
    EXPECT_EQ(back.exit_code, 0) << back.errors;
  };
  EXPECT_EQ(run_in_lockstep(goes_back), straight);
}

TEST_F(Ros2Test, ANodeThatIsKilledAndStartedAgainTakesUpItsLockstep) {
  const std::string straight = run_in_lockstep();
  const auto dies = [this](std::unique_ptr<Program>& pilot) {
    pilot->send_signal(SIGKILL);
    pilot->wait();
    pilot = judge({"lockstep", "pilot", "rover1"});
  };
  EXPECT_EQ(run_in_lockstep(dies), straight);
}

TEST_F(Ros2Test, MessagesOfOtherProgramsArriveBesideALockstep) {
  start_door({"--lockstep", "pilot"});
  const auto pilot = judge({"lockstep", "pilot", "rover1"});
  const auto world = run("duration_s: forever, speed: 1", {"--await", "shoal-ros2"});
  const auto counter = judge({"imu", "/v/imu/imu", "100"});
  publish(*counter, "v.imu", shoal::imu_t{}, 1ms);
  EXPECT_EQ(counter->wait(), 0) << counter->output() << counter->errors() << door_->errors();
  world->send_signal(SIGINT);
  EXPECT_EQ(world->wait(), 130);
}

TEST_F(Ros2Test, AClientInTheFormOfRmwCycloneddsStepsTheRun) {
  start_door({"--control"});
  const auto world = run("duration_s: forever", {"--paused"});
  const auto client = judge({"step", "10"});
  EXPECT_EQ(client->wait(), 0) << client->output() << client->errors() << door_->errors();
  // Its first call is 22; one that was lost, see ros2_judge, has no effect.
  EXPECT_THAT(client->output(), testing::MatchesRegex("client 11, call 2[0-9], result 1 ''\n"));
  EXPECT_THAT(control({"where"}).output, HasSubstr("step 10, "));
}

}  // namespace
