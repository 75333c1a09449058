// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/page_request.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bridges/base/json_text.hpp"

namespace viewer {
namespace {

using Json = nlohmann::json;

constexpr std::size_t longest_channel = 63, longest_field = 256, longest_id = 64;
constexpr double largest_time_us = 1e18;

Json object_of(std::string_view text) {
  Json message = Json::parse(text, nullptr, false);
  if (!message.is_object()) throw PageRequestError("message must be a JSON object");
  return message;
}

std::string name_of(const Json& object, const char* key, std::size_t longest, const std::string& where) {
  const auto name = object.find(key);
  if (name == object.end() || !name->is_string() || name->get_ref<const std::string&>().empty() ||
      name->get_ref<const std::string&>().size() > longest)
    throw PageRequestError(where + ": '" + key + "' must be a text of 1 to " + std::to_string(longest) + " bytes");
  return name->get<std::string>();
}

double number_of(const Json& object, const char* key, const std::string& where) {
  const auto number = object.find(key);
  if (number == object.end() || !number->is_number() || !std::isfinite(number->get<double>()))
    throw PageRequestError(where + ": '" + key + "' must be a number");
  return number->get<double>();
}

std::int64_t time_of(const Json& object, const char* key) {
  return static_cast<std::int64_t>(std::clamp(number_of(object, key, "series"), -largest_time_us, largest_time_us));
}

Subscription subscription_of(const Json& item, std::size_t number) {
  const std::string where = "subscribe: channels[" + std::to_string(number) + "]";
  if (!item.is_object()) throw PageRequestError(where + " must be an object {name, rate_hz}");
  Subscription result;
  result.channel = name_of(item, "name", longest_channel, where);
  if (item.contains("rate_hz")) result.rate_hz = number_of(item, "rate_hz", where);
  if (!(result.rate_hz > 0 && result.rate_hz <= max_subscription_rate_hz))
    throw PageRequestError(where + ": 'rate_hz' must be above 0 and at most 30, got " + item["rate_hz"].dump());
  return result;
}

}  // namespace

std::vector<Subscription> parse_subscribe(std::string_view text) {
  const Json message = object_of(text);
  const auto channels = message.find("channels");
  if (channels == message.end() || !channels->is_array())
    throw PageRequestError("subscribe: 'channels' must be a list of {name, rate_hz}");
  if (channels->size() > max_subscriptions)
    throw PageRequestError("subscribe: at most " + std::to_string(max_subscriptions) + " channels for a page, got " +
                           std::to_string(channels->size()));
  std::vector<Subscription> result;
  for (const Json& item : *channels) {
    Subscription next = subscription_of(item, static_cast<std::size_t>(&item - &channels->front()));
    const auto same = std::find_if(result.begin(), result.end(),
                                   [&](const Subscription& other) { return other.channel == next.channel; });
    if (same == result.end())
      result.push_back(std::move(next));
    else
      *same = std::move(next);
  }
  return result;
}

SeriesRequest parse_series(std::string_view text) {
  const Json message = object_of(text);
  SeriesRequest result;
  result.id = request_id(text);
  result.channel = name_of(message, "channel", longest_channel, "series");
  result.field = name_of(message, "field", longest_field, "series");
  result.from_us = time_of(message, "from_us");
  result.to_us = time_of(message, "to_us");
  if (result.from_us > result.to_us)
    throw PageRequestError("series: 'from_us' " + std::to_string(result.from_us) + " is after 'to_us' " +
                           std::to_string(result.to_us));
  const double points = message.contains("points") ? number_of(message, "points", "series") : 1000;
  if (points < 2 || points > static_cast<double>(max_series_points) || points != std::floor(points))
    throw PageRequestError("series: 'points' must be an integer from 2 to 4000, got " + message["points"].dump());
  result.points = static_cast<std::size_t>(points);
  return result;
}

std::string request_id(std::string_view text) {
  const Json message = Json::parse(text, nullptr, false);
  if (!message.is_object()) return "null";
  const auto id = message.find("id");
  if (id == message.end() || !(id->is_number() || id->is_string())) return "null";
  const std::string json = bridges::json_text(*id);
  return json.size() <= longest_id ? json : "null";
}

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
