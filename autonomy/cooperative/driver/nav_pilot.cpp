// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/nav_pilot.hpp"

#include <stdexcept>

namespace navigation {

namespace {

int index_in(const NavTeam& team, const std::string& name) {
  if (const auto index = team.index_of(name)) return *index;
  throw std::invalid_argument("vehicle '" + name + "' is not in the world, or has no acoustic modem");
}

}  // namespace

NavPilot::NavPilot(std::shared_ptr<const NavTeam> team, const Params& params,
                   std::unique_ptr<autonomy::HelmBehavior> behavior)
    : params_(params),
      navigation_(team, index_in(*team, params.name), *params.algorithm, params.navigation),
      behavior_(std::move(behavior)),
      access_(params.access, params.name),
      phases_(params.navigation.start.p_W ? 0 : params.surface_s) {}

void NavPilot::receive(const shoal::acoustic_received_t& packet) {
  ++counts_.frames;
  navigation_.on_range(packet, packet.data);
}

NavPilot::Decision NavPilot::step() {
  Decision decision;
  navigation_.step();
  const Time now = navigation_.reports().time();
  const std::optional<Estimate> estimate = navigation_.estimate();
  if (!estimate) {
    if (now != 0) decision.helm = at_rest();
    return decision;
  }
  decision.helm = helm(*estimate);
  if (now == estimated_at_) return decision;  // no new data
  estimated_at_ = now;
  decision.estimate = navigation_.message(*estimate);
  if (!access_.take_turn(decision.estimate->utime)) return decision;
  decision.send.emplace();
  decision.send->utime = decision.estimate->utime;
  decision.send->data = *navigation_.make_payload();
  decision.send->size = static_cast<std::int32_t>(decision.send->data.size());
  ++counts_.sent;
  return decision;
}

shoal::helm_command_t NavPilot::at_rest() const {
  // A surface craft takes no depth.
  const double depth_m = params_.depth_m > 0 ? 0 : autonomy::unknown;
  return {navigation_.reports().time(), 0, autonomy::unknown, depth_m, autonomy::unknown};
}

shoal::helm_command_t NavPilot::helm(const Estimate& estimate) {
  const Time now = navigation_.reports().time();
  shoal::helm_command_t helm = at_rest();
  using Phase = autonomy::MissionPhases::Phase;
  if (phases_.phase() == Phase::waiting_for_fix) phases_.begin(navigation_.reports().setup()->time);
  if (phases_.update(now, behavior_->finished()) != Phase::under_way) return helm;
  const autonomy::Course course = behavior_->steer({now, estimate.p_W, estimate.v_W});
  helm.speed_mps = course.speed_mps;
  helm.heading_rad = course.heading_rad;
  if (params_.depth_m > 0) helm.depth_m = params_.depth_m;
  return helm;
}

}  // namespace navigation
