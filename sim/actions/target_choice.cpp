// SPDX-License-Identifier: BSD-3-Clause
#include "sim/actions/target_choice.hpp"

#include "sim/script/action.hpp"

namespace sim {

namespace {

/// `move: {one_of: [a, b]}`
struct OneOfNames {
  std::vector<std::string> one_of;
  void read(ParamReader& in) {
    in.require("one_of");
    in.read_references("one_of", one_of, movable_kind, "one of them, at random");
    if (in.has("one_of") && one_of.empty() && in.child("one_of")->items.empty())
      in.error("one_of", "'one_of' must name at least one");
  }
};

}  // namespace

void TargetChoice::read(ParamReader& in, const char* key) {
  if (in.describing()) return;
  if (in.child(key)->kind == ConfigNode::Kind::map) {
    OneOfNames choice;
    in.read(key, choice, "");
    names = choice.one_of;
    return;
  }
  names.resize(1);
  in.read_reference(key, names[0], movable_kind, "");
  if (names[0].empty() && in.child(key)->kind == ConfigNode::Kind::scalar)
    in.error(key, "'" + std::string(key) + "' must name a vehicle or an object");
}

const std::string& TargetChoice::choose(Random& random) const {
  if (names.size() == 1) return names[0];
  return names[random.integer_below(static_cast<std::uint32_t>(names.size()))];
}

}  // namespace sim
