// Two Micro-Modems in one world, each with a host on its pseudo-terminal.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>

#include "bridges/serial/serial_port.hpp"
#include "devices/nmea.hpp"
#include "shoal/message_writer.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/world/load_world.hpp"
#include "sim/world/world.hpp"
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
        devices::NmeaSentence sentence;
        EXPECT_EQ(devices::parse_nmea(line.text, sentence), devices::NmeaError::none) << line.text;
        all.push_back(line.text.substr(1, line.text.find('*') - 1));
      }
    return all;
  }

 private:
  int descriptor_;
  devices::NmeaLines lines_;
};

class MicromodemPty : public testing::Test {
 protected:
  std::string yaml() const {
    std::string text =
        "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nmedium: {water: {sound_speed_mps: 1500}}\nvehicles:\n";
    for (int i = 1; i <= 2; ++i)
      text += "  - {name: m" + std::to_string(i) + ", position_m: [" + std::to_string(300 * i) +
              ", 0, -20], model: {shoal: 1, vehicle: ball" + std::to_string(i) +
              ", bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: sphere, radius_m: 0.1, mass_kg: "
              "1}]}], devices: [{name: modem, type: micromodem, address: " +
              std::to_string(i) + ", serial: {path: \"" + folder.file("{vehicle}.modem") + "\"}}]}}\n";
    return text;
  }
  void run_for(double time_s) {
    for (int i = 0; i < static_cast<int>(time_s * 100 + 0.5); ++i) world.step();
  }

  test_support::ScratchFolder folder;
  sim::LoadedWorld loaded = sim::load_world_text(yaml(), "worlds/test.yaml", {});
  sim::InProcessBus bus;
  sim::World world{loaded.config, bus, bridges::open_serial_port};
  Terminal one{folder.file("m1.modem")}, two{folder.file("m2.modem")};
};

TEST_F(MicromodemPty, ASessionOfTwoHosts) {
  run_for(0.02);
  EXPECT_THAT(one.lines(), testing::ElementsAre(StartsWith("CAREV,")));
  two.lines();
  // As a driver starts.
  for (const char* line : {"$CCCFG,CST,1", "$CCCFG,SRC,1", "$CCCFG,REV,1", "$CCCFG,RXP,1", "$CCCFQ,SRC"}) {
    one.type(devices::nmea_sentence(line + 1) + "\r\n");
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
  const auto heard = one.lines();
  EXPECT_THAT(heard, Contains("CARXP,0"));
  EXPECT_THAT(heard, Contains("CARXD,2,1,0,1,68656c6c6f"));
  EXPECT_EQ(std::count_if(heard.begin(), heard.end(), [](const auto& line) { return line.starts_with("CACST,0,"); }),
            2);
}

TEST_F(MicromodemPty, NoiseAndAReaderThatNeverReadsDoNoHarm) {
  // Far more than a pseudo-terminal and the port hold: each of these lines is answered by 46.
  for (int i = 0; i < 400; ++i) {
    one.type("$CCCFQ,ALL\r\n");
    one.type(std::string("\x00\xff\x80$$*\x01", 8) + std::string(100, static_cast<char>(i)));
    one.type("\r\n");
    run_for(0.02);
  }
  EXPECT_GT(world.counts().bad_messages, 0);  // the world was told that bytes were dropped
  one.lines();
  run_for(0.02);
  while (!one.lines().empty()) run_for(0.02);
  one.type("$CCCFQ,SRC\r\n");
  run_for(0.05);
  EXPECT_THAT(one.lines(), Contains("CACFG,SRC,1"));
}

}  // namespace
