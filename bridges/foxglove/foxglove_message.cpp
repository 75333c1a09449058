// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/foxglove/foxglove_message.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "bridges/web/client_json.hpp"
#include "bridges/web/web_error.hpp"

namespace bridges::foxglove {
namespace {

using Json = nlohmann::json;

constexpr std::size_t max_items = 65'535;  // of a list
constexpr std::size_t max_names = 256;     // of parameters
constexpr std::size_t max_text = 256;
constexpr std::size_t max_op = 64;
constexpr std::size_t max_encoding = 32;

// --- Text

const Json& list_of(const Json& message, const char* key, std::size_t limit = max_items) {
  const auto list = message.find(key);
  if (list == message.end() || !list->is_array()) throw WebError(std::string("message must have a list '") + key + "'");
  if (list->size() > limit)
    throw WebError(std::string("'") + key + "' must have at most " + std::to_string(limit) + " items, got " +
                   std::to_string(list->size()));
  return *list;
}

std::uint32_t number_of(const Json& value, const char* key) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    throw WebError(std::string("'") + key + "' must have integers from 0 to 4294967295");
  return value.get<std::uint32_t>();
}

std::uint32_t number_at(const Json& item, const char* key) {
  if (!item.is_object() || !item.contains(key)) throw WebError(std::string("a subscription must have '") + key + "'");
  return number_of(item[key], key);
}

std::string text_of(const Json& value, const char* key, std::size_t limit = max_text) {
  if (!value.is_string() || value.get_ref<const std::string&>().size() > limit)
    throw WebError(std::string("'") + key + "' must be a text of at most " + std::to_string(limit) + " bytes");
  return value.get<std::string>();
}

Parameter parameter_of(const Json& item) {
  if (!item.is_object() || !item.contains("name")) throw WebError("a parameter must have a 'name'");
  Parameter parameter{text_of(item["name"], "name"), {}};
  const auto value = item.find("value");
  if (value == item.end() || value->is_null()) return parameter;
  if (value->is_boolean())
    parameter.value = value->get<bool>();
  else if (value->is_number())
    parameter.value = value->get<double>();
  else
    parameter.value = text_of(*value, "value");
  return parameter;
}

// --- Binary

/// Reader of little-endian numbers.
class BinaryReader {
 public:
  explicit BinaryReader(std::string_view bytes) : bytes_(bytes) {
    static_assert(std::endian::native == std::endian::little);
  }
  template <class T>
  T number() {
    T value{};
    const std::string_view bytes = take(sizeof value);
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  std::string text(std::size_t limit, const char* what) {
    const std::size_t size = number<std::uint32_t>();
    if (size > limit)
      throw WebError(std::string(what) + " must have at most " + std::to_string(limit) + " bytes, got " +
                     std::to_string(size));
    return std::string(take(size));
  }
  std::string rest() { return std::string(take(bytes_.size())); }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) throw WebError("binary message is too short");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  std::string_view bytes_;
};

ServiceCall service_call(BinaryReader& in) {
  ServiceCall call;
  call.service = in.number<std::uint32_t>();
  call.call = in.number<std::uint32_t>();
  call.encoding = in.text(max_encoding, "the encoding of a service call");
  call.payload = in.rest();
  return call;
}

PlaybackRequest playback_request(BinaryReader& in) {
  constexpr double lowest_speed = 0.01, highest_speed = 1000;
  // Playing and speed
  const auto command = in.number<std::uint8_t>();
  if (command > 1) throw WebError("playback command must be 0 (play) or 1 (pause), got " + std::to_string(command));
  PlaybackRequest request;
  request.plays = command == 0;
  request.speed = in.number<float>();
  if (!(request.speed >= lowest_speed && request.speed <= highest_speed))
    throw WebError("playback speed must be from 0.01 to 1000");

  // Time, which is always there
  const bool seeks = in.number<std::uint8_t>() != 0;
  const auto seek_ns = in.number<std::uint64_t>();
  if (seeks) request.seek_us = static_cast<std::int64_t>(seek_ns / 1000);
  request.id = in.text(max_text, "the id of a playback request");
  if (!in.at_end()) throw WebError("playback request is too long");
  return request;
}

}  // namespace

ClientText parse_text(std::string_view text) {
  const Json message = parse_client_json(text);
  ClientText result;
  const auto op = message.find("op");
  if (op == message.end()) throw WebError("message must have a text 'op'");
  result.op = text_of(*op, "op", max_op);
  if (const auto id = message.find("id"); id != message.end() && id->is_string()) result.id = text_of(*id, "id");
  // Only fields of the known operations are read: clients of newer protocol versions add others, which must not end
  // the connection.
  if (result.op == "subscribe") {
    for (const Json& item : list_of(message, "subscriptions"))
      result.subscriptions.push_back({number_at(item, "id"), number_at(item, "channelId")});
  } else if (result.op == "unsubscribe") {
    for (const Json& item : list_of(message, "subscriptionIds"))
      result.subscription_ids.push_back(number_of(item, "subscriptionIds"));
  } else if (result.op == "setParameters") {
    for (const Json& item : list_of(message, "parameters", max_names)) result.parameters.push_back(parameter_of(item));
  } else if (result.op == "getParameters" || result.op == "subscribeParameterUpdates" ||
             result.op == "unsubscribeParameterUpdates") {
    for (const Json& item : list_of(message, "parameterNames", max_names))
      result.names.push_back(text_of(item, "parameterNames"));
  }
  return result;
}

std::variant<ServiceCall, PlaybackRequest> parse_binary(std::string_view bytes) {
  constexpr std::uint8_t message_data = 1, service_request = 2, playback_control = 3;
  BinaryReader in(bytes);
  const auto opcode = in.number<std::uint8_t>();
  if (opcode == service_request) return service_call(in);
  if (opcode == playback_control) return playback_request(in);
  if (opcode == message_data) throw WebError("messages of clients are not accepted: use the services");
  throw WebError("unknown opcode " + std::to_string(opcode));
}

}  // namespace bridges::foxglove
