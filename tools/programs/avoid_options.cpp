// SPDX-License-Identifier: BSD-3-Clause
#include "tools/programs/avoid_options.hpp"

namespace autonomy {

void AvoidOptions::declare(command_line::DeclaredOptions& options) {
  std::vector<std::string> laws = avoidance_names();
  laws.insert(laws.begin(), "none");
  options.choice("avoid", law, laws, "avoidance law for what its lidar or forward sonar sees");
  options.number("keep_m", params.keep_m, 0.1, 1000, "clearance between its center and the edge of an obstacle");
  options.number("avoid_range_m", tracks.range_m, 0.5, 1000,
                 "echoes beyond it are ignored; less than the range of the sensor");
  options.number("avoid_horizon_s", params.horizon_s, 1, 120, "look-ahead time");
  options.number("avoid_memory_s", tracks.memory_s, 0.1, 600,
                 "time without an echo after which an obstacle is forgotten");
  options.number("avoid_turn_radps", params.turn_radps, 0.01, 10, "rate at which the vehicle turns");
  options.number("avoid_speed_min_mps", params.speed_min_mps, 0, 10, "slowest speed at which it can be steered");
}

std::optional<Avoidance> AvoidOptions::make() const {
  if (law == "none") return std::nullopt;
  return Avoidance(make_avoidance(law, params), tracks);
}

std::unique_ptr<HelmBehavior> AvoidOptions::around(std::unique_ptr<HelmBehavior> behavior) const {
  const std::optional<Avoidance> avoidance = make();
  if (!avoidance) return behavior;
  return std::make_unique<AvoidBehavior>(std::move(behavior), *avoidance);
}

}  // namespace autonomy
