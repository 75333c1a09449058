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

/// Time that sound takes along the straight line between two places under water, s: by the mean of 1 / c at nine places
/// (Simpson's rule).
double travel_time_s(const sim::Medium& medium, const sim::Vector3d& from_W, const sim::Vector3d& to_W);

}  // namespace devices
