// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "experiment/score/link_counts.hpp"
#include "experiment/score/metric.hpp"
#include "experiment/score/scoring.hpp"
#include "tests/devices/comms/modem_fixture.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/experiment/score/metric_worlds.hpp"

namespace {

using namespace metric_worlds;

TEST(Delivery, OfAWorldWithoutModemsHasNoRatio) {
  MetricWorld world("  - {name: d, type: delivery}\n");
  world.run_for(0.01);
  EXPECT_EQ(world.figure("d.sent"), 0);
  EXPECT_EQ(world.figure("d.received"), 0);
  EXPECT_TRUE(std::isnan(world.figure("d.ratio")));
  for (const std::string& cause : experiment::loss_causes()) EXPECT_EQ(world.figure("d.lost_" + cause), 0);
}

TEST(Delivery, CountsWhatModemsSentAndWhatTheOthersReceived) {
  const std::string modem = "{name: modem, type: acoustic_modem}";
  test::TestWorld test(
      test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem}, {"c", "[0, 600, -20]", modem}},
                      "metrics:\n"
                      "  - {name: all, type: delivery}\n"
                      "  - {name: a, type: delivery, vehicle: a}\n"
                      "  - {name: c, type: delivery, vehicle: c, device: modem}\n"));
  experiment::Scoring scoring(test.world);
  test.send("a.modem.cmd", test::bytes_to("hello"));
  test.run_for(5);
  auto figures = scoring.figures();
  EXPECT_EQ(figures.at("all.sent"), 1);
  EXPECT_EQ(figures.at("all.bytes_sent"), 5);
  EXPECT_EQ(figures.at("all.received"), 2);  // b and c
  EXPECT_EQ(figures.at("all.ratio"), 1);
  EXPECT_EQ(figures.at("a.sent"), 1);
  EXPECT_TRUE(std::isnan(figures.at("a.ratio")));
  EXPECT_EQ(figures.at("c.sent"), 0);
  EXPECT_EQ(figures.at("c.received"), 1);

  // Each is sending when the other's sound comes, 0.2 s later.
  test.send("a.modem.cmd", test::bytes_to("hello"));
  test.send("b.modem.cmd", test::bytes_to("hello"));
  test.run_for(5);
  figures = scoring.figures();
  EXPECT_EQ(figures.at("all.sent"), 3);
  EXPECT_EQ(figures.at("all.lost_half_duplex"), 2);
  EXPECT_EQ(figures.at("a.lost_half_duplex"), 1);
  EXPECT_EQ(figures.at("a.ratio"), 0);
  double lost = 0;
  for (const std::string& cause : experiment::loss_causes()) lost += figures.at("all.lost_" + cause);
  EXPECT_EQ(figures.at("all.lost"), lost);
  EXPECT_EQ(figures.at("all.ratio"), figures.at("all.received") / (figures.at("all.received") + lost));
}

/// far cannot receive a, near can.
TEST(Delivery, IsOfWhatWasSentToAModem) {
  const std::string modem = "{name: modem, type: acoustic_modem}";
  test::TestWorld test(test::modem_sea(
      {{"a", "[0, 0, -20]", modem}, {"near", "[300, 0, -20]", modem}, {"far", "[200000, 0, -20]", modem}},
      "metrics:\n  - {name: all, type: delivery}\n  - {name: far, type: delivery, vehicle: far}\n"));
  experiment::Scoring scoring(test.world);
  test.send("a.modem.cmd", test::bytes_to("hello", "near"));
  test.run_for(5);
  EXPECT_EQ(scoring.figures().at("all.ratio"), 1) << "nobody sent to the other one";
  EXPECT_TRUE(std::isnan(scoring.figures().at("far.ratio")));
  test.send("a.modem.cmd", test::bytes_to("hello"));
  test.send("a.modem.cmd", test::bytes_to("hello", "far"));
  test.run_for(10);
  EXPECT_EQ(scoring.figures().at("all.received"), 2);
  EXPECT_EQ(scoring.figures().at("all.lost_range"), 2);
  EXPECT_EQ(scoring.figures().at("all.ratio"), 0.5);
  EXPECT_EQ(scoring.figures().at("far.ratio"), 0);
}

TEST(Delivery, CountsWhatWasNotSent) {
  const std::string modem = "{name: modem, type: acoustic_modem, queue_messages: 2}";
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem}},
                                       "metrics:\n  - {name: a, type: delivery, vehicle: a}\n"));
  experiment::Scoring scoring(test.world);
  for (int i = 0; i < 5; ++i) test.send("a.modem.cmd", test::bytes_to("hello"));
  test.run_for(10);
  EXPECT_EQ(scoring.figures().at("a.dropped"), 3);
  EXPECT_EQ(scoring.figures().at("a.sent"), 2);
  EXPECT_EQ(scoring.figures().at("a.unsent"), 0);
}

/// b is in range of a, c is not; d is out of the water that hides it.
TEST(Delivery, OfARadioModemCountsWhatCameAndWhatDidNot) {
  const std::string radio = "{name: radio, type: modem, range_m: 500}";
  test::TestWorld test(test::modem_sea(
      {{"a", "[0, 0, 2]", radio}, {"b", "[300, 0, 2]", radio}, {"c", "[600, 0, 2]", radio}, {"d", "[0, 9, -2]", radio}},
      "metrics:\n"
      "  - {name: all, type: delivery}\n"
      "  - {name: a, type: delivery, vehicle: a, device: radio}\n"
      "  - {name: b, type: delivery, vehicle: b, device: radio}\n"
      "  - {name: c, type: delivery, vehicle: c}\n"
      "  - {name: d, type: delivery, vehicle: d}\n"));
  experiment::Scoring scoring(test.world);
  EXPECT_TRUE(std::isnan(scoring.figures().at("all.ratio"))) << "nothing was sent";
  test.send("a.radio.cmd", test::bytes_to("hello"));
  test.run_for(1);
  test.send("a.radio.cmd", test::bytes_to("b only", "b"));
  test.run_for(1);
  const auto figures = scoring.figures();
  EXPECT_EQ(figures.at("a.sent"), 2);
  EXPECT_EQ(figures.at("a.bytes_sent"), 11);
  EXPECT_TRUE(std::isnan(figures.at("a.ratio"))) << "nobody sent to it";
  EXPECT_EQ(figures.at("b.received"), 2);
  EXPECT_EQ(figures.at("b.ratio"), 1);
  EXPECT_EQ(figures.at("c.lost_range"), 1);
  EXPECT_EQ(figures.at("c.ratio"), 0);
  EXPECT_EQ(figures.at("d.lost_blocked"), 1);
  EXPECT_EQ(figures.at("all.ratio"), 0.5) << "two of four";
}

TEST(Delivery, OfALossyRadioLinkIsAboutItsProbability) {
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, 2]", "{name: radio, type: modem, loss_probability: 0.25}"},
                                        {"b", "[50, 0, 2]", "{name: radio, type: modem}"}},
                                       "metrics:\n  - {name: b, type: delivery, vehicle: b, device: radio}\n"));
  experiment::Scoring scoring(test.world);
  constexpr int messages = 2000;
  for (int i = 0; i < messages; ++i) {
    test.send("a.radio.cmd", test::bytes_to("x"));
    test.run_for(0.01);
  }
  test.run_for(0.1);
  const auto figures = scoring.figures();
  EXPECT_EQ(figures.at("b.received") + figures.at("b.lost_link"), messages);
  // Five standard deviations of a share of so many draws.
  EXPECT_NEAR(figures.at("b.ratio"), 0.75, 5 * std::sqrt(0.25 * 0.75 / messages));
}

/// A vehicle with both: without a name it is about the acoustic ones, as it was.
TEST(Delivery, OfAVehicleWithBothIsAboutSoundUnlessItNamesTheRadio) {
  const std::string both = "{name: radio, type: modem, range_m: 500}, {name: modem, type: acoustic_modem}";
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, -2]", both}, {"b", "[300, 0, -2]", both}},
                                       "metrics:\n  - {name: all, type: delivery}\n"
                                       "  - {name: b, type: delivery, vehicle: b}\n"
                                       "  - {name: r, type: delivery, vehicle: b, device: radio}\n"));
  experiment::Scoring scoring(test.world);
  test.send("a.radio.cmd", test::bytes_to("hello"));
  test.run_for(1);
  const auto figures = scoring.figures();
  EXPECT_EQ(figures.at("all.sent"), 0);
  EXPECT_TRUE(std::isnan(figures.at("b.ratio")));
  EXPECT_EQ(figures.at("r.ratio"), 0);
  EXPECT_EQ(figures.at("r.lost_blocked"), 1);
}

TEST(Delivery, ATransponderIsNoModem) {
  const std::string devices =
      "{name: radio, type: modem, range_m: 500}, {name: noise, type: noise_source}, "
      "{name: answers, type: transponder}";
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, 2]", devices}, {"b", "[300, 0, 2]", devices}},
                                       "metrics:\n  - {name: all, type: delivery}\n"
                                       "  - {name: b, type: delivery, vehicle: b}\n"));
  experiment::Scoring scoring(test.world);
  test.send("a.radio.cmd", test::bytes_to("hello"));
  test.run_for(1);
  const auto figures = scoring.figures();
  EXPECT_EQ(figures.at("all.sent"), 1);
  EXPECT_EQ(figures.at("all.received"), 1);
  EXPECT_EQ(figures.at("b.ratio"), 1);
}

TEST(Delivery, OfModemsThatHaveLeftIsStillAboutThem) {
  const std::string modem = "{name: modem, type: acoustic_modem}";
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem}},
                                       "metrics:\n  - {name: all, type: delivery}\n"));
  experiment::Scoring scoring(test.world);
  test.send("a.modem.cmd", test::bytes_to("hello"));
  test.run_for(10);
  for (const char* name : {"a", "b"}) test.world.editor().remove_vehicle(name);
  EXPECT_EQ(scoring.figures().at("all.sent"), 1);
  EXPECT_EQ(scoring.figures().at("all.ratio"), 1);
}

}  // namespace
