// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/wander.hpp"

namespace autonomy {

Twist Wander::step(const Scan& scan) {
  random_.begin_step(steps_++);
  const std::size_t beams = scan.ranges_m.size();
  const bool blocked = nearest_m(scan, beams / 3, beams - beams / 3) < turn_below_m;
  const bool close = nearest_m(scan, 0, beams) < stop_below_m;
  if (turn_left_ == 0 && (blocked || close))
    turn_left_ = shortest_turn + static_cast<int>(random_.integer_below(max_turn - shortest_turn + 1));
  const bool turning = turn_left_ > 0;
  if (turning) --turn_left_;
  Twist twist{turning ? turning_forward_mps : forward_mps, turning ? turn_radps : 0.0};
  // The rover also turns when it has stopped, or it would stand still forever.
  if (close) twist.forward_mps = 0;
  return twist;
}

}  // namespace autonomy
