// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/moved_bodies.hpp"

#include <spdlog/fmt/fmt.h>

#include "sim/ode/physics_fault.hpp"

namespace sim {

void MovedBodies::throw_first_fault(const Groups& groups, std::int64_t step_number) const {
  groups.for_each_moving([&](const SteppedBody& body) {
    if (!is_out_of_bounds(body)) return;
    const double speed = to_eigen(body.v_WC_W()).norm(), distance = to_eigen(body.p_WC()).norm();
    std::string text = "angular velocity is not finite";
    if (!std::isfinite(distance))
      text = "position is not finite";
    else if (!std::isfinite(speed))
      text = "velocity is not finite";
    else if (speed > max_speed_mps_)
      text = fmt::format("speed {:.2g} m/s is over {:g} m/s", speed, max_speed_mps_);
    else if (distance > max_distance_m_)
      text = fmt::format("distance {:.3g} m from the origin is over {:g} m", distance, max_distance_m_);
    throw PhysicsFault("body '" + body.name() + "': " + text + " at step " + std::to_string(step_number));
  });
}

}  // namespace sim
