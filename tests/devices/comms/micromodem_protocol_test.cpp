// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem_protocol.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "tests/devices/comms/micromodem_host.hpp"

namespace {

using devices::MicromodemPacket;
using testing::ElementsAre;
using testing::StartsWith;

using Modem = test::HostedMicromodem;

TEST(MicromodemProtocol, RequestsEachFrameAndSendsThemTogether) {
  Modem modem;
  EXPECT_THAT(modem.host("$CCCYC,0,1,2,2,0,3"), ElementsAre("CACYC,0,1,2,2,0,3", "CADRQ,050607,1,2,0,64,1"));
  EXPECT_THAT(modem.host("$CCTXD,1,2,0,aabb"), ElementsAre("CATXD,1,2,0,2", "CADRQ,050607,1,2,0,64,2"));
  EXPECT_THAT(modem.host("$CCTXD,1,2,1,cc"), ElementsAre("CATXD,1,2,1,1", "CADRQ,050607,1,2,0,64,3"));
  EXPECT_THAT(modem.host("$CCTXD,1,2,0,"), ElementsAre("CATXD,1,2,0,0"));  // no more
  ASSERT_EQ(modem.recorder.sent.size(), 1u);
  EXPECT_EQ(modem.recorder.sent[0].kind, MicromodemPacket::Kind::data);
  EXPECT_EQ(modem.recorder.sent[0].frames.size(), 2u);
  EXPECT_TRUE(modem.recorder.sent[0].frames[1].ack);
  EXPECT_THAT(modem.wait(0), ElementsAre("CATXP,3"));
  EXPECT_THAT(modem.wait(1), ElementsAre("CATXF,3", "CAXST,20260304,050607.0000,0,0,200,5000,25000,2,1,2,0,2,2,3,3"));
}

TEST(MicromodemProtocol, RateZeroSendsItsCycleInitAsAPacketOfItsOwn) {
  Modem modem;
  modem.host("$CCCYC,0,1,2,0,0,1");
  modem.host("$CCTXD,1,2,0,01");
  ASSERT_EQ(modem.recorder.sent.size(), 2u);
  EXPECT_EQ(modem.recorder.sent[0].kind, MicromodemPacket::Kind::cycle_init);
  EXPECT_EQ(modem.recorder.sent[1].kind, MicromodemPacket::Kind::data);
  const auto reported = modem.wait(5);
  EXPECT_EQ(std::count_if(reported.begin(), reported.end(), [](const auto& s) { return s.starts_with("CAXST"); }), 2);
}

TEST(MicromodemProtocol, ReportsTheHostWhatItDoesNotTake) {
  Modem modem;
  const auto error = [&](const std::string& line) {
    const auto reported = modem.host(line);
    return reported.size() == 1 ? reported[0] : std::string("not one sentence");
  };
  EXPECT_EQ(error("$CCXYZ,1"), "CAERR,050607,NMEA,1,unknown sentence CCXYZ");
  EXPECT_EQ(error("$CCMPC,1,2*00"), "CAERR,050607,NMEA,2,bad checksum");
  EXPECT_EQ(error("$CCMPC,1,200"), "CAERR,050607,NMEA,3,address must be 0 to 126, or 127 as destination");
  EXPECT_EQ(error("$CCMPC,2,1"), "CAERR,050607,MPC,3,a ping must be sent from this modem to another");
  EXPECT_EQ(error("$CCCYC,0,1,2,7,0,1"), "CAERR,050607,CYC,3,rate must be 0 to 6");
  EXPECT_EQ(error("$CCCYC,0,1,2,0,0,2"), "CAERR,050607,CYC,3,frames must be 1 to 1");
  EXPECT_EQ(error("$CCCYC,0,1,2,0,2,1"), "CAERR,050607,CYC,3,ack must be 0 or 1");
  EXPECT_EQ(error("$CCTXD,1,2,0,00"), "CAERR,050607,TXD,6,no data was requested");
  EXPECT_EQ(error("$CCMUC,1,2,2000"), "CAERR,050607,MUC,3,data must be 0000 to 1fff");
  EXPECT_EQ(error("$CCCFG,SRC,127"), "CAERR,050607,NMEA,3,value of SRC out of range");  // everyone is not an one
  EXPECT_EQ(error("$CCCFG,ABC,1"), "CAERR,050607,NMEA,3,unknown setting ABC");
  EXPECT_EQ(error("$CCCLK,2026,2,30,0,0,0"), "CAERR,050607,NMEA,3,no such day");
  modem.protocol.take_line({"$CCTXD,1,2,0", true}, modem.now);
  EXPECT_THAT(modem.recorder.take(), ElementsAre("CAERR,050607,NMEA,1,line too long"));

  modem.host("$CCCYC,0,1,2,0,0,1");
  EXPECT_EQ(error("$CCTXD,1,2,0," + std::string(66, '0')),
            "CAERR,050607,TXD,5,data too long: 33 bytes and room for 32");
  EXPECT_EQ(error("$CCTXD,1,2,0,0x"), "CAERR,050607,TXD,3,data must be bytes in hexadecimal");
  EXPECT_EQ(error("$CCMPC,1,2"), "CAERR,050607,MPC,4,busy");
  EXPECT_THAT(modem.host("$CCTXD,1,2,0," + std::string(64, '0')), ElementsAre("CATXD,1,2,0,32"));
  EXPECT_EQ(modem.protocol.errors(), 16);
}

TEST(MicromodemProtocol, GivesUpWhenTheHostSendsNoData) {
  Modem modem;
  modem.host("$CCCYC,0,1,2,0,0,1");
  EXPECT_THAT(modem.wait(1.9), ElementsAre());
  EXPECT_THAT(modem.wait(0.2), ElementsAre("CAERR,050609,DATA_TIMEOUT,1"));
  EXPECT_EQ(modem.recorder.sent.size(), 0u);
  EXPECT_THAT(modem.host("$CCMPC,1,2"), ElementsAre("CAMPC,1,2"));  // it is free again
}

TEST(MicromodemProtocol, SetsItsClockAndRestarts) {
  Modem modem;
  EXPECT_THAT(modem.host("$CCCLK,2030,12,31,23,59,58"), ElementsAre("CACLK,2030,12,31,23,59,58"));
  EXPECT_THAT(modem.wait(10), ElementsAre("CAREV,000008,AUV,0.93.0.48"));
  EXPECT_THAT(modem.host("$CCMSC,1,1,0"), ElementsAre("CAMSC,1,1,0"));
  EXPECT_THAT(modem.wait(1), ElementsAre("CAREV,050618,INIT,0.93.0.48"));
  EXPECT_THAT(modem.wait(9.9), ElementsAre());
  EXPECT_THAT(modem.wait(0.1), ElementsAre("CAREV,050628,AUV,0.93.0.48"));
}

TEST(MicromodemProtocol, AFreshStartEndsWhatItWasAbout) {
  Modem modem;
  modem.host("$CCMUC,1,2,1fab");  // for 1 s; $CATXF and $CAXST are still to come
  modem.host("$CCMSC,1,1,0");
  EXPECT_EQ(modem.recorder.called_back, 1);
  EXPECT_THAT(modem.wait(1), ElementsAre("CAREV,050608,INIT,0.93.0.48"));
  modem.host("$CCCYC,0,1,2,0,0,1");
  modem.protocol.restart(modem.now);  // the power was off
  EXPECT_THAT(modem.wait(0), ElementsAre("CAREV,050608,INIT,0.93.0.48"));
  EXPECT_THAT(modem.wait(5), ElementsAre());  // no one misses the data of the cycle
  EXPECT_THAT(modem.host("$CCMPC,1,2"), ElementsAre("CAMPC,1,2"));
}

TEST(MicromodemProtocol, StartsOnceHoweverOftenItIsTold) {
  Modem modem;
  for (int i = 0; i < 1000; ++i) modem.host("$CCMSC,1,1,0");
  modem.wait(0.5);
  EXPECT_THAT(modem.host("$CCMSC,1,1,0"), ElementsAre());  // it is down
  EXPECT_THAT(modem.host("$CCMPC,1,2"), ElementsAre());
  EXPECT_THAT(modem.wait(0.5), ElementsAre("CAREV,050608,INIT,0.93.0.48"));
  EXPECT_THAT(modem.wait(5), ElementsAre());
}

TEST(MicromodemProtocol, TakesNoNoticeOfWhatModemsSay) {
  // A terminal that echoes gives it all back.
  Modem modem;
  for (const std::string& reported : modem.host("$CCXYZ")) EXPECT_THAT(modem.host("$" + reported), ElementsAre());
  EXPECT_THAT(modem.host("$SNTTA,,0.2000,,,000000.05"), ElementsAre());
  EXPECT_EQ(modem.protocol.errors(), 1);
}

TEST(MicromodemProtocol, TheHashKnowsWhatItIsAbout) {
  const auto hash_after = [](const std::vector<std::string>& lines) {
    Modem modem;
    for (const auto& line : lines) modem.host(line);
    auto archive = sim::StateArchive::hasher();
    archive(modem.protocol);
    return archive.hash();
  };
  const std::vector<std::vector<std::string>> all{{},
                                                  {"$CCCYC,0,1,2,2,0,3"},
                                                  {"$CCCYC,0,1,3,2,0,3"},
                                                  {"$CCCYC,0,1,2,2,1,3"},
                                                  {"$CCCYC,0,1,2,2,0,2"},
                                                  {"$CCMPC,1,2"},
                                                  {"$CCMPC,1,3"},
                                                  {"$CCCYC,0,2,1,0,0,1"},
                                                  {"$CCCYC,0,3,1,0,0,1"},
                                                  {"$CCPDT,1,1,0,0,3000,1,1,1,0"},
                                                  {"$CCPDT,1,1,0,0,3000,1,1,0,0"}};
  std::vector<std::uint64_t> hashes;
  for (const auto& lines : all) hashes.push_back(hash_after(lines));
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end());
}

TEST(MicromodemProtocol, AnswersAPingAfterItsTurnaroundAndTakesItOff) {
  Modem asker, target(Modem::at_address(2));
  asker.host("$CCMPC,1,2");
  asker.recorder.stepped_us = -400'000;  // GPS sets the clock right meanwhile
  devices::MicromodemArrival there;
  there.started = sim::from_seconds(0.5), there.ended = sim::from_seconds(1.2);
  target.now = there.ended;
  target.protocol.receive(asker.recorder.sent.back(), there);
  EXPECT_THAT(target.recorder.take(), ElementsAre("CAMPA,1,2", StartsWith("CACST,0,050607.5000,0,")));
  ASSERT_EQ(target.recorder.sent.size(), 1u);
  devices::MicromodemArrival back;  // it went at 1.5 s
  back.started = sim::from_seconds(2.0124), back.ended = sim::from_seconds(2.7);
  asker.now = back.ended;
  asker.protocol.receive(target.recorder.sent.back(), back);
  EXPECT_THAT(asker.recorder.take(), testing::Contains("CAMPR,2,1,0.5062"));
}

TEST(MicromodemProtocol, ReportsThePingsOfOthersAndTheirAnswers) {
  Modem third(Modem::at_address(3));
  MicromodemPacket packet;
  packet.kind = MicromodemPacket::Kind::ping;
  packet.source = 1, packet.destination = 2;
  third.protocol.receive(packet, {});
  EXPECT_THAT(third.recorder.take(), ElementsAre("CAMPA,1,2", StartsWith("CACST,0,")));
  packet.kind = MicromodemPacket::Kind::ping_reply;
  packet.source = 2, packet.destination = 1;
  third.protocol.receive(packet, {});
  EXPECT_THAT(third.recorder.take(), ElementsAre("CAMPR,2,1", StartsWith("CACST,0,")));
  EXPECT_TRUE(third.recorder.sent.empty());
}

TEST(MicromodemProtocol, APingWithoutAnAnswerEndsInTime) {
  Modem modem;
  modem.host("$CCMPC,1,2");
  EXPECT_THAT(modem.wait(8), testing::Contains("CAMPR,2,1"));
  EXPECT_THAT(modem.host("$CCMUC,1,2,1fab"), ElementsAre("CAMUC,1,2,1fab"));
}

TEST(MicromodemProtocol, ReportsABadFrameAndAMissingPacket) {
  Modem modem(Modem::at_address(2));
  MicromodemPacket packet;
  packet.kind = MicromodemPacket::Kind::data;
  packet.source = 1, packet.destination = 2, packet.rate = 2, packet.frame_count = 1;
  packet.frames.push_back({false, sim::Bytes(3)});
  devices::MicromodemArrival arrival;
  arrival.good = false;
  modem.protocol.receive(packet, arrival);
  EXPECT_THAT(modem.recorder.take(), ElementsAre("CACYC,0,1,2,2,0,1", "CAMSG,BAD_CRC,2", StartsWith("CACST,1,")));
  packet.kind = MicromodemPacket::Kind::cycle_init;
  packet.rate = 0;
  packet.frames.clear();
  arrival.good = true;
  modem.protocol.receive(packet, arrival);
  modem.recorder.take();
  EXPECT_THAT(modem.wait(15), testing::Contains("CAMSG,PACKET_TIMEOUT,0"));
}

TEST(MicromodemProtocol, AllFramesOfABadPacketAreBad) {
  Modem modem(Modem::at_address(2));
  MicromodemPacket packet;
  packet.kind = MicromodemPacket::Kind::data;
  packet.source = 1, packet.destination = 2, packet.rate = 2, packet.frame_count = 3;
  packet.frames.assign(3, {false, sim::Bytes(3)});
  devices::MicromodemArrival arrival;
  for (const bool good : {true, false}) {
    arrival.good = good;
    modem.protocol.receive(packet, arrival);
    const auto lines = modem.recorder.take();
    EXPECT_EQ(std::count_if(lines.begin(), lines.end(), [](const auto& line) { return line.starts_with("CARXD"); }),
              good ? 3 : 0);
  }
}

TEST(MicromodemProtocol, SurvivesNoiseAndMutatedSentences) {
  const std::vector<std::string> sentences{"$CCCYC,0,1,2,0,1,1\r\n",  "$CCTXD,1,2,0,deadbeef\r\n",
                                           "$CCMPC,1,2*5F\r\n",       "$CCMUC,1,2,1fab\n",
                                           "$CCCFG,SRC,1\r\n",        "$CCCFQ,ALL\r\n",
                                           "$CCCLK,2026,3,4,5,6,7\n", "$CCPDT,1,1,0,0,2000,1,1,1,1\n",
                                           "$CCMSC,1,1,0\n"};
  std::mt19937 random(1);
  Modem modem;
  sim::NmeaLines lines;
  std::size_t max_said = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    if (random() % 3 == 0) {
      for (int k = 0; k < 20; ++k) text.push_back(static_cast<char>(random()));
    } else {
      text = sentences[random() % sentences.size()];
      for (unsigned flips = random() % 4; flips > 0; --flips)
        text[random() % text.size()] = static_cast<char>(random());
      if (random() % 5 == 0) text.resize(random() % text.size());
    }
    for (const auto& line : lines.add(std::as_bytes(std::span(text.data(), text.size()))))
      modem.protocol.take_line(line, modem.now);
    max_said = std::max(max_said, modem.recorder.take().size());
    if (random() % 4 == 0) modem.wait(0.3);
    modem.recorder.sent.clear();
    modem.recorder.seconds.clear();
  }
  EXPECT_LT(max_said, 500u);  // some $CCCFQ,ALL
  modem.wait(20);
  modem.wait(20);
  modem.protocol.take_line({"$CCCFG,SRC,1", false}, modem.now);
  EXPECT_THAT(modem.recorder.take(), ElementsAre("CACFG,SRC,1"));  // it still listens
}

}  // namespace
