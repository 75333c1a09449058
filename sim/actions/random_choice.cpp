// SPDX-License-Identifier: BSD-3-Clause
#include "sim/actions/random_choice.hpp"

#include <numbers>

#include "sim/config/common_keys.hpp"
#include "sim/script/action.hpp"

namespace sim {

void TargetChoice::read(ParamReader& in, const char* key) {
  std::string name;
  in.read_reference(key, name, movable_kind, "the vehicle or object");
  in.read_references("one_of", names, movable_kind, "one of these, at random, instead of `name`");
  if (in.describing()) return;
  const std::string main = "'" + std::string(key) + "'";
  if (in.has(key) && in.has("one_of"))
    in.error("one_of", "needs either " + main + " or 'one_of', not both");
  else if (!in.has(key) && !in.has("one_of"))
    in.error("needs either " + main + " or 'one_of'");
  else if (in.has("one_of") && names.empty() && in.child("one_of")->items.empty())
    in.error("one_of", "'one_of' must name at least one");
  else if (in.has(key) && name.empty() && in.child(key)->kind == ConfigNode::Kind::scalar)
    in.error(key, main + " must name a vehicle or an object");
  if (in.has(key)) names = {name};
}

const std::string& TargetChoice::choose(Random& random) const {
  if (names.size() == 1) return names[0];
  return names[random.integer_below(static_cast<std::uint32_t>(names.size()))];
}

void PlaceChoice::read(ParamReader& in) {
  Vector3d position = Vector3d::Zero();
  Vector3d rpy = Vector3d::Zero();
  in.read("position_m", position, any_place(), "place in the world");
  in.read_deg("rpy_deg", rpy, "roll, pitch, yaw; unset: as it was");
  read_points(in, "places", places_m, 3, "one of these places, at random");
  in.read("area_m", area_m, at_least(0), "size of a box around the place from which the position is drawn");
  in.read("random_yaw", random_yaw, "the heading is drawn from the full circle");
  // Only keys that are given change anything: without 'rpy_deg' what is moved keeps its attitude.
  if (in.has("position_m")) position_m = position;
  if (in.has("rpy_deg")) rpy_rad = rpy;
  if (in.has("position_m") && in.has("places")) in.error("places", "needs either 'position_m' or 'places', not both");
  if (in.has("places") && places_m.empty()) in.error("places", "'places' must have at least one place");
}

Pose PlaceChoice::choose(const Pose& X_W_unless, Random& random) const {
  Pose X_W = X_W_unless;
  if (position_m) X_W.translation() = *position_m;
  if (!places_m.empty())
    X_W.translation() = places_m[random.integer_below(static_cast<std::uint32_t>(places_m.size()))];
  for (int i = 0; i < 3; ++i)
    if (area_m[i] > 0) X_W.translation()[i] += (random.uniform() - 0.5) * area_m[i];
  if (rpy_rad) X_W.linear() = rotation_from_rpy(*rpy_rad);
  if (random_yaw) X_W.linear() = rotation_from_rpy({0, 0, 2 * std::numbers::pi * random.uniform()}) * X_W.linear();
  return X_W;
}

}  // namespace sim
