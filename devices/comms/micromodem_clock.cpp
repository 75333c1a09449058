// SPDX-License-Identifier: BSD-3-Clause
// Clock of a Micro-Modem: sentences that set and report it.
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "devices/comms/micromodem_protocol.hpp"

namespace devices {

namespace {

constexpr std::int64_t second_us = 1'000'000;

std::int64_t floor_second(std::int64_t utc_us) {
  return utc_us / second_us - (utc_us % second_us < 0 ? 1 : 0);
}

/// Converts a date; none when there is no such day.
std::optional<std::int64_t> utc_of(int year, int month, int day, int hour, int minute, int second) {
  using namespace std::chrono;
  const year_month_day date{std::chrono::year{year}, std::chrono::month{static_cast<unsigned>(month)},
                            std::chrono::day{static_cast<unsigned>(day)}};
  if (!date.ok()) return {};
  return microseconds(sys_days(date).time_since_epoch()).count() + second_us * (3600LL * hour + 60LL * minute + second);
}

/// Parses 2026-03-04T05:06:07Z, with up to six decimals; none for any other text.
std::optional<std::int64_t> read_iso_time(const std::string& text) {
  // Check the format.
  static constexpr std::string_view form = "dddd-dd-ddTdd:dd:dd";
  if (text.size() < form.size() + 1 || text.back() != 'Z') return {};
  for (std::size_t i = 0; i < form.size(); ++i) {
    const bool is_digit = text[i] >= '0' && text[i] <= '9';
    if (form[i] == 'd' ? !is_digit : text[i] != form[i]) return {};
  }
  const auto number = [&](std::size_t at, std::size_t digits) {
    int value = 0;
    std::from_chars(text.data() + at, text.data() + at + digits, value);
    return value;
  };
  // Read the time of day.
  const int hour = number(11, 2), minute = number(14, 2), second = number(17, 2);
  if (hour > 23 || minute > 59 || second > 60) return {};
  // Read the decimals of the second.
  std::string fraction = text.substr(form.size(), text.size() - form.size() - 1);
  if (!fraction.empty()) {
    const bool good = fraction.size() >= 2 && fraction.size() <= 7 && fraction[0] == '.' &&
                      fraction.find_first_not_of("0123456789", 1) == std::string::npos;
    if (!good) return {};
  }
  fraction.resize(7, '0');
  int micro = 0;
  std::from_chars(fraction.data() + 1, fraction.data() + 7, micro);
  const auto whole = utc_of(number(0, 4), number(5, 2), number(8, 2), hour, minute, second);
  if (!whole) return {};
  return *whole + micro;
}

/// Returns the time in ISO 8601 format, truncated to whole seconds.
std::string iso_time(std::int64_t utc_us) {
  const std::string day = nmea_date(utc_us), time = nmea_time_of_day(utc_us, 0);
  return day.substr(0, 4) + "-" + day.substr(4, 2) + "-" + day.substr(6) + "T" + time.substr(0, 2) + ":" +
         time.substr(2, 2) + ":" + time.substr(4) + "Z";
}

}  // namespace

std::array<int, 3> micromodem_generation(const std::string& revision) {
  std::array<int, 3> numbers{};
  // Anything after the numbers, such as a letter, does not count.
  const char* at = revision.data();
  const char* const end = at + revision.size();
  for (int& number : numbers) {
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc{}) break;
    at = next;
    if (at == end || *at != '.') break;
    ++at;
  }
  return numbers;
}

void MicromodemProtocol::set_utc(std::int64_t set_us, sim::Time now) {
  clock_offset_us_ = set_us - side_.utc_us(now);
  // With a pulse per second, only the number of the second is set.
  if (settings_.on("SNV"))
    clock_offset_us_ = std::llround(static_cast<double>(clock_offset_us_) / static_cast<double>(second_us)) * second_us;
  clock_set_ = true;
}

/// $CCCLK,yyyy,mm,dd,hh,mm,ss.
void MicromodemProtocol::set_clock(const sim::NmeaSentence& in, sim::Time now) {
  const auto year = in.number(1, 1970, 2200), month = in.number(2, 1, 12), day = in.number(3, 1, 31);
  const auto hour = in.number(4, 0, 23), minute = in.number(5, 0, 59), second = in.number(6, 0, 60);
  if (!year || !month || !day || !hour || !minute || !second)
    return error("NMEA", bad_field, "CLK needs yyyy mm dd hh mm ss", now);
  const auto set_us = utc_of(*year, *month, *day, *hour, *minute, *second);
  if (!set_us) return error("NMEA", bad_field, "no such day", now);
  set_utc(*set_us, now);
  side_.emit(echo(in, "CACLK"));
}

/// $CCTMS,time,mode: 0 at once, 1 with the next pulse.
void MicromodemProtocol::set_time(const sim::NmeaSentence& in, sim::Time now) {
  const auto set_us = read_iso_time(in.at(1));
  if (!set_us) return error("NMEA", bad_field, "TMS needs a time as 2026-01-31T23:59:59Z", now);
  const auto mode = in.number(2, 0, 1);
  if (!mode) return error("NMEA", bad_field, "mode of TMS must be 0 or 1", now);
  if (*mode == 1) {
    pulse_time_ = PulseTime{floor_second(side_.utc_us(now)), *set_us};
    return;
  }
  set_utc(*set_us, now);
  side_.emit("CATMS,0," + iso_time(*set_us));
}

void MicromodemProtocol::detect_pulse(sim::Time now) {
  if (!pulse_time_) return;
  const std::int64_t second = floor_second(side_.utc_us(now));
  if (second == pulse_time_->second) return;
  clock_offset_us_ = pulse_time_->set_us - second * second_us;
  clock_set_ = true;
  side_.emit("CATMS,0," + iso_time(pulse_time_->set_us));
  pulse_time_.reset();
}

/// $CCTMQ,0.
void MicromodemProtocol::query_time(const sim::NmeaSentence& in, sim::Time now) {
  if (!in.number(1, 0, 0)) return error("NMEA", bad_field, "TMQ needs a 0", now);
  side_.emit("CATMQ," + iso_time(utc_us(now)) + (clock_set_ ? ",USER_CMD," : ",NONE,") +
             (settings_.on("SNV") ? "EXT_PPS" : "RTC"));
}

int MicromodemProtocol::clock_mode() const {
  if (generation_ < micromodem_clock_bits) return (settings_.on("SNV") ? 2 : 0) + (clock_set_ ? 1 : 0);
  constexpr int set_by_command = 2, pulse_of_rtc = 1 << 2, pulse_from_outside = 3 << 2;
  return (clock_set_ ? set_by_command : 0) + (settings_.on("SNV") ? pulse_from_outside : pulse_of_rtc);
}

}  // namespace devices
