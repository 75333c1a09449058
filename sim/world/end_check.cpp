// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/end_check.hpp"

#include <spdlog/fmt/fmt.h>

#include "sim/world/world.hpp"

namespace sim {

std::vector<std::string> end_warnings(const World& world, const std::function<bool(const std::string&)>& is_awaited) {
  constexpr Time max_search = std::chrono::minutes(1);  // a first fix or answer may take some time
  std::vector<std::string> lines = world.warnings().kept();
  for (const auto& vehicle : world.vehicles())
    for (const MountedDevice* device : vehicle->devices()) {
      const auto lack = device->senses() ? device->lack() : std::nullopt;
      if (!lack || lack->span < max_search) continue;
      if (lack->what.ends_with(" under water") && !is_awaited(device->report_channel())) continue;
      lines.push_back(
          fmt::format("device '{}': no {} in {:.6g} s", device->full_name(), lack->what, to_seconds(lack->span)));
    }
  return lines;
}

}  // namespace sim
