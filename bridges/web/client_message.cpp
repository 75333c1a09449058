// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/client_message.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "bridges/web/web_error.hpp"

namespace bridges {

namespace {

using Json = nlohmann::json;

constexpr int max_depth = 16;
constexpr std::size_t longest_op = 32, longest_id = 64, longest_token = 256;

Json parse_object(std::string_view text) {
  const auto check_depth = [](int depth, Json::parse_event_t event, Json& /*parsed*/) {
    const bool opens = event == Json::parse_event_t::object_start || event == Json::parse_event_t::array_start;
    if (opens && depth >= max_depth)
      throw WebError("message is nested more than " + std::to_string(max_depth) + " deep");
    return true;
  };
  try {
    Json message = Json::parse(text.begin(), text.end(), check_depth);
    if (!message.is_object()) throw WebError("message must be a JSON object, got " + std::string(message.type_name()));
    return message;
  } catch (const Json::parse_error& error) {
    throw WebError("message is not JSON: error at byte " + std::to_string(error.byte));
  } catch (const Json::exception&) {
    throw WebError("message is not JSON: a number is out of range");
  }
}

std::string op_of(const Json& message) {
  const auto op = message.find("op");
  if (op == message.end() || !op->is_string()) throw WebError("message must have a text 'op'");
  const auto& text = op->get_ref<const std::string&>();
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
  if (text.empty() || text.size() > longest_op || !plain) throw WebError("'op' must be 1 to 32 characters a-z or '_'");
  return text;
}

std::string token_of(const Json& message) {
  const auto token = message.find("token");
  if (token == message.end() || token->is_null()) return {};
  if (!token->is_string() || token->get_ref<const std::string&>().size() > longest_token)
    throw WebError("'token' of hello must be a text of at most 256 bytes");
  return token->get<std::string>();
}

std::uint32_t sequence_of(const Json& message) {
  const auto sequence = message.find("sequence");
  if (sequence == message.end() || !sequence->is_number_unsigned() ||
      sequence->get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    throw WebError("'sequence' of ack must be an integer from 0 to 4294967295");
  return sequence->get<std::uint32_t>();
}

std::string id_of(const Json& message) {
  const auto id = message.find("id");
  if (id == message.end() || !(id->is_number() || id->is_string())) return "null";
  const std::string text = id->dump();
  return text.size() <= longest_id ? text : "null";
}

}  // namespace

ClientMessage parse_client_message(std::string_view text) {
  const Json message = parse_object(text);
  ClientMessage result;
  result.op = op_of(message);
  if (result.op == "hello") result.token = token_of(message);
  if (result.op == "ack") result.sequence = sequence_of(message);
  result.id = id_of(message);
  return result;
}

std::string error_message(std::string_view text) {
  return Json{{"op", "error"}, {"text", text}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string refusal_message(const std::string& id, std::string_view text) {
  return Json{{"op", "reply"}, {"id", Json::parse(id)}, {"ok", false}, {"text", text}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

std::string with_control(const std::string& json, bool control) {
  Json message = parse_object(json);
  message["control"] = control;
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace bridges
