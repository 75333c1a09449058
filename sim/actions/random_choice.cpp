// SPDX-License-Identifier: BSD-3-Clause
#include "sim/actions/random_choice.hpp"

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

}  // namespace sim
