// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/signing/signed_message.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "tests/system/shoal_program.hpp"

// Runs that are controlled with their key, as people and programs meet them: see docs/guides/access_control.md.

namespace {

using namespace system_test;
using testing::HasSubstr;
using testing::Not;

/// As own_url(), and messages may leave the machine.
std::string far_url() {
  std::string url = own_url();
  return url.replace(url.find("ttl=0"), 5, "ttl=1");
}

std::string key_in(const std::string& folder) {
  const std::string file = folder + "/run.key";
  EXPECT_TRUE(await([&] { return text_of_file(file).size() == 65; }, timeout));
  return text_of_file(file).substr(0, 64);
}

struct ControlKey : testing::Test {
  std::string results() const { return folder.file("results"); }
  std::unique_ptr<Program> run(const std::string& world, std::vector<std::string> options = {}) {
    std::vector<std::string> arguments{built("shoal"), "run", world, "--results", results(), "--no-plots"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return std::make_unique<Program>(arguments);
  }
  Ended control(std::vector<std::string> arguments) { return system_test::control(std::move(arguments), far_url()); }

  ScratchFolder folder;
};

TEST_F(ControlKey, IsNeededToQuitARunWhoseBusLeavesTheMachine) {
  const auto shoal = run(source("worlds/minimal.yaml"), {"--duration", "forever", "--lcm-url", far_url()});
  const std::string key = key_in(results());
  struct stat status {};
  ASSERT_EQ(stat((results() + "/run.key").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0600u);

  const Ended refused = control({"quit"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("this run can only be controlled with its key: use --run DIR, or set"));
  EXPECT_TRUE(shoal->running());
  EXPECT_EQ(control({"quit", "--run", results(), "--client", "operator"}).exit_code, 0);
  EXPECT_EQ(shoal->wait(), 0) << shoal->errors();

  EXPECT_THAT(shoal->errors(), HasSubstr("is refused: this run can only be controlled with its key"));
  EXPECT_THAT(shoal->errors(), HasSubstr("client 'operator' requests 'quit'"));
  const std::string summary = text_of_file(results() + "/summary.json");
  EXPECT_THAT(summary, HasSubstr("\"refused_requests\": 1"));
  EXPECT_THAT(summary, HasSubstr("\"signed_by\": \"operator\""));
  EXPECT_FALSE(std::filesystem::exists(results() + "/run.key"));
}

TEST_F(ControlKey, IsRefusedToWhoSendsACapturedRequestAgainAlsoInALaterRun) {
  const auto send = [](bridges::LcmListener& listener, const sim::Bytes& payload) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (std::chrono::steady_clock::now() < deadline) {
      listener.publish("sim.control", payload);
      const auto message = listener.next(500ms);
      if (message) return shoal::decode<shoal::sim_control_reply_t>(message->payload, shoal::Finite::any);
    }
    return shoal::sim_control_reply_t{};
  };
  bridges::LcmListener listener(own_url());
  listener.listen("sim.control.reply");
  shoal::sim_control_request_t request{};
  request.id = 7;
  request.client = "operator";
  request.command = "pause";
  const std::vector<std::string> options{"--duration", "forever", "--lcm-url", own_url(), "--control-key"};
  auto shoal = run(source("worlds/minimal.yaml"), options);
  bridges::MessageSigner signer(bridges::RunKey::from_text(key_in(results()), "test"), "operator");
  const sim::Bytes captured = signer.sign("sim.control", shoal::encode(request));
  EXPECT_TRUE(send(listener, captured).ok);
  listener.publish("sim.control", captured);
  EXPECT_TRUE(await(
      [&] { return shoal->errors().find("it was sent before, and was received again") != std::string::npos; }, timeout))
      << shoal->errors();
  shoal->send_signal(SIGINT);
  EXPECT_EQ(shoal->wait(), 130);

  shoal = run(source("worlds/minimal.yaml"), options);
  key_in(results());
  while (listener.next(10ms)) {
  }
  EXPECT_THAT(send(listener, captured).text, HasSubstr("signed by 'operator', but not with the key of this run"));
  shoal->send_signal(SIGINT);
  EXPECT_EQ(shoal->wait(), 130);
}

TEST_F(ControlKey, IsHandedToLaunchedProgramsAndLeavesTheRunAsItIs) {
  const std::vector<std::string> options{"--launch", "--duration", "5", "--speed", "max", "--lcm-url", own_url()};
  const auto open = run(source("worlds/coop_land.yaml"), options);
  open->wait();
  const std::string hash = summary_value(results(), "run_hash");
  EXPECT_THAT(text_of_file(results() + "/summary.json"), HasSubstr("\"needs_key\": false"));

  std::vector<std::string> keyed = options;
  keyed.insert(keyed.end(), {"--control-key", "--record", folder.file("run.lcm")});
  const auto shoal = run(source("worlds/coop_land.yaml"), keyed);
  const std::string key = key_in(results());
  shoal->wait();
  EXPECT_EQ(summary_value(results(), "run_hash"), hash) << shoal->errors();
  EXPECT_THAT(text_of_file(results() + "/summary.json"), HasSubstr("\"needs_key\": true"));
  EXPECT_THAT(text_of_file(results() + "/summary.json"), HasSubstr("\"refused_requests\": 0"));

  const Ended replay = run_shoal({"replay", folder.file("run.lcm")});
  EXPECT_EQ(replay.exit_code, 0) << replay.output << replay.errors;
  EXPECT_THAT(replay.output, HasSubstr("equal for "));
  // Neither as text nor as bytes is the key in anything that stays.
  std::string bytes;
  for (std::size_t i = 0; i < key.size(); i += 2) bytes += static_cast<char>(std::stoi(key.substr(i, 2), nullptr, 16));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.file(""))) {
    if (!entry.is_regular_file()) continue;
    const std::string text = text_of_file(entry.path());
    EXPECT_EQ(text.find(key), std::string::npos) << entry.path();
    EXPECT_EQ(text.find(bytes), std::string::npos) << entry.path();
  }
  EXPECT_THAT(shoal->errors() + shoal->output(), Not(HasSubstr(key)));
}

TEST_F(ControlKey, IsNotNeededWithOpenControlWhichSaysSo) {
  const auto shoal =
      run(source("worlds/minimal.yaml"), {"--duration", "forever", "--lcm-url", far_url(), "--open-control"});
  EXPECT_EQ(control({"quit"}).exit_code, 0);
  EXPECT_EQ(shoal->wait(), 0) << shoal->errors();
  EXPECT_THAT(shoal->errors(),
              HasSubstr("--open-control: any program that reaches the network of this run can control it"));
}

TEST_F(ControlKey, IsInAFolderOfItsOwnWithoutResults) {
  Program shoal(
      {built("shoal"), "run", source("worlds/minimal.yaml"), "--duration", "forever", "--lcm-url", far_url()});
  const std::string before = "shoal control --run ";
  EXPECT_TRUE(await([&] { return shoal.errors().find(before) != std::string::npos; }, timeout));
  const std::string errors = shoal.errors();
  const auto begin = errors.find(before) + before.size();
  const std::string place = errors.substr(begin, errors.find(',', begin) - begin);
  EXPECT_EQ(key_in(place).size(), 64u);
  EXPECT_EQ(control({"quit", "--run", place}).exit_code, 0);
  EXPECT_EQ(shoal.wait(), 0) << shoal.errors();
  EXPECT_FALSE(std::filesystem::exists(place));
  const Ended late = control({"quit", "--run", place});
  EXPECT_NE(late.exit_code, 0);
  EXPECT_THAT(late.errors, HasSubstr("run.key: No such file or directory; the run has ended, does not need a key"));
}

TEST_F(ControlKey, IsReadFromTheEnvironment) {
  const auto shoal = run(source("worlds/minimal.yaml"), {"--duration", "forever", "--lcm-url", far_url()});
  const Program control({"/usr/bin/env", "SHOAL_RUN_KEY=" + key_in(results()), built("shoal"), "control", "quit",
                         "--timeout", "60", "--lcm-url", far_url()});
  EXPECT_EQ(shoal->wait(), 0) << shoal->errors();
}

/// A second program that answers the ticks of `pilot` before it does, and says that it published something.
TEST_F(ControlKey, IsNotAskedForAndForgedAnswersAreReportedByName) {
  write_file(folder.file("world.yaml"),
             "shoal: 1\nrun: {duration_s: 3, speed: 1}\nphysics: {step_s: 0.01, gravity_mps2: 0}\n"
             "processes: [{name: pilot, client: pilot, command: [" +
                 built("lockstep_pilot") +
                 ", --name, pilot, --vehicle, rover1, --lcm-url, '{lcm_url}']}]\n"
                 "objects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n"
                 "vehicles: [{name: rover1, file: " +
                 source("vehicles/rover.yaml") + "}]\n");
  bridges::LcmListener listener(own_url());
  listener.listen("sim.ack");
  const auto shoal =
      run(folder.file("world.yaml"), {"--launch", "--lcm-url", own_url(), "--record", folder.file("run.lcm")});
  for (int forged = 0; forged < 3;) {
    const auto message = listener.next(1s);
    if (!shoal->running()) break;
    if (!message) continue;
    auto ack = shoal::decode<shoal::sim_ack_t>(message->payload, shoal::Finite::any);
    if (ack.sequence == 0 || ack.count > 1000) continue;
    ack.channel.push_back("forged");
    ack.crc.push_back(1);
    ack.count = static_cast<std::int32_t>(ack.channel.size());
    listener.publish("sim.ack", shoal::encode(ack));
    ++forged;
  }
  EXPECT_EQ(shoal->wait(), 1) << shoal->errors();
  EXPECT_THAT(shoal->errors(), HasSubstr("client 'pilot' gave two different answers to the tick of step"));
  const std::string summary = text_of_file(results() + "/summary.json");
  EXPECT_THAT(summary, HasSubstr("\"kind\": \"contradiction\""));
  EXPECT_THAT(summary, HasSubstr("\"passed\": false"));
  const Ended replay = run_shoal({"replay", folder.file("run.lcm")});
  EXPECT_EQ(replay.exit_code, 0) << replay.output << replay.errors;
  EXPECT_THAT(replay.output, HasSubstr("note: in the run: client 'pilot' gave two different answers"));
}

}  // namespace
