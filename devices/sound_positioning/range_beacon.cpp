// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/range_beacon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/range_beacon_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

/// The range_beacon devices of a world, in the order in which they were added.
class RangeBeacon::Network {
 public:
  void join(RangeBeacon& device) { members_.push_back(&device); }
  void leave(RangeBeacon& device) {
    std::erase(members_, &device);
    for (RangeBeacon* member : members_) member->discard(device.full_name_);
  }
  const std::vector<RangeBeacon*>& members() const { return members_; }

 private:
  std::vector<RangeBeacon*> members_;
};

const sim::SharedKind<RangeBeacon::Network> RangeBeacon::network_of_world;

void RangeBeacon::FixedBeacon::read(sim::ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "in the reports");
  in.require("position_m");
  in.read("position_m", position_m, sim::any_number(), "in the world frame");
}

void RangeBeacon::Params::read(sim::ParamReader& in) {
  in.read("network", network, "devices measure each other only in the same network, such as a frequency");
  in.read_list("beacons", beacons, "beacon", "beacons at fixed places");
  in.read("beacon_only", beacon_only, "it only serves as a beacon for others and measures nothing");
  in.read("bearing", bearing, "measure the direction in the xy-plane of the sensor too");
  in.read("elevation", elevation, "measure the direction out of that plane too");
  read_through(in, through);
  in.read("range_max_m", range_max_m, sim::above(0), "maximum range to a beacon");
  in.read("occlusion", occlusion, "parts of the world occlude beacons");
  in.read("beacon_dropout", beacon_dropout, sim::between(0, 1),
          "probability that a beacon is missed, drawn for each beacon");
  in.read("range_noise", range_noise, "error of each range, m");
  in.read("bearing_noise", bearing_noise, "error of each bearing, rad");
  in.read("elevation_noise", elevation_noise, "error of each elevation, rad");
  for (std::size_t i = 0; i < beacons.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (beacons[i].name == beacons[j].name) in.error("beacons", "duplicate beacon '" + beacons[i].name + "'");
}

RangeBeacon::RangeBeacon(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      network_(context.shared(network_of_world)),
      vehicle_(context.vehicle),
      body_(context.body),
      p_BS_(context.config.position_m),
      full_name_(context.full_name()),
      faults_(context.faults),
      range_noises_(context, params),
      bearing_noises_(context, params),
      elevation_noises_(context, params) {
  network_.join(*this);
}

RangeBeacon::~RangeBeacon() {
  network_.leave(*this);
}

void RangeBeacon::change(const Params& params) {
  params_ = params;
  for (Errors& errors : errors_) {
    errors.range.change(params.range_noise);
    errors.bearing.change(params.bearing_noise);
    errors.elevation.change(params.elevation_noise);
  }
}

sim::Vector3d RangeBeacon::p_WS() const {
  return body_.X_WB() * p_BS_;
}

bool RangeBeacon::answers() const {
  return vehicle_.systems().powered && !faults_.silent();
}

void RangeBeacon::look_at(const sim::SenseContext& context, const std::string& beacon, const sim::Vector3d& p_W,
                          int group) {
  const sim::Vector3d p_S = context.X_WS.inverse() * p_W;
  const double range_m = p_S.norm();
  if (range_m > params_.range_max_m || !carries(context.world.medium(), params_.through, p_W)) return;
  if (params_.occlusion && range_m > 0) {
    // A fixed beacon may be attached to a wall: ignore obstacles in the last millimeter.
    const double reach_m = std::max(0.0, range_m - 1e-3);
    const sim::Vector3d direction_W = context.X_WS.linear() * (p_S / range_m);
    const auto hit =
        context.world.scene().cast(context.X_WS.translation(), direction_W, reach_m, {~0u, context.vehicle.group()});
    const bool itself =
        hit && group >= 0 && context.world.physics().parts()[static_cast<std::size_t>(hit->part)].group == group;
    if (hit && !itself) return;
  }
  sightings_.push_back(
      {beacon, range_m, std::atan2(p_S.y(), p_S.x()), std::atan2(p_S.z(), std::hypot(p_S.x(), p_S.y()))});
}

void RangeBeacon::measure(const sim::SenseContext& context) {
  now_s_ = sim::to_seconds(context.now);
  sightings_.clear();
  if (params_.beacon_only) return;
  if (!carries(context.world.medium(), params_.through, context.X_WS.translation())) return;
  for (const FixedBeacon& beacon : params_.beacons) look_at(context, beacon.name, beacon.position_m, -1);
  for (const RangeBeacon* other : network_.members()) {
    if (&other->vehicle_ == &vehicle_ || other->params_.network != params_.network || !other->answers()) continue;
    look_at(context, other->full_name_, other->p_WS(), other->vehicle_.group());
  }
}

RangeBeacon::Errors& RangeBeacon::errors_of(const std::string& beacon) {
  for (Errors& errors : errors_)
    if (errors.beacon == beacon) return errors;
  errors_.push_back({beacon, range_noises_.to(beacon, params_), bearing_noises_.to(beacon, params_),
                     elevation_noises_.to(beacon, params_), now_s_});
  return errors_.back();
}

void RangeBeacon::discard(const std::string& beacon) {
  std::erase_if(errors_, [&](const Errors& errors) { return errors.beacon == beacon; });
}

void RangeBeacon::disturb(double, sim::Random& random) {
  for (Sighting& sighting : sightings_) {
    // Slow errors belong to a pair of devices and advance by the time since they last measured each other.
    Errors& errors = errors_of(sighting.beacon);
    const double dt_s = now_s_ - errors.seen_at_s;
    errors.seen_at_s = now_s_;
    errors.range.apply(sighting.range_m, dt_s, random);
    errors.bearing.apply(sighting.bearing_rad, dt_s, random);
    errors.elevation.apply(sighting.elevation_rad, dt_s, random);
    sighting.range_m = std::max(0.0, sighting.range_m);
    sighting.bearing_rad = sim::wrap_angle(sighting.bearing_rad);
  }
  if (params_.beacon_dropout > 0)
    std::erase_if(sightings_, [&](const Sighting&) { return random.uniform() < params_.beacon_dropout; });
}

void RangeBeacon::visit_state(sim::StateArchive& archive) {
  archive(sightings_);
  std::vector<std::string> beacons;
  for (const Errors& errors : errors_) beacons.push_back(errors.beacon);
  archive(beacons);
  if (archive.restoring()) {
    errors_.clear();
    // The errors are made first, in the saved order, and then filled.
    for (const std::string& beacon : beacons) errors_of(beacon);
    if (errors_.size() != beacons.size()) archive.fail("errors to one beacon are there twice");
  }
  for (Errors& errors : errors_) archive(errors.range, errors.bearing, errors.elevation, errors.seen_at_s);
}

bool fill(const RangeBeacon& sensor, shoal::range_beacon_t& message) {
  if (sensor.params().beacon_only) return false;
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  message.count = static_cast<std::int32_t>(sensor.sightings().size());
  for (const RangeBeacon::Sighting& sighting : sensor.sightings()) {
    message.beacon.push_back(sighting.beacon);
    message.range_m.push_back(sighting.range_m);
    message.bearing_rad.push_back(sensor.params().bearing ? sighting.bearing_rad : nothing);
    message.elevation_rad.push_back(sensor.params().elevation ? sighting.elevation_rad : nothing);
  }
  return true;
}

SHOAL_SENSOR("range_beacon", RangeBeacon, shoal::range_beacon_t);

}  // namespace devices
