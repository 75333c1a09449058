// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "tests/system/lossy_relay.hpp"
#include "tests/system/shoal_program.hpp"

// Programs that add their robot to an empty world, balance it and leave: examples/ubersim_client.

namespace {

using namespace system_test;
using testing::HasSubstr;
using testing::MatchesRegex;

using Arguments = std::vector<std::string>;

const char* const empty_world =
    "shoal: 1\nname: empty\nphysics: {step_s: 0.005}\nobjects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n"
    "lockstep: {timeout_s: 60, join_timeout_s: 60}\n";

Arguments client(const Arguments& options, const std::string& file = source("examples/ubersim_client/segway.xml")) {
  Arguments arguments{built("ubersim_client"), file};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return arguments;
}

/// A run in which each of so many programs adds a robot at its first tick, and removes it half-way.
struct Crowd {
  int count = 2;
  Arguments run = {};  ///< more options
  bool is_reversed = false;
  std::string url = own_url(0), client_url = own_url(0);

  std::string go() const {
    setenv("LCM_DEFAULT_URL", client_url.c_str(), 1);
    const ScratchFolder folder;
    write_file(folder.file("empty.yaml"), empty_world);
    Arguments arguments{built("shoal"), "run", folder.file("empty.yaml"), "--lcm-url", url, "--speed", "max",
                        "--duration",   "1.2"};
    arguments.insert(arguments.end(), run.begin(), run.end());
    std::vector<Arguments> programs;
    for (int i = 0; i < count; ++i) {
      const std::string name = "robot" + std::to_string(i);
      arguments.insert(arguments.end(), {"--await", name});
      programs.push_back(
          client({"--name", name, "--position", "0", std::to_string(2 * i), "--seconds", "0.6", "--width", "16"}));
    }
    if (is_reversed) std::reverse(programs.begin(), programs.end());
    Program shoal(arguments);
    std::vector<std::unique_ptr<Program>> clients;
    for (const Arguments& each : programs) clients.push_back(std::make_unique<Program>(each));
    for (const auto& each : clients) {
      EXPECT_EQ(each->wait(), 0) << each->errors();
      EXPECT_THAT(each->output(), HasSubstr("images of 16x12, end: left"));
    }
    EXPECT_EQ(shoal.wait(), 0) << shoal.errors();
    return run_hash_in({0, shoal.output(), shoal.errors()});
  }
};

TEST(UbersimClient, TwoRobotsThatAddThemselvesAreOneRunInAnyOrder) {
  Crowd crowd{.count = 2};
  const std::string expected = crowd.go();
  EXPECT_THAT(expected, MatchesRegex("[0-9a-f]{16}"));
  for (const bool is_reversed : {true, false, true}) {
    crowd.is_reversed = is_reversed;
    EXPECT_EQ(crowd.go(), expected);
  }
}

TEST(UbersimClient, TenRobotsThatAddThemselvesAreOneRun) {
  Crowd crowd{.count = 10};
  const std::string expected = crowd.go();
  EXPECT_THAT(expected, MatchesRegex("[0-9a-f]{16}"));
  crowd.is_reversed = true;
  crowd.run = {"--threads", "2"};
  EXPECT_EQ(crowd.go(), expected);
}

TEST(UbersimClient, TwoRobotsAreTheSameRunOverANetworkThatLosesAThird) {
  Crowd crowd{.count = 2};
  const std::string expected = crowd.go();
  const LossyRelay relay(own_url(0), own_url(1), 0.3, 7);
  crowd.client_url = own_url(1);
  EXPECT_EQ(crowd.go(), expected);
}

TEST(UbersimClient, ARecordOfRobotsThatAddThemselvesIsReplayed) {
  const ScratchFolder folder;
  Crowd crowd{.count = 2};
  const std::string expected = crowd.go();
  crowd.run = {"--record", folder.file("run.lcm")};
  EXPECT_EQ(crowd.go(), expected);
  const Ended again = run_shoal({"replay", "--quiet", folder.file("run.lcm")});
  EXPECT_EQ(again.exit_code, 0) << again.output << again.errors;
  EXPECT_THAT(again.output, HasSubstr("equal for 240 steps"));
}

TEST(UbersimClient, SaysWhatIsWrongWithTheXml) {
  const ScratchFolder folder;
  const std::string segway = text_of_file(source("examples/ubersim_client/segway.xml"));
  const auto with = [&](const std::string& old_text, const std::string& new_text) {
    std::string changed = segway;
    changed.replace(changed.find(old_text), old_text.size(), new_text);
    return changed;
  };
  const std::pair<std::string, const char*> mistakes[] = {
      {"", "no XML: XML_ERROR_EMPTY_DOCUMENT"},
      {"<Client>", "no XML: XML_ERROR_"},
      {"<!DOCTYPE a [<!ENTITY b \"c\">]><Client/>", "the XML must have at most 1 MB and no <!DOCTYPE>"},
      {std::string(2'000'000, ' '), "the XML must have at most 1 MB"},
      {"<Client/>", "<Client> must have one <CSettings>, got 0"},
      {with("35.0", "heavy"), "<Box> 'Platform': <Mass> must be a number from 0 to 1000, got 'heavy'"},
      {with("35.0", "1e999"), "<Box> 'Platform': <Mass> must be a number from 0 to 1000, got '1e999'"},
      {with("name=\"Table\"", "name=\"A}, {b\""), "<Box> must have a name of 1 to 31 letters, digits and _"},
      {with("<Fov>60.0</Fov>", ""), "<CameraSensor> 'Cam' must have one <Fov>, got 0"},
      {with("<Inclinometer name=\"Incmeter\"></Inclinometer>", "<Gyroscope/>"),
       "<Body> 'MainBody' cannot have a <Gyroscope>, only: Box, Sphere, Cylinder, Inclinometer, CameraSensor"},
  };
  for (const auto& [text, error] : mistakes) {
    write_file(folder.file("wrong.xml"), text);
    Program program(client({}, folder.file("wrong.xml")));
    EXPECT_EQ(program.wait(), 1);
    const std::string errors = program.errors();
    EXPECT_THAT(errors, HasSubstr("wrong.xml: ")) << error;
    EXPECT_THAT(errors, HasSubstr(error));
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << error;
  }
}

TEST(UbersimClient, SaysWhyTheSimulatorRefusesARobot) {
  setenv("LCM_DEFAULT_URL", own_url().c_str(), 1);
  const ScratchFolder folder;
  write_file(folder.file("empty.yaml"), empty_world);
  std::string wrong = text_of_file(source("examples/ubersim_client/segway.xml"));
  const std::string body = "<Body2>LWheel</Body2>";
  wrong.replace(wrong.find(body), body.size(), "<Body2>Wing</Body2>");
  write_file(folder.file("wrong.xml"), wrong);
  Program shoal({built("shoal"), "run", folder.file("empty.yaml"), "--lcm-url", own_url(), "--speed", "max",
                 "--duration", "1", "--await", "cmu"});
  Program program(client({}, folder.file("wrong.xml")));
  EXPECT_EQ(program.wait(), 1);
  EXPECT_THAT(program.errors(), HasSubstr("ubersim_client: the simulator rejects 'cmu': spawn:1:"));
  EXPECT_THAT(program.errors(), HasSubstr("'Wing'"));
  EXPECT_EQ(shoal.wait(), 0) << shoal.errors();
}

}  // namespace
