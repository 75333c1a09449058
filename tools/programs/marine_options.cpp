// SPDX-License-Identifier: BSD-3-Clause
#include "tools/programs/marine_options.hpp"

#include <stdexcept>

#include "autonomy/acomms/channel_access.hpp"
#include "autonomy/behaviors/formation_behavior.hpp"

namespace autonomy {

void MarineOptions::declare(command_line::DeclaredOptions& options) {
  // Behaviors, of which exactly one is chosen.
  options.tuples(
      "waypoints_m", {"x", "y"}, 2, sim::any_place(), [this](const auto& lists) { waypoints_W = points_of(lists); },
      "route, east and north");
  options.tuple(
      "circle_m", {"x", "y", "radius"}, sim::any_place(), [this](const auto& numbers) { circle_m = numbers; },
      "circle round a point, counter-clockwise");
  options
      .tuple(
          "zigzag_m", {"x1", "y1", "x2", "y2", "amplitude"}, sim::any_place(),
          [this](const auto& numbers) { zigzag_m = numbers; }, "zigzag about the line between two points")
      .needs({"zigzag_legs"});
  options.integer("zigzag_legs", zigzag_legs, 1, 1000, "legs of the zigzag").needs({"zigzag_m"});
  options.text("follow", "VEHICLE", follow, "vehicle to follow, which must send its state").needs({"follow_offset_m"});
  options
      .tuple(
          "follow_offset_m", {"ahead", "left"}, sim::any_place(),
          [this](const auto& numbers) { follow_offset_m = numbers; },
          "position relative to that vehicle and its course")
      .needs({"follow"});
  options.text("leader", "VEHICLE", leader, "leader of the formation in which to keep a place; it must send its state");
  std::vector<std::string> formations = formation_names();
  formations.emplace_back("offset");
  options.choice("formation", formation, formations, "shape of the formation; offset: the place is formation_offset_m")
      .needs({"leader"});
  options.integer("formation_place", formation_place, 1, 1000, "place in the formation, counted from its leader")
      .needs({"leader"});
  options.number("spacing_m", spacing_m, 1, 10'000, "distance between neighbors in the formation, along and across")
      .needs({"leader"});
  options
      .tuple(
          "formation_offset_m", {"ahead", "left"}, sim::any_place(),
          [this](const auto& numbers) { formation_offset = numbers; }, "position relative to the leader and its course")
      .needs({"leader"});
  options.exactly_one({"waypoints_m", "circle_m", "zigzag_m", "follow", "leader"});
  // Parameters of all behaviors.
  options.flag("loop", loop, "restart the route after its last waypoint; otherwise the vehicle stops there");
  options.number("speed_mps", speed_mps, 0.05, 10, "speed through the water; the maximum when it follows");
  sending.declare(options, "its state");
}

std::unique_ptr<HelmBehavior> MarineOptions::make(const std::string& name) const {
  // The parser allows only one of these.
  if (!circle_m.empty()) return make_circle({circle_m[0], circle_m[1]}, circle_m[2], speed_mps);
  if (!zigzag_m.empty())
    return make_zigzag({zigzag_m[0], zigzag_m[1]}, {zigzag_m[2], zigzag_m[3]}, zigzag_m[4], zigzag_legs.value_or(1),
                       speed_mps, loop);
  if (!follow.empty()) {
    if (follow == name) throw std::invalid_argument("'" + name + "' cannot follow itself");
    return make_follow(follow, follow_offset_m[0], follow_offset_m[1], speed_mps);
  }
  if (!leader.empty()) return make_place(name);
  return make_route(waypoints_W, speed_mps, loop);
}

std::unique_ptr<HelmBehavior> MarineOptions::make_place(const std::string& name) const {
  if (leader == name) throw std::invalid_argument("'" + name + "' cannot lead itself");
  const bool by_offset = formation == "offset";
  if (by_offset == formation_offset.empty())
    throw std::invalid_argument(by_offset
                                    ? "the formation 'offset' needs formation_offset_m"
                                    : "formation_offset_m is for the formation 'offset', not '" + formation + "'");
  FormationBehavior::Params params;
  params.leader = leader;
  params.offset_m = by_offset ? Vector2d(formation_offset[0], formation_offset[1])
                              : formation_offset_m(formation, formation_place, spacing_m);
  params.speed_max_mps = speed_mps;
  return std::make_unique<FormationBehavior>(params);
}

void AccessOptions::declare(command_line::DeclaredOptions& options, const std::string& what) {
  options.integer("slot", slot, 0, 999, "sends " + what + " in this slot, counted from 0, by the clock of its vehicle")
      .needs({"slots"});
  options.integer("slots", slots, 1, 1000, "slots in a cycle").needs({"slot"});
  options.number("slot_s", slot_s, 0.1, 3600, "length of a slot");
  options.number("guard_s", guard_s, 0, 3600,
                 "guard time at the end of a slot; default: all but the first second, or the second half of a short "
                 "slot");
  options.number("random_s", random_s, 0, 3600, "sends " + what + " at random times with this mean interval; 0: never");
  options.seed("seed", seed, "seed of the random times");
}

ChannelAccess::Params AccessOptions::access() const {
  ChannelAccess::Params access;
  access.random_mean_s = random_s.value_or(0);
  access.seed = seed;
  if (!slot) return access;
  access.slot.emplace();
  access.slot->slot = *slot;
  access.slot->slots = slots.value_or(1);
  access.slot->slot_s = slot_s;
  access.slot->guard_s = guard_s.value_or(default_guard_s(slot_s));
  const Tdma checked(*access.slot);
  return access;
}

std::vector<Vector2d> points_of(const std::vector<std::vector<double>>& lists) {
  std::vector<Vector2d> points;
  for (const std::vector<double>& numbers : lists) points.emplace_back(numbers[0], numbers[1]);
  return points;
}

}  // namespace autonomy
