// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/format_version.hpp"

#include <charconv>

namespace sim {

void read_format_version(ParamReader& in, int& version) {
  constexpr int known = 1;
  in.require("shoal");
  if (const ConfigNode* node = in.has("shoal") ? in.child("shoal") : nullptr) {
    int given = 0;
    const auto [end, error] = std::from_chars(node->scalar.data(), node->scalar.data() + node->scalar.size(), given);
    if (error == std::errc() && *end == '\0' && given > known)
      return in.error("shoal", "'shoal' must be 1, got " + std::to_string(given) + ": written for a newer Shoal");
  }
  in.read("shoal", version, between(known, known), "version of the file format");
}

}  // namespace sim
