// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/sentences.hpp"

#include <gtest/gtest.h>

namespace {

using namespace bridges::nmea;

template <class Sentence>
std::optional<Sentence> read_line(const std::string& line) {
  sim::NmeaSentence sentence;
  EXPECT_EQ(sim::parse_nmea(line, sentence), sim::NmeaError::none) << line;
  EXPECT_TRUE(is_a<Sentence>(sentence)) << line;
  return read<Sentence>(sentence);
}

/// The text of a sentence, once it was read from it and written again unchanged.
template <class Sentence>
std::string round_trip(const Sentence& sentence, const char* talker = "GP") {
  const std::string text = format(sentence, talker);
  EXPECT_LE(text.size(), 80u) << "NMEA 0183 allows 82 characters with the line end";
  const auto again = read_line<Sentence>(text);
  EXPECT_TRUE(again) << text;
  if (again) {
    EXPECT_EQ(format(*again, talker), text);
  }
  return text;
}

// 2026-01-01 12:34:56.780 UTC: 56 years of which 14 are leap years, 20454 days.
constexpr std::int64_t new_year_us = 20454LL * 86'400'000'000 + (12 * 3600 + 34 * 60 + 56) * 1'000'000LL + 780'000;

TEST(NmeaSentences, AFixHasDegreesAndMinutesAndTheDate) {
  Rmc rmc;
  rmc.time = new_year_us;
  rmc.status = 'A';
  rmc.latitude_deg = 42.5125;    // 42 degrees, 30.75 minutes
  rmc.longitude_deg = -70.0005;  // 0.03 minutes west of 70
  rmc.speed_kn = 3.5;
  rmc.course_deg = 7;
  rmc.variation_deg = -14.5;
  rmc.mode = 'A';
  const std::string body = "GPRMC,123456.78,A,4230.7500,N,07000.0300,W,3.50,7.0,010126,14.5,W,A";
  EXPECT_EQ(round_trip(rmc), sim::nmea_sentence(body));
  EXPECT_EQ(read_line<Rmc>(format(rmc, "GP"))->time, new_year_us);
}

TEST(NmeaSentences, WithoutAFixFieldsAreEmptyAndTheStatusIsAWarning) {
  Rmc rmc;
  rmc.time = new_year_us;
  EXPECT_EQ(round_trip(rmc), sim::nmea_sentence("GPRMC,123456.78,V,,,,,,,010126,,,N"));
  Gga gga;
  gga.time = new_year_us;
  EXPECT_EQ(round_trip(gga), sim::nmea_sentence("GPGGA,123456.78,,,,,0,00,,,M,,M,,"));
  EXPECT_EQ(round_trip(Vtg{}), sim::nmea_sentence("GPVTG,,T,,M,,N,,K,N"));
}

TEST(NmeaSentences, AMinuteIsNeverSixty) {
  Gga gga;
  gga.latitude_deg = 41.99999999;
  gga.longitude_deg = -179.99999999;
  EXPECT_EQ(round_trip(gga), sim::nmea_sentence("GPGGA,,4200.0000,N,18000.0000,W,0,00,,,M,,M,,"));
}

TEST(NmeaSentences, EachOfTheOthersIsReadAsItIsWritten) {
  EXPECT_EQ(round_trip(Hdt{271.4}, "HE"), sim::nmea_sentence("HEHDT,271.4,T"));
  EXPECT_EQ(round_trip(Vtg{90, {}, 10, 18.52, 'A'}), sim::nmea_sentence("GPVTG,90.0,T,,M,10.00,N,18.52,K,A"));
  EXPECT_EQ(round_trip(Vhw{90, {}, -1, -1.852}, "VW"), sim::nmea_sentence("VWVHW,90.0,T,,M,-1.00,N,-1.85,K"));
  EXPECT_EQ(round_trip(Dbt{32.8, 10, 5.5}, "SD"), sim::nmea_sentence("SDDBT,32.8,f,10.00,M,5.5,F"));
  EXPECT_EQ(round_trip(Dpt{10, 0.5}, "SD"), sim::nmea_sentence("SDDPT,10.00,0.50"));
  EXPECT_EQ(round_trip(Mwv{214.8, 'R', 0.1, 'N', 'A'}, "WI"), sim::nmea_sentence("WIMWV,214.8,R,0.1,N,A"));
  EXPECT_EQ(round_trip(Rot{-35.6, 'A'}, "TI"), sim::nmea_sentence("TIROT,-35.6,A"));
  EXPECT_EQ(round_trip(Xdr{'A', 2.5, 'D', "PTCH"}, "YX"), sim::nmea_sentence("YXXDR,A,2.50,D,PTCH"));
  Apb apb;
  apb.status = apb.lock = 'A';
  apb.cross_track_nmi = 0.1;
  apb.origin_bearing_deg = 11;
  apb.origin_reference = 'M';
  apb.waypoint = "DEST";
  apb.bearing_deg = 11;
  apb.heading_deg = 12.5;
  EXPECT_EQ(round_trip(apb), sim::nmea_sentence("GPAPB,A,A,0.100,L,N,V,V,11.0,M,DEST,11.0,T,12.5,T"));
  Rmb rmb;
  rmb.status = 'A';
  rmb.cross_track_nmi = 0.66;
  rmb.origin = "003";
  rmb.waypoint = "004";
  rmb.latitude_deg = 49.5;
  rmb.longitude_deg = -123.25;
  rmb.range_nmi = 1.3;
  rmb.bearing_deg = 52.5;
  EXPECT_EQ(round_trip(rmb), sim::nmea_sentence("GPRMB,A,0.660,L,003,004,4930.0000,N,12315.0000,W,1.300,52.5,,V,A"));
}

TEST(NmeaSentences, OfOlderVersionsMayEndEarlier) {
  // Version 2.0 has no mode: it keeps its default.
  const auto rmc = read_line<Rmc>("$GPRMC,225446,A,4916.45,N,12311.12,W,000.5,054.7,191194,020.3,E");
  ASSERT_TRUE(rmc);
  EXPECT_NEAR(*rmc->latitude_deg, 49 + 16.45 / 60, 1e-9);
  EXPECT_NEAR(*rmc->longitude_deg, -(123 + 11.12 / 60), 1e-9);
  EXPECT_EQ(rmc->variation_deg, 20.3);
  EXPECT_EQ(rmc->mode, 'N');
  // 1994-11-19 22:54:46 UTC: 9088 days after 1970.
  EXPECT_EQ(rmc->time, (9088LL * 86'400 + 22 * 3600 + 54 * 60 + 46) * 1'000'000);
}

TEST(NmeaSentences, FieldsThatTheyCannotHaveAreRefused) {
  for (const char* line : {"$GPHDT,361,T", "$GPHDT,-1,T", "$GPHDT,nan,T", "$GPHDT,1e9,T", "$GPHDT,1,M", "$GPHDT,12x,T"})
    EXPECT_FALSE(read_line<Hdt>(line)) << line;
  for (const char* line :
       {"$GPRMC,240000,A,,,,,,,010126,,,A", "$GPRMC,12,A,,,,,,,,,,A", "$GPRMC,-10000,A,,,,,,,,,,A",
        "$GPRMC,120000,X,,,,,,,,,,A", "$GPRMC,120000,A,9100.0,N,,,,,,,,A", "$GPRMC,120000,A,4260.0,N,,,,,,,,A",
        "$GPRMC,120000,A,42-1.0,N,,,,,,,,A", "$GPRMC,120000,A,4230.0,X,,,,,,,,A", "$GPRMC,120000,A,,,,,,,310226,,,A",
        "$GPRMC,120000,A,,,,,,,1,,,A", "$GPRMC,120000,A,,,,,,,,5,X,A"})
    EXPECT_FALSE(read_line<Rmc>(line)) << line;
  for (const char* line : {"$GPAPB,A,A,0.1,X", "$GPAPB,A,A,-1", "$GPAPB,A,A,,L,N,V,V,400,T"})
    EXPECT_FALSE(read_line<Apb>(line)) << line;
  EXPECT_FALSE(read_line<Gga>("$GPGGA,,,,,,9"));
  EXPECT_FALSE(read_line<Gga>("$GPGGA,,,,,,1,-2"));
}

}  // namespace
