// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/foxglove/foxglove_text.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <nlohmann/json.hpp>

#include "bridges/base/json_text.hpp"
#include "bridges/foxglove/foxglove_services.hpp"

namespace bridges::foxglove {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t us_per_s = 1'000'000, ns_per_us = 1000;

Json time_json(std::int64_t utime) {
  const std::int64_t us = std::max<std::int64_t>(0, utime);
  return {{"sec", us / us_per_s}, {"nsec", us % us_per_s * ns_per_us}};
}

std::uint64_t ns_of(std::int64_t utime) {
  return static_cast<std::uint64_t>(
      std::clamp<std::int64_t>(utime, 0, std::numeric_limits<std::int64_t>::max() / ns_per_us) * ns_per_us);
}

/// Writer of a binary message.
class BinaryWriter {
 public:
  BinaryWriter(std::uint8_t opcode, std::size_t size) {
    static_assert(std::endian::native == std::endian::little);
    bytes_.reserve(1 + size);
    number(opcode);
  }
  template <class T>
  void number(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void bytes(std::string_view bytes) { bytes_.append(bytes); }
  void text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    bytes(text);
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

Json part_json(const Service& service, const char* part, const std::string& schema) {
  return {{"encoding", "cdr"},
          {"schemaName", std::string(service.type) + "_" + part},
          {"schemaEncoding", "ros2msg"},
          {"schema", schema}};
}

}  // namespace

std::string server_info_text(const ServerInfo& info) {
  Json capabilities = Json::array({"time"});
  if (info.control == Control::run)
    for (const char* each : {"services", "parameters", "parametersSubscribe"}) capabilities.push_back(each);
  if (info.control == Control::playback) capabilities.push_back("playbackControl");
  Json metadata = Json::object();
  for (const auto& [key, value] : info.metadata) metadata[key] = value;
  Json message{{"op", "serverInfo"},
               {"name", info.name},
               {"capabilities", std::move(capabilities)},
               {"supportedEncodings", info.control == Control::run ? Json::array({"cdr", "json"}) : Json::array()},
               {"metadata", std::move(metadata)},
               {"sessionId", info.session}};
  if (info.control == Control::playback) {
    message["dataStartTime"] = time_json(info.start_us);
    message["dataEndTime"] = time_json(info.end_us);
  }
  return json_text(message);
}

std::string status_text(StatusLevel level, std::string_view message, std::string_view id) {
  Json json{{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}};
  if (!id.empty()) json["id"] = id;
  return json_text(json);
}

std::string advertise_text(std::span<const ros2::Topic* const> topics) {
  Json channels = Json::array();
  for (const ros2::Topic* topic : topics) {
    Json channel{{"id", topic->number},       {"topic", topic->name},        {"encoding", topic->encoding},
                 {"schemaName", topic->type}, {"schemaEncoding", "ros2msg"}, {"schema", topic->schema}};
    if (!topic->lcm_channel.empty()) channel["metadata"]["lcm_channel"] = topic->lcm_channel;
    if (!topic->lcm_type.empty()) channel["metadata"]["lcm_type"] = topic->lcm_type;
    channels.push_back(std::move(channel));
  }
  return json_text({{"op", "advertise"}, {"channels", std::move(channels)}});
}

std::string advertise_services_text() {
  Json all = Json::array();
  for (const Service& each : services())
    all.push_back({{"id", each.id},
                   {"name", each.name},
                   {"type", each.type},
                   {"request", part_json(each, "Request", request_schema(each))},
                   {"response", part_json(each, "Response", response_schema)}});
  return json_text({{"op", "advertiseServices"}, {"services", std::move(all)}});
}

std::string service_failure_text(std::uint32_t service, std::uint32_t call, std::string_view message) {
  return json_text({{"op", "serviceCallFailure"}, {"serviceId", service}, {"callId", call}, {"message", message}});
}

std::string parameters_text(const PlaybackState& state, const std::vector<std::string>& names,
                            const std::optional<std::string>& id) {
  const auto is_asked_for = [&](const char* name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  };
  Json parameters = Json::array();
  if (is_asked_for("paused"))
    parameters.push_back({{"name", "paused"}, {"value", state.status != PlaybackState::Status::playing}});
  if (is_asked_for("speed")) parameters.push_back({{"name", "speed"}, {"value", state.speed}, {"type", "float64"}});
  Json message{{"op", "parameterValues"}, {"parameters", std::move(parameters)}};
  if (id) message["id"] = *id;
  return json_text(message);
}

std::string message_data(std::uint32_t subscription, std::int64_t utime, std::string_view payload) {
  BinaryWriter out(1, sizeof subscription + sizeof utime + payload.size());
  out.number(subscription);
  out.number(ns_of(utime));
  out.bytes(payload);
  return out.take();
}

std::string time_data(std::int64_t utime) {
  BinaryWriter out(2, sizeof utime);
  out.number(ns_of(utime));
  return out.take();
}

std::string service_response_data(std::uint32_t service, std::uint32_t call, std::string_view encoding,
                                  std::string_view payload) {
  BinaryWriter out(3, 3 * sizeof service + encoding.size() + payload.size());
  out.number(service);
  out.number(call);
  out.text(encoding);
  out.bytes(payload);
  return out.take();
}

std::string playback_data(const PlaybackState& state, bool did_seek, std::string_view request_id) {
  constexpr std::size_t fixed_bytes = 18;
  BinaryWriter out(5, fixed_bytes + request_id.size());
  out.number(static_cast<std::uint8_t>(state.status));
  out.number(ns_of(state.now_us));
  out.number(static_cast<float>(state.speed));
  out.number(static_cast<std::uint8_t>(did_seek));
  out.text(request_id);
  return out.take();
}

}  // namespace bridges::foxglove
