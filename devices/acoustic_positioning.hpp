#pragma once

#include <string>
#include <vector>

#include "sim/math.hpp"
#include "sim/world/world.hpp"

namespace devices {

class Transponder;

/// All transponders of a world, in the order in which they came.
class TransponderNetwork {
 public:
  void join(Transponder& transponder) { members_.push_back(&transponder); }
  void leave(Transponder& transponder) { std::erase(members_, &transponder); }
  const std::vector<Transponder*>& members() const { return members_; }

 private:
  std::vector<Transponder*> members_;
};

}  // namespace devices
