// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace bridges {

/// Returns JSON on one line, or with so many blanks of `indent`.  Names in a world, or of a client, need not be UTF-8:
/// wrong bytes are replaced.
template <class Json = nlohmann::json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace bridges
