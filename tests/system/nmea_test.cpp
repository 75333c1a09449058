// SPDX-License-Identifier: BSD-3-Clause
#include "sim/nmea/nmea.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/bridges/nmea/nmea_peer.hpp"
#include "tests/system/shoal_program.hpp"

// shoal-nmea beside a run, with clients: plain ones, and gpsd of Debian, which decodes what it gets independently.

namespace {

using namespace system_test;
using test_support::own_port;
using testing::HasSubstr;

const std::string world = source("examples/nmea/traffic.yaml");

/// A run of the world, which lasts until its end or that of the test, at ten times real time.
std::vector<std::string> run_command(const std::vector<std::string>& more = {}) {
  std::vector<std::string> words{built("shoal"), "run", world,       "--duration", "forever",
                                 "--speed",      "10",  "--lcm-url", own_url()};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<std::string> door(const std::vector<std::string>& more) {
  std::vector<std::string> words{built("shoal-nmea"), "--lcm-url", own_url()};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::string address(int offset = 0) {
  return "127.0.0.1:" + std::to_string(own_port(offset));
}

bool await_listening(const Program& program) {
  return await([&] { return program.errors().find("listens at port") != std::string::npos; });
}

/// Fields of the next line of this type.
sim::NmeaSentence next(nmea_test::Peer& peer, const std::string& name) {
  const auto line = peer.line_with(name);
  if (!line) throw std::runtime_error("the connection ended before " + name);
  sim::NmeaSentence sentence;
  EXPECT_EQ(sim::parse_nmea(*line, sentence, (*line)[0]), sim::NmeaError::none) << *line;
  return sentence;
}

TEST(NmeaDoor, SendsTheInstrumentsOfAVehicleToSeveralClients) {
  Program run(run_command());
  Program nmea(door({"--vehicle", "boat", "--listen", address(1)}));
  ASSERT_TRUE(await_listening(nmea)) << nmea.errors();
  nmea_test::Peer one(static_cast<std::uint16_t>(own_port(1))), two(static_cast<std::uint16_t>(own_port(1)));
  for (nmea_test::Peer* peer : {&one, &two}) {
    const auto rmc = next(*peer, "GPRMC,");
    EXPECT_EQ(rmc.at(4), "N");
    EXPECT_EQ(rmc.at(9), "010126");
    EXPECT_EQ(next(*peer, "HEHDT").at(2), "T");
    EXPECT_NEAR(std::strtod(next(*peer, "SDDBT").at(3).c_str(), nullptr), 11.9, 0.5);  // of 12 m
    EXPECT_EQ(next(*peer, "WIMWV").at(5), "A");
    EXPECT_EQ(next(*peer, "AIVDO").at(1), "1");
    EXPECT_FALSE(next(*peer, "AIVDM").at(5).empty());
  }
  nmea.send_signal(SIGTERM);
  EXPECT_EQ(nmea.wait(), 143);
}

TEST(NmeaDoor, ApbSteersTheVehicleOnlyIfItMay) {
  Program run(run_command());
  Program nmea(door({"--vehicle", "boat", "--listen", address(1), "--steer", "--period-s", "0.5"}));
  ASSERT_TRUE(await_listening(nmea)) << nmea.errors();
  nmea_test::Peer peer(static_cast<std::uint16_t>(own_port(1)));
  next(peer, "HEHDT");
  // It goes north (yaw 90 degrees); the plotter wants it to go south-west.
  ASSERT_TRUE(peer.send(sim::nmea_sentence("GPAPB,A,A,0.1,L,N,V,V,225,T,1,225,T,225,T") + "\r\n"));
  double heading_deg = 0;
  for (int i = 0; i < 2000 && std::abs(heading_deg - 225) > 5; ++i)
    heading_deg = std::strtod(next(peer, "HEHDT").at(1).c_str(), nullptr);
  EXPECT_NEAR(heading_deg, 225, 5);
  // A second door, which may not steer, says so once.
  Program closed(door({"--vehicle", "ferry", "--name", "closed", "--listen", address(2)}));
  ASSERT_TRUE(await_listening(closed)) << closed.errors();
  nmea_test::Peer other(static_cast<std::uint16_t>(own_port(2)));
  ASSERT_TRUE(other.send("$GPAPB,A,A,,,,,,,,,,,225,T\r\n$GPAPB,A,A,,,,,,,,,,,225,T\r\n"));
  EXPECT_TRUE(await([&] { return closed.errors().find("are ignored without --steer") != std::string::npos; }));
}

TEST(NmeaDoor, GpsdDecodesPositionsAndAis) {
  if (std::system("gpsd -V >/dev/null 2>&1") != 0 || std::system("gpspipe -V >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "gpsd and gpspipe are not installed";
  // In lockstep from the start, as names are sent soon after it, and then every 6 minutes.
  Program nmea(door({"--vehicle", "boat", "--lockstep", "--listen", address(1)}));
  ASSERT_TRUE(await_listening(nmea)) << nmea.errors();
  Program gpsd({"gpsd", "-N", "-n", "-S", std::to_string(own_port(3)), "tcp://" + address(1)});
  Program gpspipe({"bash", "-c", "until gpspipe -w " + address(3) + "; do sleep 0.1; done"});
  Program run(run_command({"--await", "nmea"}));
  // What it has decoded, by class; AIS by MMSI and type.
  nlohmann::json position, sky;
  std::map<std::pair<int, int>, nlohmann::json> ais;
  const auto look = [&] {
    std::istringstream lines(gpspipe.output());
    for (std::string line; std::getline(lines, line);) {
      const auto object = nlohmann::json::parse(line, nullptr, false);
      if (!object.is_object() || !object.contains("class")) continue;
      if (object["class"] == "TPV" && object.value("mode", 0) >= 2) position = object;
      if (object["class"] == "AIS") ais[{object.value("mmsi", 0), object.value("type", 0)}] = object;
    }
    return !position.is_null() && ais.contains({211'000'002, 1}) && ais.contains({211'000'002, 5}) &&
           ais.contains({211'000'003, 18}) && ais.contains({211'000'003, 24}) && ais.contains({211'000'001, 18});
  };
  EXPECT_TRUE(await(look, timeout)) << nmea.errors() << gpsd.errors() << gpspipe.output();
  ASSERT_FALSE(position.is_null());
  EXPECT_NEAR(position.value("lat", 0.0), 42.3584, 0.01);
  EXPECT_NEAR(position.value("lon", 0.0), -71.0876, 0.01);
  EXPECT_THAT(position.value("time", ""), HasSubstr("2026-01-01T"));
  // As sent: in 1/600000 of a degree and tenths of a knot.
  EXPECT_NEAR((ais[{211'000'002, 1}].value("lat", 0)) / 600'000.0, 42.3584, 0.02);
  EXPECT_NEAR((ais[{211'000'002, 1}].value("speed", 0)), 12 * 3600 / 1852.0, 8);
  EXPECT_EQ((ais[{211'000'002, 5}].value("shipname", "")), "FERRY");
  EXPECT_EQ((ais[{211'000'003, 24}].value("shipname", "")), "PILOT");
}

TEST(NmeaDoor, TheTruthIsSentOnRequestOnly) {
  // Vehicles without AIS are targets.
  Program run({built("shoal"), "run", source("worlds/harbour.yaml"), "--duration", "forever", "--speed", "20",
               "--lcm-url", own_url()});
  Program nmea(door({"--vehicle", "boat", "--truth", "--listen", address(1)}));
  ASSERT_TRUE(await_listening(nmea)) << nmea.errors();
  nmea_test::Peer peer(static_cast<std::uint16_t>(own_port(1)));
  auto rmc = next(peer, "GPRMC,");
  while (rmc.at(2) != "A") rmc = next(peer, "GPRMC,");  // once the origin of the world is known
  EXPECT_EQ(next(peer, "AIVDM").at(1).size(), 1u);
}

TEST(NmeaDoor, InLockstepItDoesNotChangeTheRun) {
  const std::vector<std::string> arguments{"run", world,    "--duration", "20",        "--speed",
                                           "max", "--seed", "5",          "--lcm-url", own_url()};
  const Ended alone = run_shoal(arguments);
  ASSERT_EQ(alone.exit_code, 0) << alone.errors;
  std::vector<std::string> with_door = arguments;
  with_door.insert(with_door.end(), {"--await", "nmea"});
  with_door.insert(with_door.begin(), built("shoal"));
  Program run(with_door);
  Program nmea(door({"--vehicle", "boat", "--lockstep", "--listen", address(1)}));
  EXPECT_EQ(run.wait(), 0) << run.errors();
  EXPECT_EQ(nmea.wait(), 0) << nmea.errors();
  EXPECT_EQ(run_hash_in({0, run.output(), run.errors()}), run_hash_in(alone));
}

TEST(NmeaDoor, MistakesAreReportedInOneLine) {
  struct Mistake {
    std::vector<std::string> arguments;
    const char* says;
  };
  for (const Mistake& mistake : {Mistake{{}, "--vehicle is required"},
                                 Mistake{{"--vehicle", "boat", "--listen", "10110"}, "an address must be HOST:PORT"},
                                 Mistake{{"--vehicle", "boat", "--listen", "none"}, "--listen none needs --udp"},
                                 Mistake{{"--vehicle", "boat", "--variation-deg", "200"}, "--variation-deg"}}) {
    Program program(door(mistake.arguments));
    EXPECT_EQ(program.wait(), 2) << mistake.says;
    EXPECT_THAT(program.errors(), HasSubstr(mistake.says));
  }
  Program run(run_command());
  Program unknown(door({"--vehicle", "nobody", "--listen", address(1)}));
  EXPECT_EQ(unknown.wait(), 2);
  EXPECT_THAT(unknown.errors(), HasSubstr("there is no vehicle 'nobody'"));
}

}  // namespace
