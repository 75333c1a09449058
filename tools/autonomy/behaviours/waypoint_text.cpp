// SPDX-License-Identifier: BSD-3-Clause
#include "tools/autonomy/behaviours/waypoint_text.hpp"

#include <charconv>
#include <stdexcept>

#include "sim/base/math.hpp"

namespace autonomy {

namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  for (std::size_t end = text.find(separator); end != std::string_view::npos; end = text.find(separator)) {
    pieces.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  pieces.push_back(text);
  return pieces;
}

double parse_number(std::string_view text) {
  const std::string_view shown = text;
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
    throw std::invalid_argument("'" + std::string(shown) + "' is not a number");
  return number;
}

}  // namespace

std::vector<double> parse_numbers(std::string_view text, std::size_t count, const char* form) {
  const std::vector<std::string_view> pieces = split(text, ',');
  if (pieces.size() != count) throw std::invalid_argument("'" + std::string(text) + "' is not of the form " + form);
  std::vector<double> numbers;
  for (const std::string_view piece : pieces) numbers.push_back(parse_number(piece));
  return numbers;
}

std::vector<Vector2d> parse_waypoints(const std::string& text) {
  std::vector<Vector2d> waypoints;
  for (const std::string_view each : split(text, ';')) {
    const std::vector<double> p = parse_numbers(each, 2, "x,y");
    waypoints.emplace_back(p[0], p[1]);
  }
  return waypoints;
}

Pose2 parse_start(const std::string& text) {
  const std::vector<double> p = parse_numbers(text, 3, "x,y,yaw_deg");
  return {{p[0], p[1]}, sim::wrap_angle(sim::degrees_to_radians(p[2]))};
}

}  // namespace autonomy
