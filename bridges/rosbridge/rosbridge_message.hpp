// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace bridges::rosbridge {

/// Maximum size of a message of a client.
inline constexpr std::size_t max_client_message_bytes = std::size_t{1} << 20;

/// Severity of a `status`, and the least that a client gets.
enum class Level { error, warning, info, none };

/// Message of a client: the fields that the server understands, by the specification of rosbridge v2.
struct ClientMessage {
  std::string op;                     ///< kind, 1 to 64 bytes
  std::string id;                     ///< text to be returned; empty: none
  std::string topic;                  ///< with its leading slash
  std::string type;                   ///< of the topic, without `msg`, such as `sensor_msgs/Imu`; empty: not given
  std::int64_t throttle_rate_ms = 0;  ///< of `subscribe`: least interval of messages
  std::size_t queue_length = 0;       ///< of `subscribe`: messages that may wait; 0: no limit of its own
  std::string compression = "none";   ///< of `subscribe`
  std::string service;                ///< with its leading slash
  nlohmann::json args;                ///< of `call_service`: an object or a list
  nlohmann::json msg;                 ///< of `publish`: an object
  Level level = Level::warning;       ///< of `set_level`
};

/// Reads a message.  Throws WebError with the key and the rule if it is not a JSON object nested at most 16 deep, or if
/// a key that its `op` needs is missing, has another type, or too long a value.
ClientMessage parse_message(std::string_view text);

/// Returns a `status`, to the message with this id; empty: to none.
std::string status_text(Level level, std::string_view message, std::string_view id = {});
/// Returns the answer to a call: its values if it was carried out, else a text that says why not.
std::string service_response_text(std::string_view service, std::string_view id, bool ok, nlohmann::json values);

}  // namespace bridges::rosbridge
