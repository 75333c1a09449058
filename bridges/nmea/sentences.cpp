// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/sentences.hpp"

#include <spdlog/fmt/fmt.h>

#include <chrono>
#include <cmath>

#include "sim/base/number.hpp"

namespace bridges::nmea {

namespace {

constexpr std::int64_t day_us = 86'400'000'000;

/// Writes fields, each after a comma.
class FieldWriter {
 public:
  explicit FieldWriter(std::string body) : body_(std::move(body)) {}
  void number(const Number& value, int decimals, double /*low*/, double /*high*/) {
    std::string text = value && std::isfinite(*value) ? fmt::format("{:.{}f}", *value, decimals) : "";
    if (text.starts_with('-') && text.find_first_not_of("-0.") == text.npos) text.erase(0, 1);  // no negative zero
    add(text);
  }
  void integer(int value, int digits, int /*high*/) { add(fmt::format("{:0{}}", value, digits)); }
  void letter(char value, std::string_view /*allowed*/) { add(std::string(1, value)); }
  void word(const std::string& value) { add(value); }
  /// A unit; empty where its quantity is, as receivers do.
  void constant(std::string_view text) { add(std::string(text)); }
  /// Degrees and minutes, and N or S, E or W in the next field.
  void angle(const Number& value_deg, int degree_digits, const char* letters) {
    if (!value_deg || !std::isfinite(*value_deg)) {
      add("");
      return add("");
    }
    const auto tenthousandths = std::llround(std::abs(*value_deg) * 600'000);  // of a minute, so that 60 never appears
    add(fmt::format("{:0{}}{:02}.{:04}", tenthousandths / 600'000, degree_digits, tenthousandths / 10'000 % 60,
                    tenthousandths % 10'000));
    add(std::string(1, letters[*value_deg < 0 ? 1 : 0]));
  }
  /// The size of a number, and its sign as N or S, E or W in the next field.
  void signed_number(const Number& value, int decimals, const char* letters) {
    number(value ? Number(std::abs(*value)) : value, decimals, 0, 0);
    add(value ? std::string(1, letters[*value < 0 ? 1 : 0]) : "");
  }
  void time_of_day(const Utc& time) {
    if (!time) return add("");
    const auto hundredths = (*time % day_us + day_us) % day_us / 10'000;
    add(fmt::format("{:02}{:02}{:02}.{:02}", hundredths / 360'000, hundredths / 6000 % 60, hundredths / 100 % 60,
                    hundredths % 100));
  }
  void date(const Utc& time) {
    if (!time) return add("");
    const std::chrono::sys_time<std::chrono::microseconds> at{std::chrono::microseconds(*time)};
    const std::chrono::year_month_day day{std::chrono::floor<std::chrono::days>(at)};
    add(fmt::format("{:02}{:02}{:02}", static_cast<unsigned>(day.day()), static_cast<unsigned>(day.month()),
                    static_cast<int>(day.year()) % 100));
  }
  const std::string& body() const { return body_; }

 private:
  void add(const std::string& field) { body_ += "," + field; }

  std::string body_;
};

/// Reads the same fields; good() is false once one was wrong.
class FieldReader {
 public:
  explicit FieldReader(const sim::NmeaSentence& sentence) : sentence_(sentence) {}
  bool good() const { return good_; }
  void number(Number& value, int /*decimals*/, double low, double high) {
    const std::string& text = next();
    value.reset();
    if (text.empty()) return;
    value = sim::read_number(text);
    require(value && *value >= low && *value <= high);  // false for NaN, too
  }
  void integer(int& value, int /*digits*/, int high) {
    const std::string& text = next();
    const auto number = text.empty() ? 0 : sim::exact_number<int>(text);
    require(number && *number >= 0 && *number <= high);
    value = number.value_or(0);
  }
  void letter(char& value, std::string_view allowed) {
    const std::string& text = next();
    if (text.empty()) return;  // keeps the default: a warning
    require(text.size() == 1 && allowed.find(text[0]) != std::string_view::npos);
    value = text[0];
  }
  void word(std::string& value) { value = next(); }
  void constant(std::string_view text) {
    const std::string& found = next();
    require(found.empty() || found == text);
  }
  void angle(Number& value_deg, int degree_digits, const char* letters) {
    const std::string text = next(), letter = next();
    value_deg.reset();
    if (text.empty()) return;
    const auto digits = static_cast<std::size_t>(degree_digits);
    const auto degrees = sim::exact_number<int>(text.substr(0, digits));
    const auto minutes = sim::read_number(text.size() > digits ? text.substr(digits) : "");
    const double largest_deg = degree_digits == 2 ? 90 : 180;
    if (!require(degrees && minutes && *degrees >= 0 && *minutes >= 0 && *minutes < 60)) return;
    value_deg = *degrees + *minutes / 60;
    require(*value_deg <= largest_deg && letter.size() == 1 && (letter[0] == letters[0] || letter[0] == letters[1]));
    if (good_ && letter[0] == letters[1]) value_deg = -*value_deg;
  }
  void signed_number(Number& value, int decimals, const char* letters) {
    number(value, decimals, 0, 180);
    const std::string& letter = next();
    if (value) require(letter.size() == 1 && (letter[0] == letters[0] || letter[0] == letters[1]));
    if (value && good_ && letter[0] == letters[1]) value = -*value;
  }
  void time_of_day(Utc& time) {
    const std::string& text = next();
    time.reset();
    if (text.empty()) return;
    const auto hours = two_digits(text, 0, 23), minutes = two_digits(text, 2, 59);
    const auto seconds = sim::read_number(text.size() > 4 ? text.substr(4) : "");
    if (!require(hours && minutes && seconds && *seconds >= 0 && *seconds < 61)) return;
    time = std::int64_t{*hours} * 3'600'000'000 + std::int64_t{*minutes} * 60'000'000 + std::llround(*seconds * 1e6);
  }
  /// Adds the days since 1970 to a time of day.  Two digits of a year are those of 1980 to 2079.
  void date(Utc& time) {
    const std::string& text = next();
    if (text.empty()) return;
    const auto day = two_digits(text, 0, 31), month = two_digits(text, 2, 12), year = two_digits(text, 4, 99);
    if (!require(text.size() == 6 && day && month && year)) return;
    const std::chrono::year_month_day date{std::chrono::year{*year + (*year < 80 ? 2000 : 1900)},
                                           std::chrono::month{static_cast<unsigned>(*month)},
                                           std::chrono::day{static_cast<unsigned>(*day)}};
    if (!require(date.ok()) || !time) return;
    *time += std::int64_t{std::chrono::sys_days{date}.time_since_epoch().count()} * day_us;
  }

 private:
  const std::string& next() { return sentence_.at(++at_); }
  bool require(bool condition) {
    good_ &= condition;
    return good_;
  }
  static std::optional<int> two_digits(const std::string& text, std::size_t at, int high) {
    if (text.size() < at + 2 || text[at] < '0') return {};
    const auto number = sim::exact_number<int>(text.substr(at, 2));
    return number && *number <= high ? number : std::nullopt;
  }

  const sim::NmeaSentence& sentence_;
  std::size_t at_ = 0;
  bool good_ = true;
};

constexpr double most = 1e6;

// The fields of each sentence, in their order: once for both directions.  `S` is const for a writer.
template <class Io, class S>
void fields(Io& io, S& s, const Rmc*) {
  io.time_of_day(s.time);
  io.letter(s.status, "AV");
  io.angle(s.latitude_deg, 2, "NS");
  io.angle(s.longitude_deg, 3, "EW");
  io.number(s.speed_kn, 2, 0, most);
  io.number(s.course_deg, 1, 0, 360);
  io.date(s.time);
  io.signed_number(s.variation_deg, 1, "EW");
  io.letter(s.mode, "ADENMSRFP");
}

template <class Io, class S>
void fields(Io& io, S& s, const Gga*) {
  io.time_of_day(s.time);
  io.angle(s.latitude_deg, 2, "NS");
  io.angle(s.longitude_deg, 3, "EW");
  io.integer(s.quality, 1, 8);
  io.integer(s.satellites, 2, 99);
  io.number(s.hdop, 1, 0, most);
  io.number(s.altitude_m, 2, -most, most);
  io.constant("M");
  io.number(s.geoid_m, 1, -most, most);
  io.constant("M");
  io.constant("");  // age and station of a differential correction
  io.constant("");
}

template <class Io, class S>
void fields(Io& io, S& s, const Hdt*) {
  io.number(s.heading_deg, 1, 0, 360);
  io.constant("T");
}

template <class Io, class S>
void fields(Io& io, S& s, const Vtg*) {
  io.number(s.course_deg, 1, 0, 360);
  io.constant("T");
  io.number(s.magnetic_course_deg, 1, 0, 360);
  io.constant("M");
  io.number(s.speed_kn, 2, 0, most);
  io.constant("N");
  io.number(s.speed_kmph, 2, 0, most);
  io.constant("K");
  io.letter(s.mode, "ADENMSRFP");
}

template <class Io, class S>
void fields(Io& io, S& s, const Vhw*) {
  io.number(s.heading_deg, 1, 0, 360);
  io.constant("T");
  io.number(s.magnetic_heading_deg, 1, 0, 360);
  io.constant("M");
  io.number(s.speed_kn, 2, -most, most);
  io.constant("N");
  io.number(s.speed_kmph, 2, -most, most);
  io.constant("K");
}

template <class Io, class S>
void fields(Io& io, S& s, const Dbt*) {
  io.number(s.depth_ft, 1, 0, most);
  io.constant("f");
  io.number(s.depth_m, 2, 0, most);
  io.constant("M");
  io.number(s.depth_fathoms, 1, 0, most);
  io.constant("F");
}

template <class Io, class S>
void fields(Io& io, S& s, const Dpt*) {
  io.number(s.depth_m, 2, 0, most);
  io.number(s.offset_m, 2, -most, most);
}

template <class Io, class S>
void fields(Io& io, S& s, const Mwv*) {
  io.number(s.angle_deg, 1, 0, 360);
  io.letter(s.reference, "RT");
  io.number(s.speed, 1, 0, most);
  io.letter(s.unit, "NMKS");
  io.letter(s.status, "AV");
}

template <class Io, class S>
void fields(Io& io, S& s, const Rot*) {
  io.number(s.degpmin, 1, -most, most);
  io.letter(s.status, "AV");
}

template <class Io, class S>
void fields(Io& io, S& s, const Xdr*) {
  io.letter(s.kind, "APCDNFGHLRSTUV");
  io.number(s.value, 2, -1e9, 1e9);
  io.letter(s.unit, "DPBCMNKHRSVUL");
  io.word(s.name);
}

template <class Io, class S>
void fields(Io& io, S& s, const Apb*) {
  io.letter(s.status, "AV");
  io.letter(s.lock, "AV");
  io.number(s.cross_track_nmi, 3, 0, most);
  io.letter(s.steer, "LR");
  io.letter(s.cross_track_unit, "NK");
  io.letter(s.arrived, "AV");
  io.letter(s.passed, "AV");
  io.number(s.origin_bearing_deg, 1, 0, 360);
  io.letter(s.origin_reference, "TM");
  io.word(s.waypoint);
  io.number(s.bearing_deg, 1, 0, 360);
  io.letter(s.bearing_reference, "TM");
  io.number(s.heading_deg, 1, 0, 360);
  io.letter(s.heading_reference, "TM");
}

template <class Io, class S>
void fields(Io& io, S& s, const Rmb*) {
  io.letter(s.status, "AV");
  io.number(s.cross_track_nmi, 3, 0, most);
  io.letter(s.steer, "LR");
  io.word(s.origin);
  io.word(s.waypoint);
  io.angle(s.latitude_deg, 2, "NS");
  io.angle(s.longitude_deg, 3, "EW");
  io.number(s.range_nmi, 3, 0, most);
  io.number(s.bearing_deg, 1, 0, 360);
  io.number(s.closing_kn, 1, -most, most);
  io.letter(s.arrived, "AV");
  io.letter(s.mode, "ADENMSRFP");
}

}  // namespace

template <class Sentence>
std::string format(const Sentence& sentence, std::string_view talker) {
  FieldWriter writer(std::string(talker) + std::string(Sentence::type));
  fields(writer, sentence, static_cast<const Sentence*>(nullptr));
  return sim::nmea_sentence(writer.body());
}

template <class Sentence>
std::optional<Sentence> read(const sim::NmeaSentence& sentence) {
  Sentence read;
  FieldReader reader(sentence);
  fields(reader, read, static_cast<const Sentence*>(nullptr));
  return reader.good() ? std::optional(std::move(read)) : std::nullopt;
}

#define SHOAL_NMEA_SENTENCE(Sentence)                             \
  template std::string format(const Sentence&, std::string_view); \
  template std::optional<Sentence> read(const sim::NmeaSentence&)
SHOAL_NMEA_SENTENCE(Rmc);
SHOAL_NMEA_SENTENCE(Gga);
SHOAL_NMEA_SENTENCE(Hdt);
SHOAL_NMEA_SENTENCE(Vtg);
SHOAL_NMEA_SENTENCE(Vhw);
SHOAL_NMEA_SENTENCE(Dbt);
SHOAL_NMEA_SENTENCE(Dpt);
SHOAL_NMEA_SENTENCE(Mwv);
SHOAL_NMEA_SENTENCE(Rot);
SHOAL_NMEA_SENTENCE(Xdr);
SHOAL_NMEA_SENTENCE(Apb);
SHOAL_NMEA_SENTENCE(Rmb);
#undef SHOAL_NMEA_SENTENCE

}  // namespace bridges::nmea
