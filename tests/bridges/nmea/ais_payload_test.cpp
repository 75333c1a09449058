// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/ais_payload.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "sim/nmea/nmea.hpp"

namespace {

using bridges::nmea::ais_payload;
using bridges::nmea::ais_sentences;
using bridges::nmea::read_ais_payload;
using shoal::ais_t;

constexpr double degree = std::numbers::pi / 180, knot = 1852.0 / 3600;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// The payload of sentences, whose checksums are right.
std::string payload_of(const std::vector<std::string>& sentences) {
  std::string payload;
  for (const std::string& text : sentences) {
    sim::NmeaSentence sentence;
    EXPECT_EQ(sim::parse_nmea(text, sentence, '!'), sim::NmeaError::none) << text;
    EXPECT_EQ(sentence.number(1, 1, 9), static_cast<int>(sentences.size()));
    EXPECT_LE(text.size(), 80u);
    payload += sentence.at(5);
  }
  return payload;
}

ais_t read(const std::vector<std::string>& sentences) {
  const auto message = read_ais_payload(payload_of(sentences));
  if (!message) throw std::runtime_error("not an AIS message");
  return *message;
}

ais_t message_of(int type) {
  ais_t message{};
  message.type = static_cast<std::int8_t>(type);
  message.mmsi = 211'000'123;
  message.latitude = -33.5;
  message.longitude = 151.25;
  message.speed_mps = 12.3 * knot;
  message.course_rad = 200.1 * degree;
  message.heading_rad = 199 * degree;
  message.turn_radps = -5.0 / 60 * degree;
  message.name = "OTTER 1";
  message.call_sign = "DA1234";
  message.destination = "KIEL";
  message.ship_type = 36;
  message.imo = 9'134'270;
  message.bow_m = 100;
  message.stern_m = 20;
  message.port_m = 5;
  message.starboard_m = 6;
  message.draught_m = 2.5;
  return message;
}

// The sentences and the values of the next three tests are in E. S. Raymond's description of AIVDM, and in the tests of
// other decoders.
TEST(AisPayload, APositionOfClassAIsReadAsPublished) {
  const ais_t message = read({"!AIVDM,1,1,,B,177KQJ5000G?tO`K>RA1wUbN0TKH,0*5C"});
  EXPECT_EQ(message.type, 1);
  EXPECT_EQ(message.mmsi, 477'553'000);
  EXPECT_EQ(message.status, 5);
  EXPECT_EQ(message.speed_mps, 0);
  EXPECT_EQ(message.turn_radps, 0);
  EXPECT_NEAR(message.longitude, -73'407'500 / 600'000.0, 1e-12);
  EXPECT_NEAR(message.latitude, 28'549'700 / 600'000.0, 1e-12);
  EXPECT_NEAR(message.course_rad, 51 * degree, 1e-12);
  EXPECT_NEAR(message.heading_rad, 181 * degree, 1e-12);
}

TEST(AisPayload, StaticDataOfClassAAreReadAsPublished) {
  const ais_t message = read({"!AIVDM,2,1,1,A,55?MbV02;H;s<HtKR20EHE:0@T4@Dn2222222216L961O5Gf0NSQEp6ClRp8,0*1C",
                              "!AIVDM,2,2,1,A,88888888880,2*25"});
  EXPECT_EQ(message.type, 5);
  EXPECT_EQ(message.mmsi, 351'759'000);
  EXPECT_EQ(message.imo, 9'134'270);
  EXPECT_EQ(message.call_sign, "3FOF8");
  EXPECT_EQ(message.name, "EVER DIADEM");
  EXPECT_EQ(message.ship_type, 70);
  EXPECT_EQ(message.bow_m, 225);
  EXPECT_EQ(message.stern_m, 70);
  EXPECT_EQ(message.port_m, 1);
  EXPECT_EQ(message.starboard_m, 31);
  EXPECT_NEAR(message.draught_m, 12.2, 1e-12);
  EXPECT_EQ(message.destination, "NEW YORK");
}

TEST(AisPayload, MessagesOfClassBAreReadAsPublished) {
  const ais_t position = read({"!AIVDM,1,1,,A,B52K>;h00Fc>jpUlNV@ikwpUoP06,0*4C"});
  EXPECT_EQ(position.type, 18);
  EXPECT_EQ(position.mmsi, 338'087'471);
  EXPECT_NEAR(position.speed_mps, 0.1 * knot, 1e-12);
  EXPECT_NEAR(position.longitude, -44'443'279 / 600'000.0, 1e-12);
  EXPECT_NEAR(position.latitude, 24'410'724 / 600'000.0, 1e-12);
  EXPECT_NEAR(position.course_rad, 79.6 * degree, 1e-12);
  EXPECT_TRUE(std::isnan(position.heading_rad));
  const ais_t part_a = read({"!AIVDM,1,1,,A,H42O55i18tMET00000000000000,2*6D"});  // without its last 8 bits
  EXPECT_EQ(part_a.type, 24);
  EXPECT_EQ(part_a.part, 0);
  EXPECT_EQ(part_a.mmsi, 271'041'815);
  EXPECT_EQ(part_a.name, "PROGUY");
  const ais_t part_b = read({"!AIVDM,1,1,,A,H42O55lt0000000D3nink000?050,0*40"});
  EXPECT_EQ(part_b.part, 1);
  EXPECT_EQ(part_b.ship_type, 60);
  EXPECT_EQ(part_b.call_sign, "TC6163");
  EXPECT_EQ(part_b.stern_m, 15);
  EXPECT_EQ(part_b.starboard_m, 5);
}

TEST(AisPayload, PositionsAreReadAsTheyAreWritten) {
  for (const int type : {1, 18}) {
    const ais_t sent = message_of(type);
    const ais_t message = read(ais_sentences(sent, 42, 3));
    EXPECT_EQ(message.type, type);
    EXPECT_EQ(message.mmsi, sent.mmsi);
    EXPECT_NEAR(message.latitude, sent.latitude, 1e-9);
    EXPECT_NEAR(message.longitude, sent.longitude, 1e-9);
    EXPECT_NEAR(message.speed_mps, sent.speed_mps, 1e-9);
    EXPECT_NEAR(message.course_rad, sent.course_rad, 1e-9);
    EXPECT_NEAR(message.heading_rad, sent.heading_rad, 1e-9);
    // 4.733 sqrt(5) = 10.58, which becomes 11: (11 / 4.733)^2 = 5.40 degrees per minute.
    if (type == 1) {
      EXPECT_NEAR(message.turn_radps, -5.4016 / 60 * degree, 1e-6);
    }
  }
}

TEST(AisPayload, StaticDataAreReadAsTheyAreWritten) {
  for (const int part : {-1, 0, 1}) {
    ais_t sent = message_of(part < 0 ? 5 : 24);
    sent.part = static_cast<std::int8_t>(std::max(part, 0));
    const ais_t message = read(ais_sentences(sent, 0, 3));
    EXPECT_EQ(message.mmsi, sent.mmsi);
    if (part != 1) {
      EXPECT_EQ(message.name, sent.name);
    }
    if (part == 0) continue;
    EXPECT_EQ(message.call_sign, sent.call_sign);
    EXPECT_EQ(message.ship_type, sent.ship_type);
    EXPECT_EQ(message.bow_m, sent.bow_m);
    EXPECT_EQ(message.stern_m, sent.stern_m);
    EXPECT_EQ(message.port_m, sent.port_m);
    EXPECT_EQ(message.starboard_m, sent.starboard_m);
    if (part == 1) continue;
    EXPECT_EQ(message.imo, sent.imo);
    EXPECT_EQ(message.destination, sent.destination);
    EXPECT_NEAR(message.draught_m, sent.draught_m, 1e-9);
  }
}

TEST(AisPayload, OwnMessagesAreAivdoAndLongOnesHaveTwoSentencesOfAGroup) {
  ais_t message = message_of(5);
  message.own = true;
  message.radio_channel = 1;
  const auto two = ais_sentences(message, 0, 7);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].substr(0, 15), "!AIVDO,2,1,7,B,");
  EXPECT_EQ(two[1].substr(0, 15), "!AIVDO,2,2,7,B,");
  EXPECT_EQ(two[1].substr(two[1].size() - 5, 2), ",2");  // 71 characters have two bits more than 424
  const auto one = ais_sentences(message_of(1), 0, 7);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].substr(0, 14), "!AIVDM,1,1,,A,");
  EXPECT_TRUE(ais_sentences(message_of(4), 0, 7).empty());
}

TEST(AisPayload, ValuesThatAreNotAvailableOrOutOfRangeHaveTheirCodes) {
  ais_t message = message_of(1);
  for (double* value : {&message.latitude, &message.longitude, &message.speed_mps, &message.course_rad,
                        &message.heading_rad, &message.turn_radps})
    *value = nothing;
  const ais_t none = read(ais_sentences(message, 60, 0));
  for (const double value :
       {none.latitude, none.longitude, none.speed_mps, none.course_rad, none.heading_rad, none.turn_radps})
    EXPECT_TRUE(std::isnan(value));
  message = message_of(1);
  message.speed_mps = 1e300;
  message.turn_radps = -1e300;
  message.course_rad = 359.99 * degree;
  message.mmsi = -5;
  const ais_t most = read(ais_sentences(message, 0, 0));
  EXPECT_NEAR(most.speed_mps, 102.2 * knot, 1e-9);
  EXPECT_NEAR(most.turn_radps, -std::pow(126 / 4.733, 2) / 60 * degree, 1e-9);
  EXPECT_NEAR(most.course_rad, 0, 1e-9);
  EXPECT_EQ(most.mmsi, 0);
}

TEST(AisPayload, OtherPayloadsAreNone) {
  for (const char* payload : {"", "1", "177KQJ5000G?tO`K>RA1w", "477KQJ5000G?tO`K>RA1wUbN0TKH",
                              "1 7KQJ5000G?tO`K>RA1wUbN0TKH", "1\xff\xffKQJ5000G?tO`K>RA1wUbN0TKH"})
    EXPECT_FALSE(read_ais_payload(payload)) << payload;
}

}  // namespace
