#include "bridges/lcm/bus_reach.hpp"

#include <algorithm>
#include <string_view>

#include "bridges/lcm/lcm_connection.hpp"

namespace bridges {

namespace {

/// One or more zeros: liblcm reads the number with strtol, and anything else may be more than 0 to it.
bool is_zero(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c == '0'; });
}

}  // namespace

bool leaves_machine(const std::string& resolved_url) {
  const std::string kind = lcm_endpoint(resolved_url).kind;
  if (kind == "memq") return false;
  if (kind != "udpm" && kind != "mpudpm") return true;
  const auto options_at = resolved_url.find('?');
  if (options_at == std::string::npos) return false;  // liblcm's own ttl is 0
  std::string_view options = std::string_view(resolved_url).substr(options_at + 1);
  while (!options.empty()) {
    const auto end = std::min(options.find('&'), options.size());
    const std::string_view option = options.substr(0, end);
    if (option.starts_with("ttl=") && !is_zero(option.substr(4))) return true;
    options.remove_prefix(std::min(end + 1, options.size()));
  }
  return false;
}

}  // namespace bridges
