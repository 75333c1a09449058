// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/run_info.hpp"

#include <sstream>

#include "shoal/message_codec.hpp"
#include "sim/config/message_text.hpp"

namespace bridges {

shoal::sim_info_t read_run_info(std::span<const std::byte> payload) {
  auto info = shoal::decode<shoal::sim_info_t>(payload, shoal::Finite::any);
  info.world = sim::printable(info.world);
  std::istringstream lines(info.versions);
  info.versions.clear();
  for (std::string line; std::getline(lines, line);) info.versions += sim::printable(line) + '\n';
  return info;
}

}  // namespace bridges
