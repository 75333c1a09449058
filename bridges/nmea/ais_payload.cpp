// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/ais_payload.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "sim/nmea/nmea.hpp"

namespace bridges::nmea {

namespace {

constexpr double not_available = std::numeric_limits<double>::quiet_NaN();
constexpr double knot_mps = 1852.0 / 3600;
constexpr double degree_rad = std::numbers::pi / 180;

/// Rate of turn in the indicator of a message: 4.733 sqrt(degrees per minute), with the sign of the rate; 126 from 708
/// degrees per minute on (M.1371-5, table 48).
int turn_indicator(double turn_radps) {
  const double degpmin = std::clamp(turn_radps / degree_rad * 60, -708.0, 708.0);
  return static_cast<int>(std::lround(std::copysign(4.733 * std::sqrt(std::abs(degpmin)), degpmin)));
}

double turn_radps(std::int64_t indicator) {
  const double root = static_cast<double>(indicator) / 4.733;
  return std::copysign(root * root, root) / 60 * degree_rad;
}

/// Appends bits to six-bit characters.
class BitWriter {
 public:
  void bits(std::uint64_t value, int count) {
    for (int i = count - 1; i >= 0; --i) {
      if (used_ % 6 == 0) sixes_.push_back(0);
      sixes_.back() = static_cast<char>(sixes_.back() | ((value >> i & 1) << (5 - used_ % 6)));
      ++used_;
    }
  }
  template <class Integer>
  void integer(Integer value, int count) {
    const std::int64_t highest = (std::int64_t{1} << count) - 1;
    bits(static_cast<std::uint64_t>(std::clamp<std::int64_t>(value, 0, highest)), count);
  }
  /// A quantity in steps of `step`; `none` without one.
  void steps(double value, double step, int count, std::int64_t none, std::int64_t highest) {
    const double steps = std::clamp(value / step, -1e9, static_cast<double>(highest));
    bits(static_cast<std::uint64_t>(std::isfinite(value) ? std::llround(steps) : none), count);
  }
  void angle(double value_rad, double step_deg, int count, std::int64_t none) {
    double turns = value_rad / (2 * std::numbers::pi);
    turns -= std::floor(turns);
    const auto whole = std::llround(360 / step_deg);
    bits(static_cast<std::uint64_t>(std::isfinite(value_rad) ? std::llround(turns * static_cast<double>(whole)) % whole
                                                             : none),
         count);
  }
  void turn(double value_radps) {
    bits(static_cast<std::uint64_t>(std::isfinite(value_radps) ? turn_indicator(value_radps) : -128), 8);
  }
  void text(const std::string& value, int characters) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(characters); ++i)
      bits(i < value.size() ? six_bit(value[i]) : 0, 6);
  }
  void spare(std::uint64_t value, int count) { bits(value, count); }

  /// The characters of a sentence: 0 to 39 from `0`, 40 to 63 from a grave accent on.
  std::string characters() const {
    std::string text;
    for (const char six : sixes_) text.push_back(static_cast<char>(six + (six < 40 ? 48 : 56)));
    return text;
  }

 private:
  /// `@` to `_` are 0 to 31, blank to `?` 32 to 63; lower case becomes upper case, what there is not a blank.
  static std::uint64_t six_bit(char c) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
    if (c >= 64 && c < 96) return static_cast<std::uint64_t>(c - 64);
    return c >= 32 && c < 64 ? static_cast<std::uint64_t>(c) : 32;
  }

  std::string sixes_;
  int used_ = 0;
};

/// Reads the same fields.
class BitReader {
 public:
  /// Throws nothing: good() is false for characters that are none of a payload.
  explicit BitReader(std::string_view payload) {
    for (const char c : payload) {
      const int six = c >= 48 && c < 88 ? c - 48 : c >= 96 && c < 120 ? c - 56 : -1;
      good_ &= six >= 0;
      sixes_.push_back(static_cast<char>(six));
    }
  }
  bool good() const { return good_; }
  std::uint64_t next(int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i, ++at_) {
      const std::size_t place = at_ / 6;
      if (place >= sixes_.size()) good_ = false;
      const int bit = good_ ? sixes_[place] >> (5 - at_ % 6) & 1 : 0;
      value = value << 1 | static_cast<std::uint64_t>(bit);
    }
    return value;
  }
  template <class Integer>
  void integer(Integer& value, int count) {
    value = static_cast<Integer>(next(count));
  }
  void steps(double& value, double step, int count, std::int64_t none, std::int64_t /*highest*/) {
    // Positions have a sign; the most negative number that their bits hold is none.
    std::int64_t steps = static_cast<std::int64_t>(next(count));
    if (count > 20 && (steps >> (count - 1)) != 0) steps -= std::int64_t{1} << count;
    value = steps == none ? not_available : static_cast<double>(steps) * step;
  }
  void angle(double& value_rad, double step_deg, int count, std::int64_t none) {
    const auto steps = static_cast<std::int64_t>(next(count));
    value_rad = steps >= none ? not_available : static_cast<double>(steps) * step_deg * degree_rad;
  }
  void turn(double& value_radps) {
    const auto indicator = static_cast<std::int8_t>(next(8));
    value_radps = indicator == -128 ? not_available : turn_radps(indicator);
  }
  void text(std::string& value, int characters) {
    value.clear();
    for (int i = 0; i < characters; ++i) {
      const auto six = next(6);
      value.push_back(static_cast<char>(six < 32 ? six + 64 : six));
    }
    value.resize(std::min(value.find('@'), value.size()));  // the end of the text
    value.resize(value.find_last_not_of(' ') + 1);
  }
  /// Some stations leave out the last spare bits.
  void spare(std::uint64_t /*value*/, int count) { at_ += static_cast<std::size_t>(count); }

 private:
  std::string sixes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

constexpr double minute_step_deg = 1.0 / 600'000;  // of latitude and longitude: 1/10000 of a minute

// The fields of each type, in their order, once for both directions.  `M` is const for a writer.
template <class Io, class M>
void begin(Io& io, M& m) {
  io.integer(m.type, 6);
  io.spare(0, 2);  // repeat indicator
  io.integer(m.mmsi, 30);
}

template <class Io, class M>
void place(Io& io, M& m, int utc_second) {
  io.steps(m.longitude, minute_step_deg, 28, 181 * 600'000, 180 * 600'000);
  io.steps(m.latitude, minute_step_deg, 27, 91 * 600'000, 90 * 600'000);
  io.angle(m.course_rad, 0.1, 12, 3600);
  io.angle(m.heading_rad, 1, 9, 511);
  io.spare(static_cast<std::uint64_t>(utc_second), 6);
}

template <class Io, class M>
void sides(Io& io, M& m) {
  io.integer(m.bow_m, 9);
  io.integer(m.stern_m, 9);
  io.integer(m.port_m, 6);
  io.integer(m.starboard_m, 6);
}

template <class Io, class M>
void position_of_class_a(Io& io, M& m, int utc_second) {
  begin(io, m);
  io.integer(m.status, 4);
  io.turn(m.turn_radps);
  io.steps(m.speed_mps, 0.1 * knot_mps, 10, 1023, 1022);
  io.spare(1, 1);  // accurate within 10 m
  place(io, m, utc_second);
  io.spare(0, 2 + 3 + 1);  // special maneuver, spare, integrity monitoring
  io.spare(0, 19);         // state of the slots
}

template <class Io, class M>
void static_data_of_class_a(Io& io, M& m) {
  begin(io, m);
  io.spare(2, 2);  // version of the standard: M.1371-5
  io.integer(m.imo, 30);
  io.text(m.call_sign, 7);
  io.text(m.name, 20);
  io.integer(m.ship_type, 8);
  sides(io, m);
  io.spare(1, 4);                  // position by GPS
  io.spare(24 << 6 | 60, 4 + 16);  // arrival: month 0, day 0, hour 24, minute 60 mean none
  io.steps(m.draught_m, 0.1, 8, 0, 255);
  io.text(m.destination, 20);
  io.spare(0, 2);
}

template <class Io, class M>
void position_of_class_b(Io& io, M& m, int utc_second) {
  begin(io, m);
  io.spare(0, 8);
  io.steps(m.speed_mps, 0.1 * knot_mps, 10, 1023, 1022);
  io.spare(1, 1);
  place(io, m, utc_second);
  // Carrier sense, no display, no digital selective calling, the whole marine band, message 22, autonomous.
  io.spare(0, 2);
  io.spare(0b1001100, 7);
  io.spare(0b11100000000000000110, 20);  // state of the slots: constant for carrier sense
}

template <class Io, class M>
void static_data_of_class_b(Io& io, M& m) {
  begin(io, m);
  io.integer(m.part, 2);
  if (m.part == 0) {
    io.text(m.name, 20);
    io.spare(0, 8);
    return;
  }
  io.integer(m.ship_type, 8);
  io.spare(0, 42);  // vendor
  io.text(m.call_sign, 7);
  sides(io, m);
  io.spare(1, 4);
  io.spare(0, 2);
}

template <class Io, class M>
bool fields(Io& io, M& m, int type, int utc_second) {
  if (type == 1) position_of_class_a(io, m, utc_second);
  if (type == 5) static_data_of_class_a(io, m);
  if (type == 18) position_of_class_b(io, m, utc_second);
  if (type == 24) static_data_of_class_b(io, m);
  return type == 1 || type == 5 || type == 18 || type == 24;
}

}  // namespace

std::string ais_payload(const shoal::ais_t& message, int utc_second) {
  BitWriter writer;
  return fields(writer, message, message.type, utc_second) ? writer.characters() : "";
}

std::optional<shoal::ais_t> read_ais_payload(std::string_view payload) {
  shoal::ais_t message{};
  for (double* number : {&message.latitude, &message.longitude, &message.speed_mps, &message.course_rad,
                         &message.heading_rad, &message.turn_radps, &message.draught_m})
    *number = not_available;
  if (payload.empty()) return {};
  const auto type = static_cast<int>(BitReader(payload.substr(0, 1)).next(6));
  BitReader reader(payload);
  if (!fields(reader, message, type, 0) || !reader.good()) return {};
  return message;
}

std::vector<std::string> ais_sentences(const shoal::ais_t& message, int utc_second, int group) {
  // A sentence has at most 82 characters with its line end: 60 remain for the payload.
  constexpr std::size_t longest = 60;
  const std::string payload = ais_payload(message, utc_second);
  const std::size_t count = (payload.size() + longest - 1) / longest;
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < count; ++i) {
    const bool last = i + 1 == count;
    const std::size_t bits = message.type == 5 ? 424 : 168;
    const std::size_t fill = last ? payload.size() * 6 - bits : 0;  // the bits that complete the last character
    sentences.push_back(sim::nmea_sentence(
        std::string(message.own ? "AIVDO" : "AIVDM") + "," + std::to_string(count) + "," + std::to_string(i + 1) + "," +
            (count > 1 ? std::to_string(group) : "") + "," + (message.radio_channel == 0 ? "A" : "B") + "," +
            payload.substr(i * longest, longest) + "," + std::to_string(fill),
        '!'));
  }
  return sentences;
}

}  // namespace bridges::nmea
