// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/front_seat.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <numeric>

#include "sim/base/number.hpp"

namespace bridges {

namespace {

constexpr const char* line_end = "\r\n";

std::vector<std::string_view> fields_of(std::string_view text) {
  std::vector<std::string_view> fields;
  for (std::size_t end = 0; end != text.npos; text.remove_prefix(end == text.npos ? text.size() : end + 1)) {
    end = text.find(',');
    fields.push_back(text.substr(0, end));
  }
  return fields;
}

std::optional<double> finite_number(std::string_view text) {
  const auto number = sim::read_number(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

unsigned checksum_of(std::string_view body) {
  return std::accumulate(body.begin(), body.end(), 0U,
                         [](unsigned sum, char character) { return sum ^ static_cast<unsigned char>(character); });
}

std::string sentence_of(const std::string& body) {
  return fmt::format("${}*{:02X}{}", body, checksum_of(body), line_end);
}

/// Returns the body of `$BODY` or `$BODY*CHECKSUM`; none for a wrong checksum.
std::optional<std::string_view> body_of(std::string_view line) {
  if (!line.starts_with('$')) return std::nullopt;
  line.remove_prefix(1);
  const auto star = line.find('*');
  if (star == line.npos) return line;
  const std::string_view body = line.substr(0, star), sum = line.substr(star + 1);
  const bool agrees =
      sum == fmt::format("{:02X}", checksum_of(body)) || sum == fmt::format("{:02x}", checksum_of(body));
  return agrees ? std::optional(body) : std::nullopt;
}

/// UTC of the day as hhmmss.ss.
std::string time_of_day(std::int64_t utime) {
  const std::int64_t hundredths = utime / 10'000 % 8'640'000;
  return fmt::format("{:02}{:02}{:02}.{:02}", hundredths / 360'000, hundredths / 6000 % 60, hundredths / 100 % 60,
                     hundredths % 100);
}

/// Degrees and minutes with the hemisphere: `4221.5040,N`.
std::string angle_of(double degrees, int digits, char positive, char negative) {
  // Rounded first, so that no minute is 60.
  const auto units = static_cast<std::int64_t>(std::llround(std::abs(degrees) * 600'000));
  return fmt::format("{:0{}}{:02}.{:04},{}", units / 600'000, digits, units % 600'000 / 10'000, units % 10'000,
                     degrees < 0 ? negative : positive);
}

}  // namespace

FrontSeat::Reply GobyFrontSeat::take(std::string_view line, std::int64_t utime) {
  const std::vector<std::string_view> fields = fields_of(line);
  if (fields.front() == "START") {
    started_ = true;
    return {std::string("CTRL,STATE:PAYLOAD") + line_end, {}};
  }
  const std::string failed = std::string("CMD,RESULT:FAIL") + line_end;
  if (fields.front() != "CMD") return refuse();
  if (!started_) return refuse(failed);
  HelmSetPoints points;
  for (std::size_t i = 1; i < fields.size(); ++i) {
    const auto colon = fields[i].find(':');
    const std::string_view key = fields[i].substr(0, colon);
    double* const value = key == "HEADING" ? &points.heading_deg
                          : key == "SPEED" ? &points.speed_mps
                          : key == "DEPTH" ? &points.depth_m
                                           : nullptr;
    const auto number = colon == key.npos ? std::nullopt : finite_number(fields[i].substr(colon + 1));
    if (value == nullptr || !number) return refuse(failed);
    *value = *number;
  }
  return {std::string("CMD,RESULT:OK") + line_end, {helm_command(autopilot_, points, utime)}};
}

std::string GobyFrontSeat::state(const VehicleNavigation& navigation, std::int64_t) const {
  using enum NavField;
  if (!started_ || !navigation.has(latitude) || !navigation.has(heading)) return {};
  const auto known = [&](NavField field) { return navigation.has(field) ? navigation[field] : 0; };
  return fmt::format("NAV,LAT:{:.8f},LON:{:.8f},DEPTH:{:.3f},HEADING:{:.3f},SPEED:{:.3f}{}", navigation[latitude],
                     navigation[longitude], known(depth), navigation[heading], known(speed), line_end);
}

FrontSeat::Reply HeronFrontSeat::take(std::string_view line, std::int64_t utime) {
  const auto body = body_of(line);
  if (!body) return refuse();
  const std::vector<std::string_view> fields = fields_of(*body);
  if (fields.size() < 3 || fields.front() != "PYDIR") return refuse();
  const auto port = finite_number(fields[1]), starboard = finite_number(fields[2]);
  if (!port || !starboard) return refuse();
  return {{}, thruster_commands(thrusters_, *port, *starboard, utime)};
}

std::string HeronFrontSeat::state(const VehicleNavigation& navigation, std::int64_t utime) const {
  using enum NavField;
  if (!navigation.has(latitude) || !navigation.has(heading)) return {};
  const auto known = [&](NavField field) { return navigation.has(field) ? navigation[field] : 0; };
  const std::string time = time_of_day(utime);
  const double course_rad = yaw_rad_of(navigation[heading]);
  return sentence_of(fmt::format("CPNVG,{},{},{},1,0,{:.2f},{:.2f},{:.2f},{:.2f},{}", time,
                                 angle_of(navigation[latitude], 2, 'N', 'S'),
                                 angle_of(navigation[longitude], 3, 'E', 'W'), known(depth), navigation[heading],
                                 known(roll), known(pitch), time)) +
         // Velocity east, north and down.  A front seat knows the speed along its course, here along its heading.
         sentence_of(fmt::format("CPNVR,{},{:.3f},{:.3f},0,0,0,0", time, known(speed) * std::cos(course_rad),
                                 known(speed) * std::sin(course_rad))) +
         sentence_of(fmt::format("CPRCM,{},0,{:.2f},{:.2f},{:.2f},{}", time, navigation[heading], known(pitch),
                                 known(roll), time));
}

std::vector<std::string> LineReader::add(std::string_view bytes) {
  std::vector<std::string> lines;
  for (const char character : bytes) {
    if (character == '\n') {
      if (line_.ends_with('\r')) line_.pop_back();
      if (!line_.empty() && !too_long_) lines.push_back(line_);
      line_.clear();
      too_long_ = false;
    } else if (line_.size() < longest) {
      line_ += character;
    } else {
      too_long_ = true;
    }
  }
  return lines;
}

}  // namespace bridges
