// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace bridges::foxglove {

/// Maximum size of a message of a client: it may subscribe to all topics of a large world at once.
inline constexpr std::size_t max_client_message_bytes = std::size_t{1} << 20;

/// Subscription of a client to a channel, by numbers.
struct Subscription {
  std::uint32_t id = 0;       ///< chosen by the client
  std::uint32_t channel = 0;  ///< of the server
};

/// Parameter with its value; none: to be removed.
struct Parameter {
  std::string name;
  std::variant<std::monostate, bool, double, std::string> value;
};

/// Text message of a client: the fields that the server understands.
struct ClientText {
  std::string op;                               ///< kind, 1 to 64 bytes
  std::vector<Subscription> subscriptions;      ///< of `subscribe`
  std::vector<std::uint32_t> subscription_ids;  ///< of `unsubscribe`
  std::vector<std::string> names;               ///< parameters of `getParameters`, `(un)subscribeParameterUpdates`
  std::vector<Parameter> parameters;            ///< of `setParameters`
  std::optional<std::string> id;                ///< of a request, to be returned; at most 256 bytes
};

/// Call of a service.
struct ServiceCall {
  std::uint32_t service = 0;  ///< number of the service
  std::uint32_t call = 0;     ///< chosen by the client
  std::string encoding;       ///< of the payload, at most 32 bytes
  std::string payload;        ///< request, in this encoding
};

/// Request of a client for the playback of a log.
struct PlaybackRequest {
  bool plays = false;                   ///< play, or pause
  double speed = 1;                     ///< 0.01 to 1000
  std::optional<std::int64_t> seek_us;  ///< UTC to show, us since 1970
  std::string id;                       ///< of the request, to be returned
};

/// Reads a text message.  Throws WebError if it is not a JSON object nested at most 16 deep, or a key that the server
/// needs is missing, has another type, or too many or too long values.
ClientText parse_text(std::string_view text);
/// Reads a binary message.  Throws WebError for an unknown opcode, one that is not permitted, or a wrong length.
std::variant<ServiceCall, PlaybackRequest> parse_binary(std::string_view bytes);

}  // namespace bridges::foxglove
