// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/client_json.hpp"

#include <string>

#include "bridges/web/web_error.hpp"

namespace bridges {

using Json = nlohmann::json;

Json parse_client_json(std::string_view text) {
  constexpr int max_depth = 16;
  const auto check_depth = [](int depth, Json::parse_event_t event, Json& /*parsed*/) {
    const bool opens = event == Json::parse_event_t::object_start || event == Json::parse_event_t::array_start;
    // A recursive parser would otherwise overflow its stack on a page's request.
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

}  // namespace bridges
