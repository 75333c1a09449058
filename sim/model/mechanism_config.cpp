// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/mechanism_config.hpp"

#include <map>
#include <numeric>
#include <set>

namespace sim {

void MechanismConfig::read_mechanism(ParamReader& in) {
  in.read("self_collision", self_collision, "parts of bodies that no joint connects collide with each other");
  in.read_list("bodies", bodies, "body", "parts that move as one; the first body carries the frame");
  if (in.has("bodies") && bodies.empty()) in.error("bodies", "'bodies' must have at least one body");
  declare_bodies(in);
  in.read_list("joints", joints, "joint", "joints between bodies");
  for (const JointConfig& joint : joints) in.declare("joint", joint.name);
  for (JointConfig& joint : joints)
    if (!joint.anchored) joint.anchor_at_body(bodies);
}

void MechanismConfig::declare_bodies(ParamReader& in) const {
  for (const BodyConfig& body : bodies) {
    in.declare("body", body.name);
    for (const PartConfig& part : body.parts)
      if (!part.name.empty()) in.declare("part", body.name + "/" + part.name);
  }
  in.declare("body", "world");  // for joints
}

bool MechanismConfig::anchored() const {
  return std::any_of(joints.begin(), joints.end(),
                     [](const JointConfig& joint) { return joint.bodies.size() == 2 && joint.bodies[1] == "world"; });
}

std::vector<const BodyConfig*> MechanismConfig::unconnected() const {
  std::multimap<std::string, std::string> joined;
  for (const JointConfig& joint : joints) {
    joined.emplace(joint.bodies[0], joint.bodies[1]);
    joined.emplace(joint.bodies[1], joint.bodies[0]);
  }
  std::set<std::string> reached;
  // Walks along the joints from the first body; what it does not reach would drift away on its own.
  for (std::vector<std::string> next{bodies.front().name}; !next.empty();) {
    const std::string name = std::move(next.back());
    next.pop_back();
    if (!reached.insert(name).second) continue;
    const auto [first, last] = joined.equal_range(name);
    for (auto other = first; other != last; ++other) next.push_back(other->second);
  }
  std::vector<const BodyConfig*> apart;
  for (const BodyConfig& body : bodies)
    if (!reached.contains(body.name)) apart.push_back(&body);
  return apart;
}

std::size_t MechanismConfig::part_count() const {
  return std::accumulate(bodies.begin(), bodies.end(), std::size_t{0},
                         [](std::size_t sum, const BodyConfig& body) { return sum + body.parts.size(); });
}

}  // namespace sim
