// SPDX-License-Identifier: BSD-3-Clause
// Two Micro-Modems in one world, each with a host on its pseudo-terminal.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>

#include "bridges/serial/serial_port.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/nmea/nmea.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::Contains;
using testing::StartsWith;

/// The other end of a pseudo-terminal.
class Terminal {
 public:
  explicit Terminal(const std::string& path) : descriptor_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    EXPECT_GE(descriptor_, 0) << path;
  }
  ~Terminal() { ::close(descriptor_); }
  void type(const std::string& text) {
    EXPECT_EQ(::write(descriptor_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// Lines that came, without the checksums, which are right.
  std::vector<std::string> lines() {
    std::vector<std::string> all;
    char chunk[4096];
    for (ssize_t size = 0; (size = ::read(descriptor_, chunk, sizeof chunk)) > 0;)
      for (const auto& line : lines_.add(std::as_bytes(std::span(chunk, static_cast<std::size_t>(size))))) {
        sim::NmeaSentence sentence;
        EXPECT_EQ(sim::parse_nmea(line.text, sentence), sim::NmeaError::none) << line.text;
        all.push_back(line.text.substr(1, line.text.find('*') - 1));
      }
    return all;
  }

 private:
  int descriptor_;
  sim::NmeaLines lines_;
};

class MicromodemPty : public testing::Test {
 protected:
  explicit MicromodemPty(const std::string& keys = "") : keys_(keys) {}
  std::string yaml() const {
    std::string text =
        "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nmedium: {water: {sound_speed_mps: 1500}}\nvehicles:\n";
    for (int i = 1; i <= 2; ++i)
      text += "  - {name: m" + std::to_string(i) + ", position_m: [" + std::to_string(300 * i) +
              ", 0, -20], model: {shoal: 1, vehicle: ball" + std::to_string(i) +
              ", bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: sphere, radius_m: 0.1, mass_kg: "
              "1}]}], devices: [{name: modem, type: micromodem, address: " +
              std::to_string(i) + keys_ + ", serial: {path: \"" + folder.file("{vehicle}.modem") + "\"}}]}}\n";
    return text;
  }
  void run_for(double time_s) {
    for (int i = 0; i < static_cast<int>(time_s * 100 + 0.5); ++i) world.step();
  }

  std::string keys_;  // of both modems
  test_support::ScratchFolder folder;
  sim::LoadedWorld loaded = sim::load_world_text(yaml(), "worlds/test.yaml", {});
  sim::InProcessBus bus;
  sim::World world{loaded.config, bus,
                   [](sim::PortKind kind, const std::string& path) { return bridges::open_serial_port(kind, path); }};
  Terminal one{folder.file("m1.modem")}, two{folder.file("m2.modem")};
};

TEST_F(MicromodemPty, ASessionOfTwoHosts) {
  run_for(0.02);
  EXPECT_THAT(one.lines(), testing::ElementsAre(StartsWith("CAREV,")));
  two.lines();
  // As a driver starts.
  for (const char* line : {"$CCCFG,CST,1", "$CCCFG,SRC,1", "$CCCFG,REV,1", "$CCCFG,RXP,1", "$CCCFQ,SRC"}) {
    one.type(sim::nmea_sentence(line + 1) + "\r\n");
    two.type(std::string("$CCCFG,RXP,1\r\n"));
  }
  run_for(0.02);
  EXPECT_THAT(one.lines(),
              testing::ElementsAre("CACFG,CST,1", "CACFG,SRC,1", "CACFG,REV,1", "CACFG,RXP,1", "CACFG,SRC,1"));
  two.lines();

  one.type("$CCMPC,1,");
  run_for(0.02);
  one.type("2\r\n");  // the rest of the line
  run_for(3);
  EXPECT_THAT(one.lines(), Contains("CAMPR,2,1,0.2000"));  // 300 m
  EXPECT_THAT(two.lines(), Contains("CAMPA,1,2"));

  two.type("$CCCYC,0,2,1,0,0,1\n");
  run_for(0.02);
  EXPECT_THAT(two.lines(), testing::ElementsAre("CACYC,0,2,1,0,0,1", StartsWith("CADRQ,")));
  two.type("$CCTXD,2,1,0,68656c6c6f\n");
  run_for(6);
  const auto received = one.lines();
  EXPECT_THAT(received, Contains("CARXP,0"));
  EXPECT_THAT(received, Contains("CARXD,2,1,0,1,68656c6c6f"));
  EXPECT_EQ(
      std::count_if(received.begin(), received.end(), [](const auto& line) { return line.starts_with("CACST,0,"); }),
      2);
}

/// A command, what the modem says to it first, and how long it is busy then.
struct Step {
  std::string body, answer;
  double busy_s = 0;
};

/// Every command of docs/models/modems.md, in an order that works.
const std::vector<Step>& all_commands() {
  static const std::vector<Step> steps{
      {"CCCFG,SRC,1", "CACFG,SRC,1"},
      {"CCCFG,ALL,0", "CACFG,ALL,0"},
      {"CCCFG,SRC,1", "CACFG,SRC,1"},
      {"CCCFG,REV,0", "CACFG,REV,0"},
      {"CCCFQ,SRC", "CACFG,SRC,1"},
      {"CCCFQ,ALL", "CACFG,AGC,0"},
      {"CCCLK,2026,3,4,5,6,7", "CACLK,2026,3,4,5,6,7"},
      {"CCTMS,2026-03-04T05:06:07Z,0", "CATMS,0,2026-03-04T05:06:07Z"},
      {"CCTMQ,0", "CATMQ,2026-03-04T05:06:0"},
      {"CCMPC,1,2", "CAMPC,1,2", 8},
      {"CCMUC,1,2,1fab", "CAMUC,1,2,1fab", 2},
      {"CCPDT,1,1,0,0,500,1,1,0,0", "SNPDT,1,1,0,0,500,1,1,0,0", 1},
      {"CCPNT,26000,5,5,500,25000,0,0,0,1", "SNPNT,26000,5,5,500,25000,0,0,0,1", 1},
      {"CCPGT,26000,28,3E5A,500,25000,1f,0,0,0,2000,0", "SNPGT,26000,28,3E5A,500,25000,1f,0,0,0,2000,0", 1},
      {"CCCYC,0,1,2,0,0,1", "CACYC,0,1,2,0,0,1"},
      {"CCTXD,1,2,0,aabb", "CATXD,1,2,0,2", 8},
      {"CCMSC,1,1,0", "CAMSC,1,1,0", 2},
  };
  return steps;
}

/// Two modems whose software is of the second generation: they know all commands.
class MicromodemCommandsOnAPty : public MicromodemPty {
 protected:
  MicromodemCommandsOnAPty() : MicromodemPty(", revision: 2.0.16421") {
    run_for(0.02);
    one.lines();
  }
  /// What the modem says to this within two steps.
  std::vector<std::string> answers(const std::string& typed) {
    one.type(typed + "\r\n");
    run_for(0.02);
    return one.lines();
  }
};

TEST_F(MicromodemCommandsOnAPty, EveryCommandOfThePageIsAnsweredWithAndWithoutAChecksum) {
  std::set<std::string> tried;
  for (const bool with_checksum : {true, false})
    for (const Step& step : all_commands()) {
      tried.insert(step.body.substr(0, 5));
      const auto reported = answers(with_checksum ? sim::nmea_sentence(step.body) : "$" + step.body);
      ASSERT_FALSE(reported.empty()) << step.body;
      EXPECT_THAT(reported.front(), StartsWith(step.answer)) << step.body;
      run_for(step.busy_s);
      one.lines();
    }
  // The first column of the table of the page names no other one.
  std::ifstream page(test_support::source_path("docs/models/modems.md"));
  std::set<std::string> named;
  const std::regex command(R"(\$(CC[A-Z]{3}))");
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| `$CC")) continue;
    const std::string host = line.substr(0, line.find('|', 1));
    for (std::sregex_iterator at(host.begin(), host.end(), command), end; at != end; ++at) named.insert((*at)[1]);
  }
  EXPECT_EQ(tried, named);
}

TEST_F(MicromodemCommandsOnAPty, WhatIsWrongWithALineIsSaidForEveryCommand) {
  const std::string time = "CAERR,0000";  // of the first minute
  for (const Step& step : all_commands()) {
    const std::string good = sim::nmea_sentence(step.body), name = step.body.substr(0, 5);
    EXPECT_THAT(answers(good.substr(0, good.size() - 2) + (good.ends_with("00") ? "01" : "00")),
                testing::ElementsAre(testing::AllOf(StartsWith(time), testing::EndsWith(",NMEA,2,bad checksum"))));
    EXPECT_THAT(answers("$" + step.body + std::string(700, '0')),
                testing::ElementsAre(testing::EndsWith(",NMEA,1,line too long")));
    // Cut off behind its name, or in it.
    EXPECT_THAT(answers("$" + name), testing::ElementsAre(testing::ContainsRegex("^CAERR,[0-9]{6},[A-Z]+,3,"))) << name;
    EXPECT_THAT(answers("$" + step.body.substr(0, 4)),
                testing::ElementsAre(testing::EndsWith(",NMEA,1,unknown sentence " + step.body.substr(0, 4))));
    // Characters that cannot be printed.
    EXPECT_THAT(answers("$" + name + ",\x01\xff"), testing::ElementsAre());
    EXPECT_THAT(answers("\x80\xff\x01noise"), testing::ElementsAre());
  }
  EXPECT_THAT(answers("\x80\xffnoise$CCCFQ,SRC"), testing::ElementsAre("CACFG,SRC,1"));  // before the $
}

TEST_F(MicromodemCommandsOnAPty, WhatThePageCallsUnknownIs) {
  for (const char* name : {"CCTXA", "CCCLQ", "CCMEC", "CCEXL", "CCRSP", "CCSWP", "CCMSQ", "CCCFR", "CCTDP", "CCHIB"})
    EXPECT_THAT(answers(std::string("$") + name + ",1,2"),
                testing::ElementsAre(testing::EndsWith(std::string(",NMEA,1,unknown sentence ") + name)));
}

TEST_F(MicromodemPty, NoiseAndAReaderThatNeverReadsDoNoHarm) {
  // Far more than a pseudo-terminal and the port hold: each of these lines is answered by 46.
  for (int i = 0; i < 400; ++i) {
    one.type("$CCCFQ,ALL\r\n");
    one.type(std::string("\x00\xff\x80$$*\x01", 8) + std::string(100, static_cast<char>(i)));
    one.type("\r\n");
    run_for(0.02);
  }
  EXPECT_GT(world.counts().bad_messages, 0);  // the world was notified that bytes were dropped
  one.lines();
  run_for(0.02);
  while (!one.lines().empty()) run_for(0.02);
  one.type("$CCCFQ,SRC\r\n");
  run_for(0.05);
  EXPECT_THAT(one.lines(), Contains("CACFG,SRC,1"));
}

}  // namespace
