// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace bridges {

/// Message of a page: the fields that the server understands.
struct ClientMessage {
  std::string op;                         ///< kind: 1 to 32 characters a-z and `_`
  std::string token;                      ///< of `hello`; empty: none
  std::optional<std::uint32_t> sequence;  ///< of `ack`
  std::string id;                         ///< key `id` as JSON, for the reply: a number or a text; else `null`
};

/// Reads a message.  Throws WebError with the reason if it is not a JSON object nested at most 16 deep, or a key that
/// the server needs is missing or has another type.
ClientMessage parse_client_message(std::string_view text);
/// Returns the message `{"op":"error","text":...}`.
std::string error_message(std::string_view text);
/// Returns the message `{"op":"reply","id":...,"ok":false,"text":...}`.  `id`: as in ClientMessage.
std::string refusal_message(const std::string& id, std::string_view text);
/// Returns the object with its key `control` set.  Throws WebError if `json` is not a JSON object.
std::string with_control(const std::string& json, bool control);

}  // namespace bridges
