// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/object_config.hpp"

namespace sim {

ObjectConfig::ObjectConfig() = default;
ObjectConfig::ObjectConfig(const ObjectConfig&) = default;
ObjectConfig::ObjectConfig(ObjectConfig&&) noexcept = default;
ObjectConfig& ObjectConfig::operator=(const ObjectConfig&) = default;
ObjectConfig& ObjectConfig::operator=(ObjectConfig&&) noexcept = default;
ObjectConfig::~ObjectConfig() = default;

void refuse_reserved(ParamReader& in, const std::string& name) {
  if (name == "any" || name == "world" || name == "sim")
    in.error("name", "'" + name + "' cannot be a name: it is a keyword");
}

void ObjectConfig::read(ParamReader& in) {
  if (in.node() != nullptr) {
    place = in.node()->place;
    source = std::make_shared<const ConfigNode>(*in.node());
  }
  in.require("name");
  in.read_name("name", name, "name of the object, unique in the world");
  refuse_reserved(in, name);
  in.read("position_m", position_m, any_place(), "place in the world");
  in.read_deg("rpy_deg", rpy_rad, "roll, pitch, yaw");
  in.read("fixed", fixed, "it is static");
  in.read("present", present, "false: it is absent until an event adds it");
  in.read("count", count, between(1, 100000), "number of instances, named NAME1, NAME2, ...");
  in.read("placement", placement, "placement of the instances when there is a count");
  std::vector<PartConfig> parts;
  in.read_list("parts", parts, "part", "parts of a single body; or 'bodies'");
  read_mechanism(in);
  if (in.describing()) return;
  check_keys(in);
  // An error in `bodies` may leave none; what follows expects the first body.
  if (bodies.empty()) bodies.resize(1);
  if (in.has("bodies")) return;
  bodies.front().name = "body";
  bodies.front().parts = std::move(parts);
}

void ObjectConfig::check_keys(ParamReader& in) const {
  if (in.has("parts") == in.has("bodies"))
    in.error(in.has("parts") ? "needs either 'parts' or 'bodies', not both" : "needs either 'parts' or 'bodies'");
  if (in.has("parts") && in.child("parts")->items.empty() && in.child("parts")->kind != ConfigNode::Kind::scalar)
    in.error("parts", "'parts' must have at least one part");
  for (const char* key : {"joints", "self_collision"})
    if (in.has(key) && !in.has("bodies")) in.error(key, "'" + std::string(key) + "' goes with 'bodies'");
  if (fixed && in.has("bodies"))
    in.error("fixed", "'fixed' needs 'parts'; one of 'bodies' is held by a joint to 'world'");
  for (const BodyConfig& body : bodies)
    if (body.kinematic)
      in.error("bodies",
               "body '" + body.name + "': 'kinematic' is for bodies that a device moves, and an object has none");
}

std::string ObjectConfig::error_of_leading() const {
  if (fixed) return "is fixed and cannot be moved";
  return anchored() ? "has a joint to 'world' and cannot be moved" : "";
}

}  // namespace sim
