// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem.hpp"

#include <gmock/gmock.h>

#include "shoal/nmea_sentence_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/comma_locale.hpp"
#include "tests/devices/comms/modem_fixture.hpp"
#include "tests/devices/comms/sentence_field.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string modem_at(int address, const std::string& keys = "") {
  return "{name: modem, type: micromodem, address: " + std::to_string(address) + keys + "}";
}

/// Modem 1 of vehicle a, 2 of b at 750 m, 3 of c at 300 m to the other side.
std::string three_micromodems(const std::string& keys = "", const std::string& more = "") {
  return test::modem_sea({{"a", "[0, 0, -20]", modem_at(1, keys)},
                          {"b", "[750, 0, -20]", modem_at(2, keys)},
                          {"c", "[-300, 0, -20]", modem_at(3, keys)}},
                         more);
}

/// A host at each modem, by the bus.
class Hosts : public test::TestWorld {
 public:
  explicit Hosts(const std::string& yaml) : TestWorld(yaml) {}

  void emit(const std::string& vehicle, const std::string& sentence) {
    shoal::nmea_sentence_t message{};
    message.sentence = sentence;
    send(vehicle + ".modem.cmd", message);
  }
  /// Sentences without their checksums since the last call.
  std::vector<std::string> take(const std::string& vehicle) {
    std::vector<std::string> all;
    for (const auto& message : (vehicle == "a" ? a : vehicle == "b" ? b : c).take_all()) {
      sim::NmeaSentence parsed;
      EXPECT_EQ(sim::parse_nmea(message.sentence, parsed), sim::NmeaError::none) << message.sentence;
      all.push_back(message.sentence.substr(1, message.sentence.find('*') - 1));
    }
    return all;
  }

  test::Listener<shoal::nmea_sentence_t> a{*this, "a.modem"}, b{*this, "b.modem"}, c{*this, "c.modem"};
};

/// The sentences with these names.
std::vector<std::string> only(const std::vector<std::string>& reported, const std::string& names) {
  std::vector<std::string> some;
  for (const auto& line : reported)
    if (names.find(line.substr(0, 5)) != std::string::npos) some.push_back(line);
  return some;
}

using test::field;

TEST(Micromodem, CarriesDataOfRateZeroAsTheRealOneSays) {
  Hosts hosts(three_micromodems());
  hosts.run_for(0.05);
  hosts.take("a"), hosts.take("b");
  hosts.emit("a", "$CCCYC,0,1,2,0,1,1");
  hosts.run_for(0.05);
  hosts.emit("a", "$CCTXD,1,2,1,0102ff");
  hosts.run_for(8);
  const auto a = hosts.take("a"), b = hosts.take("b"), c = hosts.take("c");
  // Asked, sent in two packets, acknowledged.
  std::vector<std::string> order;
  for (const auto& line : a) order.push_back(line.substr(0, 5));
  EXPECT_THAT(order, testing::ElementsAre("CACYC", "CADRQ", "CATXD", "CATXP", "CATXF", "CAXST", "CATXP", "CATXF",
                                          "CAXST", "CAACK", "CACST"));
  EXPECT_THAT(a, Contains("CAACK,2,1,1,1"));
  order.clear();
  for (const auto& line : only(b, "CACYC CACST CARXP CARXD")) order.push_back(line.substr(0, 5));
  EXPECT_THAT(order, testing::ElementsAre("CACYC", "CACST", "CARXD", "CACST"));
  EXPECT_THAT(b, Contains("CACYC,0,1,2,0,1,1"));
  EXPECT_THAT(b, Contains("CARXD,1,2,1,1,0102ff"));
  // Another one receives it as well, and does not acknowledge.
  EXPECT_THAT(c, Contains("CARXD,1,2,1,1,0102ff"));
  EXPECT_THAT(c, Not(Contains(StartsWith("CATXP"))));
}

TEST(Micromodem, EveryRateCarriesItsFrames) {
  for (const auto& rate : devices::micromodem_rates()) {
    Hosts hosts(three_micromodems());
    hosts.run_for(0.05);
    hosts.emit("a", "$CCCYC,0,1,2," + std::to_string(rate.number) + ",0," + std::to_string(rate.frames));
    const std::string hex(static_cast<std::size_t>(2 * rate.frame_bytes), 'a');
    for (int i = 0; i < rate.frames; ++i) hosts.emit("a", "$CCTXD,1,2,0," + hex);
    hosts.run_for(8);
    const auto b = hosts.take("b");
    const auto data = only(b, "CARXD");
    ASSERT_EQ(data.size(), static_cast<std::size_t>(rate.frames)) << rate.number;
    for (int i = 0; i < rate.frames; ++i)
      EXPECT_EQ(data[static_cast<std::size_t>(i)], "CARXD,1,2,0," + std::to_string(i + 1) + "," + hex);
    EXPECT_EQ(only(b, "CACST").size(), rate.number == 0 ? 2u : 1u);
  }
}

TEST(Micromodem, APingMeasuresTheTravelTime) {
  Hosts hosts(three_micromodems());
  hosts.run_for(0.05);
  hosts.take("a");
  hosts.emit("a", "$CCMPC,1,2");
  hosts.run_for(4);
  EXPECT_THAT(hosts.take("a"), Contains("CAMPR,2,1,0.5000"));  // 750 m at 1500 m/s
  EXPECT_THAT(hosts.take("b"), Contains("CAMPA,1,2"));
  // One that does not exist does not answer, and the modem says so in the end.
  hosts.emit("a", "$CCMPC,1,77");
  hosts.run_for(9);
  EXPECT_THAT(hosts.take("a"), Contains("CAMPR,77,1"));
}

TEST(Micromodem, ItsSentencesHaveAPointInTheirNumbersInEveryLocaleOfTheProgram) {
  const test_support::CommaLocale comma;
  Hosts hosts(three_micromodems());
  hosts.emit("b", "$CCCFG,CST,1");
  hosts.run_for(0.05);
  hosts.emit("a", "$CCMPC,1,2");
  hosts.run_for(4);
  EXPECT_THAT(hosts.take("a"), Contains("CAMPR,2,1,0.5000"));  // 750 m at 1500 m/s
  const auto statistics = only(hosts.take("b"), "CACST");
  ASSERT_FALSE(statistics.empty());
  EXPECT_THAT(statistics[0], HasSubstr(",0.0,"));  // the Doppler of modems at rest
}

TEST(Micromodem, APingOfAMovingOneMeasuresTheMeanOfBothWays) {
  Hosts hosts(three_micromodems());
  // b goes away at 1.5 m/s.
  const sim::Vector3d v_W(1.5, 0, 0);
  for (const auto& [name, body] : hosts.world.find_vehicle("b")->bodies())
    body->set_velocity_W(v_W, sim::Vector3d::Zero());
  hosts.run_for(1);
  hosts.emit("a", "$CCMPC,1,2");
  hosts.run_for(4);
  // Sent at 1 s, when b is at 751.5 m: the ping takes t = 751.5 / (1500 - 1.5); the reply starts 1 s later and comes
  // from 751.5 + 1.5 (t + 1) m.
  const double there_s = 751.5 / 1498.5, back_s = (751.5 + 1.5 * (there_s + 1)) / 1500;
  const auto replies = only(hosts.take("a"), "CAMPR");
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_NEAR(std::stod(field(replies[0], 3)), (there_s + back_s) / 2, 0.51e-4);  // four digits
}

TEST(Micromodem, ASynchronousPacketReportsItsOneWayTravelTime) {
  Hosts hosts(three_micromodems(", synchronous: true"));
  hosts.run_for(0.35);
  hosts.take("b");
  hosts.emit("a", "$CCMUC,1,2,1fab");
  hosts.run_for(3);
  const auto b = hosts.take("b");
  EXPECT_THAT(b, Contains("CAMUA,1,2,1fab"));
  const auto statistics = only(b, "CACST");
  ASSERT_EQ(statistics.size(), 1u);
  EXPECT_EQ(field(statistics[0], 3), "3");  // keeps the second, and knows which
  const std::string arrival = field(statistics[0], 2);
  EXPECT_EQ(arrival.substr(6), ".5000");  // sent at a whole second: 750 m / 1500 m/s
  const auto sent = only(hosts.take("a"), "CAXST");
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(field(sent[0], 2).substr(6), ".0000");
  EXPECT_EQ(field(sent[0], 2).substr(0, 6), arrival.substr(0, 6));
}

TEST(Micromodem, SynchronousPingsBeginAtAWholeSecondAndMeasureTheSame) {
  Hosts hosts(three_micromodems(", synchronous: true"));
  hosts.run_for(0.35);
  hosts.take("a");
  hosts.emit("a", "$CCMPC,1,2");
  hosts.run_for(5);
  const auto a = hosts.take("a");
  EXPECT_THAT(a, Contains("CAMPR,2,1,0.5000"));  // 750 m at 1500 m/s
  const auto sent = only(a, "CAXST"), b = hosts.take("b"), ping = only(b, "CACST");
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(field(sent[0], 2), "000001.0000");
  ASSERT_EQ(ping.size(), 1u);
  EXPECT_EQ(field(ping[0], 2), "000001.5000");  // the one-way travel time
  const auto reply = only(b, "CAXST");
  ASSERT_EQ(reply.size(), 1u);
  EXPECT_EQ(field(reply[0], 2), "000002.5000");  // its turnaround, not the second
}

TEST(Micromodem, TimesOfArrivalAreByItsOwnClock) {
  const std::string keys = ", synchronous: true";
  Hosts hosts(test::modem_sea({{"a", "[0, 0, -20]", modem_at(1, keys)},
                               {"b", "[750, 0, -20]", modem_at(2, keys), "clock: {offset_s: 0.125}"},
                               {"c", "[-300, 0, -20]", modem_at(3, keys), "clock: {offset_s: -2}"}}));
  hosts.run_for(0.35);
  hosts.emit("a", "$CCMUC,1,2,1fab");
  hosts.run_for(3);
  const auto b = only(hosts.take("b"), "CACST"), c = only(hosts.take("c"), "CACST");
  ASSERT_EQ(b.size(), 1u);
  ASSERT_EQ(c.size(), 1u);
  EXPECT_EQ(field(b[0], 2).substr(6), ".6250");  // 0.5 s of way, and the clock
  EXPECT_EQ(field(c[0], 2).substr(6), ".2000");  // whole seconds do not show
  // A two-way ping does not care.
  hosts.emit("a", "$CCMPC,1,2");
  hosts.run_for(4);
  EXPECT_THAT(hosts.take("a"), Contains("CAMPR,2,1,0.5000"));
}

TEST(Micromodem, RequestsTransponders) {
  const std::string beacon = "{name: beacon, type: transponder}";
  Hosts hosts(test::modem_sea({{"a", "[0, 0, -20]", modem_at(1, ", lbl: {transponders: [b, c/beacon, d]}")},
                               {"b", "[750, 0, -20]", modem_at(2) + ", " + beacon},
                               {"c", "[-300, 0, -20]", modem_at(3) + ", " + beacon},
                               {"d", "[0, 300, -20]", "{name: beacon, type: transponder, network: other}"}}));
  hosts.run_for(0.05);
  hosts.take("a");
  hosts.emit("a", "$CCPDT,1,1,0,0,3000,1,1,1,0");
  hosts.run_for(4);
  // 750 m and 300 m at 1500 m/s; the third does not answer, the fourth was not asked for.
  EXPECT_THAT(hosts.take("a"), testing::ElementsAre("SNPDT,1,1,0,0,3000,1,1,1,0", "SNTTA,0.5000,0.2000,,,000000.05"));
  hosts.emit("a", "$CCPNT,26000,5,5,3000,0,29000,0,0,0");  // by the pulse, and the second one only
  hosts.run_for(5);
  EXPECT_THAT(hosts.take("a"), Contains("SNTTA,,0.2000,,,000005.00"));
  hosts.emit("a", "$CCPNT,26000,5,5,3000,25000,29000,0,0,1");  // at once
  hosts.run_for(4);
  EXPECT_THAT(hosts.take("a"), Contains("SNTTA,0.5000,0.2000,,,000009.05"));
  hosts.emit("a", "$CCPGT,26000,28,3E5A,3000,27000,0,1f,0,0,2000,0");
  hosts.run_for(4);
  EXPECT_THAT(hosts.take("a"),
              testing::ElementsAre("SNPGT,26000,28,3E5A,3000,27000,0,1f,0,0,2000,0", "SNTTA,,0.2000,,,000013.05"));
  hosts.emit("a", "$CCPDT,1,1,0,0,0,1,1,1,0");
  hosts.run_for(0.1);
  EXPECT_THAT(hosts.take("a"), Contains(HasSubstr("NMEA,3,PDT has a field out of range")));
}

TEST(Micromodem, AThirdModemMayAskForTheCycle) {
  Hosts hosts(three_micromodems());
  hosts.run_for(0.05);
  hosts.take("a"), hosts.take("b");
  hosts.emit("c", "$CCCYC,0,1,2,2,0,1");  // 3 asks 1 to send to 2
  hosts.run_for(1);
  EXPECT_THAT(only(hosts.take("a"), "CADRQ"), testing::ElementsAre(StartsWith("CADRQ,")));
  hosts.emit("a", "$CCTXD,1,2,0,77");
  hosts.run_for(5);
  EXPECT_THAT(hosts.take("b"), Contains("CARXD,1,2,0,1,77"));
}

TEST(Micromodem, WithoutTheCoprocessorItReceivesRateZeroOnly) {
  Hosts hosts(test::modem_sea({{"a", "[0, 0, -20]", modem_at(1)},
                               {"b", "[750, 0, -20]", modem_at(2, ", psk: false")},
                               {"c", "[-300, 0, -20]", modem_at(3)}}));
  hosts.run_for(0.05);
  hosts.emit("a", "$CCCYC,0,1,2,1,0,1");
  hosts.emit("a", "$CCTXD,1,2,0,77");
  hosts.run_for(6);
  EXPECT_THAT(hosts.take("b"), Not(Contains(StartsWith("CARXD"))));
  EXPECT_THAT(hosts.take("c"), Contains("CARXD,1,2,0,1,77"));
  hosts.emit("b", "$CCCYC,0,2,1,1,0,1");
  hosts.run_for(0.1);
  EXPECT_THAT(hosts.take("b"), Contains(HasSubstr("CYC,3,rate must be 0 to 0")));
}

TEST(Micromodem, RefusesBadSentencesAndContinues) {
  Hosts hosts(three_micromodems());
  for (const char* bad : {"", "$", "noise", "$CCCYC", "$CCTXD,,,,", "$CCMPC,1,2*00", "$CCCYC,0,1,2,9,0,1"})
    hosts.emit("a", bad);
  hosts.run_for(0.1);
  EXPECT_EQ(only(hosts.take("a"), "CAERR").size(), 4u);
  hosts.emit("a", "$CCMUC,1,127,0001");
  hosts.run_for(3);
  EXPECT_THAT(hosts.take("b"), Contains("CAMUA,1,127,0001"));
  EXPECT_THAT(hosts.take("c"), Contains("CAMUA,1,127,0001"));
}

TEST(Micromodem, ItsTranspondersMustExist) {
  const auto error = [](const std::string& names) {
    return test::error_of_world(
        test::modem_sea({{"a", "[0, 0, -20]", modem_at(1, ", lbl: {transponders: [" + names + "]}")},
                         {"b", "[750, 0, -20]", modem_at(2) + ", {name: beacon, type: transponder}"}}));
  };
  EXPECT_EQ(error("b, b/beacon"), "");
  for (const std::string name : {"c", "a", "b/modem", "b/none"})
    EXPECT_NE(error(name).find("'transponders' names no transponder of the world '" + name + "'"), std::string::npos);
}

TEST(Micromodem, SaysNothingOfAPacketThatItDidNotNotice) {
  // A din beside b hides the packet, which would be loud enough in a quiet sea.
  const std::string din =
      "{name: din, type: noise_source, kind: pulses, level_dB: 190, frequency_Hz: 25000, bandwidth_Hz: 4000, "
      "period_s: 100, sound_s: 20}";
  Hosts hosts(test::modem_sea(
      {{"a", "[0, 0, -20]", modem_at(1)}, {"b", "[750, 0, -20]", modem_at(2)}, {"c", "[760, 0, -20]", din}}));
  hosts.run_for(1);
  hosts.take("b");
  hosts.emit("a", "$CCMUC,1,2,1fab");
  hosts.run_for(5);
  hosts.emit("a", "$CCCYC,0,1,2,1,0,1");
  hosts.emit("a", "$CCTXD,1,2,0,77");
  hosts.run_for(6);
  EXPECT_THAT(hosts.take("b"), testing::ElementsAre(StartsWith("CAREV")));
  const auto& lost = test::device_of<devices::Micromodem>(hosts, "b/modem").transducer().counts().lost;
  EXPECT_EQ(lost[static_cast<std::size_t>(sim::SignalLoss::interference)], 2);
}

TEST(Micromodem, StartsAnewWhenItsPowerComesBack) {
  Hosts hosts(three_micromodems());
  hosts.run_for(0.05);
  hosts.emit("a", "$CCMUC,1,2,1fab");
  hosts.emit("b", "$CCCYC,0,2,1,0,0,1");
  hosts.run_for(0.1);
  hosts.take("a"), hosts.take("b");
  for (const char* name : {"a/modem", "b/modem"})
    hosts.world.editor().set_fault(name, {.kind = sim::FaultKind::silent});
  hosts.run_for(3);
  for (const char* name : {"a/modem", "b/modem"}) hosts.world.editor().clear_faults(name);
  hosts.run_for(3);
  for (const char* name : {"a", "b"})
    EXPECT_THAT(hosts.take(name), testing::ElementsAre("CAREV,000003,INIT,0.93.0.48")) << name;
}

TEST(Micromodem, AFreshStartTakesBackWhatItHasNotBegun) {
  Hosts hosts(three_micromodems());
  hosts.run_for(0.05);
  for (const char* line : {"$CCCYC,0,1,2,0,0,1", "$CCTXD,1,2,0,abcd", "$CCMSC,1,1,0"}) {
    hosts.emit("a", line);
    hosts.run_for(0.1);  // the cycle init sounds, the data has not begun
  }
  hosts.take("b");
  hosts.run_for(8);
  const auto reported = hosts.take("b");
  EXPECT_THAT(reported, Contains("CACYC,0,1,2,0,0,1"));
  EXPECT_THAT(only(reported, "CARXD"), testing::IsEmpty());
  const auto& modem = test::device_of<devices::Micromodem>(hosts, "a/modem");
  EXPECT_EQ(modem.transducer().counts().sent, 1);
}

TEST(Micromodem, APingKnowsNothingOfAClockThatIsSet) {
  // GPS finds the clock of a 0.4 s ahead while the ping is under way, and sets it right.
  const std::string gps = ", {name: gps, type: gps, position_m: [0, 0, 0.6], disciplines_clock: true}";
  Hosts hosts(test::modem_sea({{"a", "[0, 0, -0.3]", modem_at(1) + gps, "clock: {offset_s: 0.4}"},
                               {"b", "[750, 0, -5]", modem_at(2)},
                               {"c", "[-300, 0, -5]", modem_at(3)}}));
  hosts.world.editor().set_fault("a/gps", {.kind = sim::FaultKind::silent});
  hosts.run_for(9.5);
  hosts.emit("a", "$CCMPC,1,2");
  hosts.run_for(0.4);
  hosts.world.editor().clear_faults("a/gps");
  hosts.run_for(4);
  EXPECT_LT(std::abs(hosts.world.find_vehicle("a")->clock().error_s(hosts.world.now())), 1e-3);
  EXPECT_THAT(hosts.take("a"), Contains("CAMPR,2,1,0.5000"));
}

TEST(Micromodem, CountsPacketsForItsAddressAndForEverybody) {
  Hosts hosts(three_micromodems());
  hosts.run_for(0.05);
  const auto understood = [&](const std::string& vehicle) {
    return test::device_of<devices::Micromodem>(hosts, vehicle + "/modem").transducer().counts().understood;
  };
  for (const char* line : {"$CCMUC,1,2,0001", "$CCMUC,1,127,0002", "$CCMUC,1,5,0003"}) {
    hosts.emit("a", line);
    hosts.run_for(4);
  }
  EXPECT_EQ(understood("b"), 2);
  EXPECT_EQ(understood("c"), 1);
  hosts.emit("c", "$CCCFG,SRC,5");
  hosts.emit("a", "$CCMUC,1,5,0004");
  hosts.run_for(4);
  EXPECT_EQ(understood("c"), 2);
}

TEST(Micromodem, NeedsWater) {
  const std::string error = test::error_of_world(test::modem_sea({{"a", "[0, 0, 0]", modem_at(1)}}, "", "{}"));
  EXPECT_NE(error.find("a device of type 'micromodem' needs water"), std::string::npos) << error;
  EXPECT_NE(test::error_of_world(test::modem_sea({{"a", "[0, 0, -2]", modem_at(127)}})).find("'address'"),
            std::string::npos);
}

TEST(Micromodem, TheSameWorldGivesTheSameHashes) {
  const auto hashes = [] {
    Hosts hosts(three_micromodems(", synchronous: true"));
    std::vector<std::uint64_t> all;
    for (int i = 0; i < 10; ++i) {
      hosts.emit("a", "$CCMPC,1,2");
      hosts.emit("c", "$CCMUC,3,1,0123");
      hosts.run_for(0.7);
      all.push_back(hosts.world.state().hash());
    }
    return all;
  };
  EXPECT_EQ(hashes(), hashes());
}

TEST(Micromodem, WarnsOfTwoWithOneAddressAndNotOfOneThatComesBack) {
  Hosts hosts(three_micromodems());
  const test_support::LogCapture log;
  const sim::VehicleInstance a = hosts.loaded.config.vehicles[0];
  for (int i = 0; i < 3; ++i) {
    hosts.world.editor().remove_vehicle("a");
    hosts.world.editor().add_vehicle(a);
    hosts.run_for(0.1);
  }
  EXPECT_EQ(log.text(), "");
  hosts.emit("a", "$CCCFG,SRC,2");
  hosts.run_for(0.1);
  EXPECT_THAT(log.text(), HasSubstr("'b/modem' and 'a/modem' have the same address 2 in network 'micromodem'"));
}

}  // namespace
