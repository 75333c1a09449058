// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/look_request.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bridges/base/json_text.hpp"

namespace viewer {

namespace {

using Json = nlohmann::json;

constexpr std::size_t longest_value = 40;

[[noreturn]] void refuse(const char* key, const char* rule, const Json& value) {
  throw std::runtime_error(std::string("look: '") + key + "' must be " + rule + ", got " +
                           bridges::json_text(value).substr(0, longest_value));
}

}  // namespace

LookRequest parse_look(std::string_view text) {
  const Json message = Json::parse(text, nullptr, false);
  if (!message.is_object()) throw std::runtime_error("look: must be a JSON object");
  LookRequest request;
  // The time; a page may compute one with a fraction.
  const auto time = message.find("time_us");
  if (time == message.end()) throw std::runtime_error("look: 'time_us' is missing");
  if (!time->is_null()) {
    constexpr double max_us = 1e18;
    const double value = time->is_number() ? time->get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (!(std::abs(value) <= max_us)) refuse("time_us", "null or a number from -1e18 to 1e18", *time);
    request.time_us = static_cast<std::int64_t>(std::floor(value));
  }
  // The branch.
  const auto branch = message.find("branch");
  if (branch == message.end() || branch->is_null()) return request;
  constexpr std::int64_t max_branch = std::numeric_limits<std::int32_t>::max();
  if (!branch->is_number_integer() || branch->get<double>() < 0 || branch->get<double>() > max_branch)
    refuse("branch", "the number of a branch", *branch);
  request.branch = branch->get<std::int32_t>();
  return request;
}

}  // namespace viewer
