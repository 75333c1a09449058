// SPDX-License-Identifier: BSD-3-Clause
#include "sim/nmea/nmea.hpp"

#include <gtest/gtest.h>

namespace {

using sim::NmeaError;
using sim::NmeaLines;
using sim::NmeaSentence;

std::vector<NmeaLines::Line> add(NmeaLines& lines, const std::string& text) {
  return lines.add(std::as_bytes(std::span(text.data(), text.size())));
}

TEST(Nmea, ChecksumsAreThoseOfTheExamples) {
  // Sentences of real modems, as recorded by others.
  for (const char* sentence : {"$CAMPR,2,1,0.0101*7C", "$CAMPA,1,2*5D", "$CAMUA,1,2,1fab*20",
                               "$CAREV,000052,AUV,0.93.0.09*07", "$CACFG,SRC,1*33", "$CATXF,28*6E"}) {
    NmeaSentence parsed;
    ASSERT_EQ(sim::parse_nmea(sentence, parsed), NmeaError::none) << sentence;
    std::string body = parsed.name();
    for (std::size_t i = 1; i <= parsed.count(); ++i) body += "," + parsed.at(i);
    EXPECT_EQ(sim::nmea_sentence(body), sentence);
  }
}

TEST(Nmea, AChecksumMayBeMissingButMustBeRight) {
  NmeaSentence parsed;
  EXPECT_EQ(sim::parse_nmea("$CCMPC,1,2", parsed), NmeaError::none);
  EXPECT_EQ(parsed.name(), "CCMPC");
  EXPECT_EQ(parsed.number(2, 0, 127), 2);
  EXPECT_EQ(parsed.number(2, 0, 1), std::nullopt);
  EXPECT_EQ(parsed.number(3, 0, 127), std::nullopt);
  EXPECT_EQ(parsed.at(3), "");
  EXPECT_EQ(sim::parse_nmea("$CAMPA,1,2*5E", parsed), NmeaError::bad_checksum);
  EXPECT_EQ(sim::parse_nmea("$CAMPA,1,2*5", parsed), NmeaError::bad_checksum);
  EXPECT_EQ(sim::parse_nmea("$CAMPA,1,2*5D7", parsed), NmeaError::bad_checksum);
  EXPECT_EQ(sim::parse_nmea("$CAMPA,1,2*", parsed), NmeaError::bad_checksum);
  EXPECT_EQ(sim::parse_nmea("CAMPA,1,2*5D", parsed), NmeaError::no_sentence);
  EXPECT_EQ(sim::parse_nmea("$", parsed), NmeaError::no_sentence);
  EXPECT_EQ(sim::parse_nmea("$CC\x01MPC", parsed), NmeaError::no_sentence);
  // The rest of a line that was cut, and then a whole one.
  EXPECT_EQ(sim::parse_nmea("$CCMP$CAMPA,1,2*5D", parsed), NmeaError::none);
  EXPECT_EQ(parsed.name(), "CAMPA");
}

TEST(Nmea, LinesComeInPiecesAndEndAsTheyLike) {
  NmeaLines lines;
  EXPECT_EQ(add(lines, "$CCM").size(), 0u);
  const auto all = add(lines, "PC,1,2\r\n\r\n$A\n$B\r$C");
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].text, "$CCMPC,1,2");
  EXPECT_EQ(all[1].text, "$A");
  EXPECT_EQ(all[2].text, "$B");
}

TEST(Nmea, ALineThatIsTooLongIsCutAndReported) {
  NmeaLines lines;
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(add(lines, std::string(1000, 'x')).size(), 0u);
  const auto all = add(lines, "\n$A\n");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_TRUE(all[0].too_long);
  EXPECT_EQ(all[0].text.size(), NmeaLines::longest);
  EXPECT_FALSE(all[1].too_long);
}

TEST(Nmea, HexadecimalDigitsAreReadAndWritten) {
  const auto bytes = sim::from_hex("00ffA5");
  ASSERT_TRUE(bytes);
  EXPECT_EQ(sim::to_hex(*bytes), "00ffa5");
  EXPECT_TRUE(sim::from_hex(""));
  for (const char* bad : {"0", "0g", "-1", "0x", " 1"}) EXPECT_FALSE(sim::from_hex(bad)) << bad;
}

}  // namespace
