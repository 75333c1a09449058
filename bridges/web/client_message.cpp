// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/client_message.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "bridges/base/json_text.hpp"
#include "bridges/web/client_json.hpp"
#include "bridges/web/web_error.hpp"

namespace bridges {

namespace {

using Json = nlohmann::json;

constexpr std::size_t longest_op = 32, longest_id = 64, longest_token = 256;

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
  const Json message = parse_client_json(text);
  ClientMessage result;
  result.op = op_of(message);
  if (result.op == "hello") result.token = token_of(message);
  if (result.op == "ack") result.sequence = sequence_of(message);
  result.id = id_of(message);
  return result;
}

std::string error_message(std::string_view text) {
  return json_text({{"op", "error"}, {"text", text}});
}

std::string refusal_message(const std::string& id, std::string_view text) {
  return json_text({{"op", "reply"}, {"id", Json::parse(id)}, {"ok", false}, {"text", text}});
}

std::string with_control(const std::string& json, bool control) {
  Json message = parse_client_json(json);
  message["control"] = control;
  return json_text(message);
}

}  // namespace bridges
