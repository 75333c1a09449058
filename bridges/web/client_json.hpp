// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace bridges {

/// Reads a text message of a client.  Throws WebError with the reason if it is not a JSON object nested at most 16
/// deep.
nlohmann::json parse_client_json(std::string_view text);

}  // namespace bridges
