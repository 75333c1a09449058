// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace experiment {

/// Replaces `{run}` in a text by the name of the run, so that concurrent runs do not share a path.
inline std::string with_run_name(std::string text, const std::string& name) {
  static constexpr char key[] = "{run}";
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + name.size()))
    text.replace(at, sizeof key - 1, name);
  return text;
}

}  // namespace experiment
