// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/rosbridge_message.hpp"

#include <algorithm>
#include <array>

#include "bridges/base/json_text.hpp"
#include "bridges/rosbridge/ros_json.hpp"
#include "bridges/web/client_json.hpp"
#include "bridges/web/web_error.hpp"

namespace bridges::rosbridge {
namespace {

using Json = nlohmann::json;

constexpr std::size_t max_text = 256, max_op = 64;
constexpr std::int64_t max_throttle_ms = 3'600'000, max_queue_length = 1'000'000;

constexpr std::array<std::string_view, 4> level_words{"error", "warning", "info", "none"};  // by Level

/// Returns the text of a key; empty if there is none, which a `required` key must have.
std::string text_at(const Json& message, const char* key, bool required = false, std::size_t limit = max_text) {
  const auto value = message.find(key);
  const bool missing = value == message.end() || value->is_null();
  if (missing && !required) return "";
  if (missing || !value->is_string() || value->get_ref<const std::string&>().size() > limit ||
      (required && value->get_ref<const std::string&>().empty()))
    throw WebError(std::string("'") + key + "' must be a text of " + (required ? "1" : "0") + " to " +
                   std::to_string(limit) + " bytes");
  return value->get<std::string>();
}

/// Returns the number of a key, 0 if there is none.  Clients write whole numbers as fractions too.
std::int64_t number_at(const Json& message, const char* key, std::int64_t limit) {
  const auto value = message.find(key);
  if (value == message.end() || value->is_null()) return 0;
  const double number = value->is_number() ? value->get<double>() : -1;
  if (!(number >= 0 && number <= static_cast<double>(limit)))
    throw WebError(std::string("'") + key + "' must be a number from 0 to " + std::to_string(limit) + ", got " +
                   json_text(*value).substr(0, 40));
  return static_cast<std::int64_t>(number);
}

std::string name_at(const Json& message, const char* key) {
  const std::string name = text_at(message, key, true);
  return name.starts_with('/') ? name : "/" + name;
}

Level level_at(const Json& message) {
  const auto* const word = std::find(level_words.begin(), level_words.end(), text_at(message, "level", true));
  if (word == level_words.end()) throw WebError("'level' must be error, warning, info or none");
  return static_cast<Level>(word - level_words.begin());
}

/// Reads what the operation needs.
void read_fields(const Json& message, ClientMessage& result) {
  const std::string& op = result.op;
  if (op == "subscribe" || op == "unsubscribe" || op == "advertise" || op == "unadvertise" || op == "publish")
    result.topic = name_at(message, "topic");
  if (op == "subscribe" || op == "advertise") result.type = short_name(text_at(message, "type", op == "advertise"));
  if (op == "subscribe") {
    result.throttle_rate_ms = number_at(message, "throttle_rate", max_throttle_ms);
    result.queue_length = static_cast<std::size_t>(number_at(message, "queue_length", max_queue_length));
    if (message.contains("compression")) result.compression = text_at(message, "compression");
  } else if (op == "publish") {
    result.msg = message.contains("msg") ? message["msg"] : Json::object();
  } else if (op == "call_service") {
    result.service = name_at(message, "service");
    result.args = message.contains("args") ? message["args"] : Json::object();
  } else if (op == "set_level") {
    result.level = level_at(message);
  }
}

}  // namespace

ClientMessage parse_message(std::string_view text) {
  const Json message = parse_client_json(text);
  ClientMessage result;
  result.op = text_at(message, "op", true, max_op);
  // Some clients number their calls
  if (const auto id = message.find("id"); id != message.end() && id->is_number())
    result.id = json_text(*id);
  else
    result.id = text_at(message, "id");
  read_fields(message, result);
  return result;
}

std::string status_text(Level level, std::string_view message, std::string_view id) {
  Json json{{"op", "status"}, {"level", level_words.at(static_cast<std::size_t>(level))}, {"msg", message}};
  if (!id.empty()) json["id"] = id;
  return json_text(json);
}

std::string service_response_text(std::string_view service, std::string_view id, bool ok, Json values) {
  Json json{{"op", "service_response"}, {"service", service}, {"values", std::move(values)}, {"result", ok}};
  if (!id.empty()) json["id"] = id;
  return json_text(json);
}

}  // namespace bridges::rosbridge
