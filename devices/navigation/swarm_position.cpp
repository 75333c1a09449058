// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/swarm_position.hpp"

#include <algorithm>
#include <limits>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/swarm_position_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

void SwarmPosition::Params::read(sim::ParamReader& in) {
  in.read("range_max_m", range_max_m, sim::above(0), "maximum range to a vehicle");
  in.read("absolute", absolute, "measure positions in the world frame too");
  in.read("occlusion", occlusion, "parts of the world occlude vehicles");
  in.read_references("see_through", see_through, "category", "categories of parts that do not occlude a vehicle");
  in.read("relative_noise", relative_noise, "error of each coordinate relative to the sensor, m");
  in.read("absolute_noise", absolute_noise, "error of each coordinate in the world frame, m");
}

SwarmPosition::SwarmPosition(const Params& params, const sim::DeviceContext& context)
    : params_(params), relative_noises_(context, params), absolute_noises_(context, params) {
  for (const std::string& category : params.see_through) categories_ &= ~context.world.physics().category_bit(category);
}

bool SwarmPosition::visible(const sim::SenseContext& context, const sim::Vehicle& other) const {
  const sim::Vector3d from_W = context.X_WS.translation();
  // Use the center of mass of the base as target, because the frame often lies on the ground.
  const sim::Vector3d to_W = other.base().X_WB() * other.base().p_BC();
  const sim::Vector3d d = to_W - from_W;
  const double distance_m = d.norm();
  if (distance_m < 1e-9) return true;
  const auto hit =
      context.world.scene().cast(from_W, d / distance_m, distance_m, {categories_, context.vehicle.group()});
  return !hit || context.world.physics().parts()[static_cast<std::size_t>(hit->part)].group == other.group();
}

void SwarmPosition::measure(const sim::SenseContext& context) {
  sightings_.clear();
  now_s_ = sim::to_seconds(context.now);
  const sim::Pose X_SW = context.X_WS.inverse();
  for (const auto& other : context.world.vehicles()) {
    if (other->number() == context.vehicle.number()) continue;
    const sim::Vector3d p_WV = other->X_WV().translation();
    const sim::Vector3d p_SV_S = X_SW * p_WV;
    if (p_SV_S.norm() > params_.range_max_m) continue;
    if (params_.occlusion && !visible(context, *other)) continue;
    sightings_.push_back({other->number(), other->name(), p_SV_S, p_WV});
  }
}

SwarmPosition::Errors& SwarmPosition::errors_of(const Sighting& sighting) {
  const auto number = static_cast<std::size_t>(sighting.vehicle);
  if (number >= errors_index_.size()) errors_index_.resize(number + 1, -1);
  if (errors_index_[number] >= 0) return errors_[static_cast<std::size_t>(errors_index_[number])];
  errors_index_[number] = static_cast<int>(errors_.size());
  errors_.push_back(new_errors(sighting.vehicle, sighting.name));
  return errors_.back();
}

SwarmPosition::Errors SwarmPosition::new_errors(int vehicle, const std::string& name) const {
  return {vehicle, relative_noises_.to(name, params_, 3), absolute_noises_.to(name, params_, 3), now_s_};
}

void SwarmPosition::disturb(double, sim::Random& random) {
  for (Sighting& sighting : sightings_) {
    Errors& errors = errors_of(sighting);
    const double dt_s = now_s_ - errors.seen_at_s;
    errors.seen_at_s = now_s_;
    errors.relative.apply(std::span<double>(sighting.p_SV_S.data(), 3), dt_s, random);
    errors.absolute.apply(std::span<double>(sighting.p_WV.data(), 3), dt_s, random);
  }
}

void SwarmPosition::visit_state(sim::StateArchive& archive) {
  archive(sightings_, errors_index_);
  std::vector<int> seen;
  for (const Errors& errors : errors_) seen.push_back(errors.vehicle);
  archive(seen);
  if (archive.restoring()) make_errors_of(seen, archive);
  for (Errors& errors : errors_) archive(errors.relative, errors.absolute, errors.seen_at_s);
}

/// Creates the errors of the vehicles detected before a snapshot.  Their state is restored afterwards.
void SwarmPosition::make_errors_of(const std::vector<int>& seen, const sim::StateArchive& archive) {
  errors_.clear();
  for (const int vehicle : seen) {
    const auto number = static_cast<std::size_t>(vehicle);
    if (vehicle < 0 || number >= errors_index_.size() || errors_index_[number] != static_cast<int>(errors_.size()))
      archive.fail("errors to a vehicle that was not seen");
    errors_.push_back(new_errors(vehicle, ""));
  }
  const auto known = std::count_if(errors_index_.begin(), errors_index_.end(), [](int index) { return index >= 0; });
  if (static_cast<std::size_t>(known) != errors_.size()) archive.fail("a vehicle was seen that has no errors");
}

void fill(const SwarmPosition& sensor, shoal::swarm_position_t& message) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  message.count = static_cast<std::int32_t>(sensor.sightings().size());
  for (const SwarmPosition::Sighting& sighting : sensor.sightings()) {
    const sim::Vector3d& r = sighting.p_SV_S;
    const sim::Vector3d a = sensor.absolute() ? sighting.p_WV : sim::Vector3d::Constant(nothing);
    message.vehicle.push_back(sighting.name);
    message.relative_m.push_back({r.x(), r.y(), r.z()});
    message.absolute_m.push_back({a.x(), a.y(), a.z()});
  }
}

SHOAL_SENSOR("swarm_position", SwarmPosition, shoal::swarm_position_t);

}  // namespace devices
