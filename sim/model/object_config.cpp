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
  in.require("parts");
  in.read_list("parts", parts, "part", "parts of the body");
  if (in.has("parts") && in.child("parts")->items.empty() && in.child("parts")->kind != ConfigNode::Kind::scalar)
    in.error("parts", "'parts' must have at least one part");
}

}  // namespace sim
