// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/avoid_behavior.hpp"

#include <cmath>
#include <stdexcept>

#include "autonomy/behaviors/avoidance_law.hpp"
#include "autonomy/behaviors/vector_field_histogram.hpp"
#include "autonomy/behaviors/velocity_obstacles.hpp"

namespace autonomy {

Course Avoidance::steer(const Motion& own, const Course& desired) {
  Course course = desired;
  drift_.update(own);
  if (std::isfinite(own.yaw_rad)) course = law_->steer(own, drift_.drift_W(), desired, tracks_.at(own.utime));
  drift_.command(course);
  return course;
}

Course AvoidBehavior::steer(const Motion& own) {
  const Course desired = inner_->steer(own);
  return inner_->finished() ? desired : avoidance_.steer(own, desired);
}

namespace {

struct NamedLaw {
  const char* name;
  std::unique_ptr<AvoidanceLaw> (*make)(const AvoidanceParams&);
};

template <class Law>
std::unique_ptr<AvoidanceLaw> make_law(const AvoidanceParams& params) {
  return std::make_unique<Law>(params);
}

/// A new law is a file and a row.
constexpr NamedLaw laws[] = {
    {"velocity_obstacles", make_law<VelocityObstacles>},
    {"vector_field_histogram", make_law<VectorFieldHistogram>},
};

}  // namespace

std::vector<std::string> avoidance_names() {
  std::vector<std::string> names;
  for (const NamedLaw& law : laws) names.emplace_back(law.name);
  return names;
}

std::unique_ptr<AvoidanceLaw> make_avoidance(const std::string& name, const AvoidanceParams& params) {
  for (const NamedLaw& law : laws)
    if (name == law.name) return law.make(params);
  throw std::invalid_argument("there is no law of avoidance '" + name + "'");
}

}  // namespace autonomy
