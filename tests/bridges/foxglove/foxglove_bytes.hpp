// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include "bridges/foxglove/foxglove_message.hpp"
#include "bridges/web/web_error.hpp"

namespace foxglove_bytes {

using namespace bridges::foxglove;

template <class T>
std::string bytes_of_number(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

inline std::string text_bytes(const std::string& text) {
  return bytes_of_number(static_cast<std::uint32_t>(text.size())) + text;
}

template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const bridges::WebError& error) {
    return error.what();
  }
  return "";
}

}  // namespace foxglove_bytes
