// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/played_answers.hpp"

#include <gmock/gmock.h>

#include "bridges/log/event_log.hpp"
#include "bridges/log/recording_bus.hpp"
#include "experiment/replay/recorded_steps.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using experiment::PlayedAnswers;
using experiment::ReplayLog;
using testing::ElementsAre;
using testing::IsEmpty;

sim::Bytes command(double forward_mps) {
  shoal::twist_command_t message{};
  message.forward_mps = forward_mps;
  return shoal::encode(message);
}

/// The run had a command at steps 0, 10 and 20 for each of two rovers.
ReplayLog log_of_two_rovers() {
  ReplayLog log;
  for (const int step : {0, 10, 20})
    for (const char* channel : {"a.cmd", "b.cmd"}) log.inputs.push_back({step, "", channel, command(step)});
  log.inputs.insert(log.inputs.begin() + 2, {5, "serial", "/tmp/port", sim::Bytes(3)});
  return log;
}

std::vector<std::string> lines_of(const ReplayLog& log, const std::vector<std::pair<int, double>>& said_on_a,
                                  bool* all_equal = nullptr) {
  PlayedAnswers answers(log);
  for (int step = 0; step <= 20; ++step) {
    std::vector<sim::MessageGate::Delivery> input_record;
    for (const auto& [at, forward_mps] : said_on_a)
      if (at == step) input_record.push_back({"a.cmd", command(forward_mps)});
    answers.came(step, input_record);
  }
  if (all_equal != nullptr) *all_equal = answers.all_equal();
  return answers.to_lines(0.01);
}

const std::string other_rover = "1 more channels of the log without messages from this world";

TEST(PlayedAnswers, CountsWhatIsEqualChannelByChannel) {
  bool equal = false;
  EXPECT_THAT(lines_of(log_of_two_rovers(), {{0, 0}, {10, 10}, {20, 20}}, &equal),
              ElementsAre("a.cmd: 3 equal", other_rover));
  EXPECT_TRUE(equal);
}

TEST(PlayedAnswers, NamesTheFirstDifferenceWithItsTime) {
  bool equal = true;
  EXPECT_THAT(
      lines_of(log_of_two_rovers(), {{0, 0}, {10, 11}, {20, 21}}, &equal),
      ElementsAre("a.cmd: 1 equal, 2 different; first at step 10 (0.100 s): forward_mps is 10 in the log and 11 "
                  "here",
                  other_rover));
  EXPECT_FALSE(equal);
}

TEST(PlayedAnswers, CountsWhatIsTooFewAndTooMany) {
  bool equal = true;
  EXPECT_THAT(
      lines_of(log_of_two_rovers(), {{10, 10}, {11, 10}, {20, 20}}, &equal),
      ElementsAre("a.cmd: 2 equal, 1 missing here, 1 not in the log; first at step 0 (0.000 s): a message is in "
                  "the log and was not published here",
                  other_rover));
  EXPECT_FALSE(equal);
}

TEST(PlayedAnswers, WhoSaysNothingIsNotEqual) {
  bool equal = true;
  EXPECT_THAT(lines_of(log_of_two_rovers(), {}, &equal),
              ElementsAre("nothing was published here on a channel on which the world of the log received messages"));
  EXPECT_FALSE(equal);
}

TEST(RecordedSteps, GiveInputsBeforeTheStepThatTheyCameTo) {
  const test_support::ScratchFolder folder;
  ReplayLog log;
  log.path = folder.file("run.lcm");
  log.info.step_us = 10'000;
  log.info.epoch_utime = 1'000'000;
  const auto bytes = [](char c) { return sim::Bytes(3, static_cast<std::byte>(c)); };
  {
    sim::InProcessBus inner;
    bridges::RecordingBus bus(inner, log.path, log.info.epoch_utime);
    const auto publish = [&](const char* channel, char c, int step) {
      bus.publish(channel, bytes(c), sim::Time(10'000 * step));
    };
    publish("sim.info", 'i', 0);
    publish("lidar", 'a', 0);
    bus.set_time(sim::Time(0));
    bus.admitted(std::vector<sim::MessageGate::Delivery>{{"cmd", bytes('c')}});  // after step 0
    publish("lidar", 'b', 1);
    publish("sim.inputs", 'm', 1);
    publish("cmd", 'c', 2);  // an event says the same
    publish("sim.info", 'j', 2);
  }
  log.inputs.push_back({0, "", "cmd", bytes('c')});

  experiment::RecordedSteps steps(log);
  const auto texts = [&](auto&& give) {
    std::vector<std::string> all;
    give([&](std::string_view channel, std::span<const std::byte> payload) {
      all.push_back(std::string(channel) + " " + static_cast<char>(payload[0]));
    });
    return all;
  };
  const auto published = [&](int step) { return texts([&](const auto& use) { steps.published_at(step, use); }); };
  const auto input_record = [&](int step) { return texts([&](const auto& use) { steps.inputs_after(step, use); }); };
  EXPECT_THAT(published(0), ElementsAre("lidar a"));  // the first sim.info is the player's
  EXPECT_THAT(input_record(0), ElementsAre("cmd c"));
  EXPECT_THAT(published(1), ElementsAre("lidar b"));
  EXPECT_THAT(input_record(1), IsEmpty());
  EXPECT_THAT(published(2), ElementsAre("cmd c", "sim.info j"));
  EXPECT_THAT(published(3), IsEmpty());
}

}  // namespace
