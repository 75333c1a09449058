// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/hydrodynamics.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "sim/base/first_failure.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"
#include "sim/hydrodynamics/coefficient_model.hpp"
#include "sim/model/hydrodynamics_config.hpp"
#include "sim/physics/physics_world.hpp"

namespace sim {

namespace {

/// Converts between forward-left-up and forward-right-down.
Vector3d flipped(const Vector3d& v) {
  return {v.x(), -v.y(), -v.z()};
}

/// Quirk `current: yaw_only`: the velocity of the water that, turned into body axes by the whole attitude, has there
/// the components that the true velocity has when it is turned by the yaw alone.  Hull, fins and propellers then see
/// the same water.
Vector3d turned_by_yaw_only(const Matrix3d& R_WB, const Vector3d& v_W) {
  const double yaw = std::atan2(R_WB(1, 0), R_WB(0, 0));
  const double along = v_W.x() * std::cos(yaw) + v_W.y() * std::sin(yaw);
  const double left = -v_W.x() * std::sin(yaw) + v_W.y() * std::cos(yaw);
  return R_WB * Vector3d(along, left, v_W.z());
}

}  // namespace

Hydrodynamics::Hydrodynamics(const Medium& medium, double gravity_mps2, double step_s, Warn warn)
    : medium_(medium),
      gravity_mps2_(gravity_mps2),
      step_s_(step_s),
      floaters_(medium, step_s),
      warn_(std::move(warn)) {}

void Hydrodynamics::add_body(Body& body, const BodyConfig& config) {
  if (!medium_.has_water()) return;
  double radius_m = std::numeric_limits<double>::infinity();
  if (config.hydrodynamics) {
    if (config.hydrodynamics->model == HydrodynamicsConfig::Model::none) return;
    add_craft(body, *config.hydrodynamics);
  } else {
    radius_m = floaters_.add(body, config, gravity_mps2_, warnings_);
    if (radius_m == 0) return;
  }
  groups_listed_ = false;
  const bool yaw_only = config.hydrodynamics && crafts_.back().model->current_by_yaw_only();
  wetted_.push_back({&body, radius_m, yaw_only});
  const auto number = static_cast<std::size_t>(body.number());
  if (around_.size() <= number) around_.resize(number + 1);
  around_[number] = {};
  around_[number].known = true;
  around_[number].water = medium_.water_at(body.X_WB().translation());
}

void Hydrodynamics::add_craft(Body& body, const HydrodynamicsConfig& config) {
  std::weak_ptr<const CoefficientModel>& known = models_[&config];
  std::shared_ptr<const CoefficientModel> model = known.lock();
  if (!model) {
    model = std::make_shared<CoefficientModel>(config, gravity_mps2_);
    check_step(*model, config, "body '" + body.name() + "'");
    known = model;
  }
  // Weight and gyroscopic torque are part of the model.
  body.set_gravity(false);
  body.set_gyroscopic(false);
  crafts_.push_back({&body, std::move(model)});
}

void Hydrodynamics::check_step(const CoefficientModel& model, const HydrodynamicsConfig& config,
                               const std::string& who) {
  const CoefficientModel::StepLimit limit = model.max_step();
  if (limit.step_s < step_s_)
    throw_config_error(config.place, who,
                       std::string("the ") + limit.why + " are too stiff for 'step_s' " + number_text(step_s_) +
                           fmt::format(": they need a step below {:.6g} s", limit.step_s));
  for (std::string& doubt : doubts_about(config)) warnings_.push_back({config.place, who, std::move(doubt)});
}

void Hydrodynamics::remove_group(int group) {
  groups_listed_ = false;
  std::erase_if(crafts_, [&](const CoefficientBody& craft) { return craft.body->group() == group; });
  std::erase_if(models_, [](const auto& known) { return known.second.expired(); });
  floaters_.remove_group(group);
  for (const Wetted& wetted : wetted_)
    if (wetted.body->group() == group) around_[static_cast<std::size_t>(wetted.body->number())] = {};
  std::erase_if(wetted_, [&](const Wetted& wetted) { return wetted.body->group() == group; });
}

/// Warnings about bodies that threads share, given in the order of the bodies.
class Hydrodynamics::LateWarnings {
 public:
  void add(const Body& body, std::string text) {
    const std::lock_guard lock(mutex_);
    warnings_.push_back({body.number(), "body '" + body.name() + "'", std::move(text)});
  }
  void give(const Warn& warn) {
    std::sort(warnings_.begin(), warnings_.end(), [](const One& a, const One& b) { return a.body < b.body; });
    for (const One& one : warnings_)
      if (warn) warn(one.who, one.text);
  }

 private:
  struct One {
    int body;
    std::string who, text;
  };
  std::mutex mutex_;
  std::vector<One> warnings_;
};

void Hydrodynamics::begin_step(ThreadPool* threads) {
  LateWarnings late;
  const double highest_m = medium_.highest_surface_m();
  for_each_block(threads, wetted_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) begin_step_of(wetted_[i], highest_m, late);
  });
  late.give(warn_);
}

void Hydrodynamics::list_groups() {
  groups_.clear();
  std::size_t craft = 0;
  for (std::size_t i = 0; i < wetted_.size();) {
    InWater next{wetted_[i].body->group(), i, i, craft, craft};
    for (; i < wetted_.size() && wetted_[i].body->group() == next.group; ++i) {
    }
    for (; craft < crafts_.size() && crafts_[craft].body->group() == next.group; ++craft) {
    }
    next.wetted_end = i;
    next.crafts_end = craft;
    groups_.push_back(next);
  }
  groups_listed_ = true;
}

void Hydrodynamics::step_by_groups(double gravity_mps2, const Actors& actors, ThreadPool* threads) {
  if (!groups_listed_) list_groups();
  // Threads only collect warnings and failures here. They are reported afterwards, so that neither depends on the
  // number of threads.
  LateWarnings at_begin, late;
  FirstFailure failure;
  const double highest_m = medium_.highest_surface_m();
  for_each_block(threads, groups_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const InWater& group = groups_[i];
      for (std::size_t k = group.wetted_begin; k < group.wetted_end; ++k)
        begin_step_of(wetted_[k], highest_m, at_begin);
      actors.act(group.group);
      for (std::size_t k = group.crafts_begin; k < group.crafts_end; ++k) try {
          step_craft(crafts_[k], late);
        } catch (...) {
          failure.take(k);
        }
    }
  });
  at_begin.give(warn_);
  actors.finish();
  late.give(warn_);
  failure.rethrow();
  floaters_.step(gravity_mps2, around_, threads);
}

[[gnu::flatten]] void Hydrodynamics::begin_step_of(Wetted& wetted, double highest_m, LateWarnings& late) {
  BodyInWater& around = around_[static_cast<std::size_t>(wetted.body->number())];
  const BodyMotion motion = wetted.body->motion_for_forces(step_s_);
  around.w_B = motion.R_WB.transpose() * motion.w_WB_W;
  around.motion = motion;
  // Even the highest crest does not reach it: no wave needs to be evaluated.
  if (motion.p_WB.z() - wetted.radius_m > highest_m) {
    around.water.surface_m = highest_m;
    around.v_B = motion.R_WB.transpose() * (motion.v_WB_W - around.water.velocity_W);
    return;
  }
  around.water = medium_.water_at(motion.p_WB);
  if (wetted.current_by_yaw_only) around.water.velocity_W = turned_by_yaw_only(motion.R_WB, around.water.velocity_W);
  around.v_B = motion.R_WB.transpose() * (motion.v_WB_W - around.water.velocity_W);
  if (!wetted.left_the_current && !medium_.current_known(motion.p_WB))
    warn_of_missing_current(wetted, motion.p_WB, late);
}

void Hydrodynamics::warn_of_missing_current(Wetted& wetted, const Vector3d& p_WB, LateWarnings& late) {
  wetted.left_the_current = true;
  late.add(*wetted.body, fmt::format("has left the file of the current at {:.1f}, {:.1f} m", p_WB.x(), p_WB.y()));
}

[[gnu::flatten]] CraftState Hydrodynamics::state_of(const CoefficientModel& model, const BodyInWater& around) const {
  const BodyMotion& motion = around.motion;
  const LocalWater& water = around.water;
  const Matrix3d& R_WB = motion.R_WB;
  // Velocity and attitude.
  CraftState state;
  state.nu << flipped(R_WB.transpose() * motion.v_WB_W), flipped(around.w_B);
  state.down = {-R_WB(2, 0), R_WB(2, 1), R_WB(2, 2)};
  // Velocity of the water, in body axes.
  state.v_water = state.nu.head<3>() - flipped(around.v_B);
  // Acceleration of the water, and wind.
  if (medium_.has_waves())
    state.a_water = flipped(R_WB.transpose() * water.acceleration_W);
  else
    state.a_water.setZero();
  if (model.config().windage) {
    const double height_m = model.config().windage->height_m;
    state.v_air = flipped(R_WB.transpose() * medium_.air_velocity_W(motion.p_WB + Vector3d(0, 0, height_m)));
  }
  // Depth, and slope of the surface at the water plane.
  state.depth_m = water.surface_m - motion.p_WB.z();
  state.density_kgpm3 = water.density_kgpm3;
  if (model.config().waterline && medium_.has_waves()) {
    const WaterlineConfig& plane = *model.config().waterline;
    const auto surface_at = [&](double x, double y) {
      const Vector3d p_W = motion.p_WB + R_WB * Vector3d(x, y, 0);
      return medium_.surface_m(p_W.x(), p_W.y());
    };
    const double bow = surface_at(plane.length_m / 2, 0), stern = surface_at(-plane.length_m / 2, 0),
                 port = surface_at(0, plane.beam_m / 2), starboard = surface_at(0, -plane.beam_m / 2);
    state.surface_pitch_rad = std::atan((bow - stern) / plane.length_m);
    state.surface_roll_rad = std::atan((port - starboard) / plane.beam_m);
    state.depth_m = (bow + stern + port + starboard) / 4 - motion.p_WB.z();
  }
  return state;
}

void Hydrodynamics::step(double gravity_mps2, ThreadPool* threads) {
  LateWarnings late;
  FirstFailure failure;
  for_each_block(threads, crafts_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) try {
        step_craft(crafts_[i], late);
      } catch (...) {
        failure.take(i);
      }
  });
  late.give(warn_);
  failure.rethrow();
  floaters_.step(gravity_mps2, around_, threads);
}

void Hydrodynamics::warn_of_stiffness(CoefficientBody& craft, const Six& nu_r, double fastest_rate,
                                      LateWarnings& late) const {
  craft.stiffness_warned = true;
  const auto rounded = [](double value) { return fmt::format("{:.3g}", value); };
  late.add(*craft.body, "the hydrodynamics at " + rounded(nu_r.linear.norm()) + " m/s and " +
                            rounded(nu_r.angular.norm()) + " rad/s are too stiff for 'step_s' " + number_text(step_s_) +
                            ": use a step below " + rounded(1 / fastest_rate) +
                            " s; until then backward Euler adds damping");
}

void Hydrodynamics::step_craft(CoefficientBody& craft, LateWarnings& late) {
  Body& body = *craft.body;
  const CoefficientModel& model = *craft.model;
  const BodyInWater& around = around_[static_cast<std::size_t>(body.number())];
  // State relative to the water, and stiffness of the step.
  CraftState state = state_of(model, around);
  Six nu_r(state.nu);
  nu_r.linear -= state.v_water;
  const double fastest = model.fastest_rate(nu_r);
  const bool stiff = !(fastest * step_s_ < 1) && model.immersed(state) > 0;
  if (stiff && !craft.stiffness_warned) warn_of_stiffness(craft, nu_r, fastest, late);
  if (!stiff) return step_by_midpoint(craft, state, around);
  // Backward Euler starts where the body is.
  body.take_first_order_step(step_s_);
  BodyInWater at_start = around;
  at_start.motion = body.motion();
  const Matrix3d& R_WB = at_start.motion.R_WB;
  at_start.w_B = R_WB.transpose() * at_start.motion.w_WB_W;
  at_start.v_B = R_WB.transpose() * (at_start.motion.v_WB_W - at_start.water.velocity_W);
  state = state_of(model, at_start);
  const Vector6d nu_dot = model.stiff_acceleration(state, applied_to(body, model, R_WB), step_s_);
  // Wrench on the rigid body that gives this acceleration.
  const Vector6d wrench = model.equivalent_wrench(nu_dot, state.nu.head<3>(), state.nu.tail<3>(), body.mass_kg(),
                                                  model.config().inertia_kgm2);
  body.set_applied_W(R_WB * flipped(wrench.head<3>()), R_WB * flipped(wrench.tail<3>()));
}

/// Implicit midpoint rule for the velocities relative to the water, to second order by two evaluations: with the
/// predicted velocity, and with that half-way by the first.  The attitude, the water and the forces of actuators are
/// those half-way of a body that is alone; of others they are those at the start.
[[gnu::flatten]] void Hydrodynamics::step_by_midpoint(const CoefficientBody& craft, CraftState state,
                                                      const BodyInWater& around) {
  Body& body = *craft.body;
  const CoefficientModel& model = *craft.model;
  const Vector6d tau = applied_to(body, model, around.motion.R_WB);
  const BodyMotion start = body.motion();
  const Vector3d& carried_W = around.water.velocity_W;
  Six nu_r;  // at the start, relative to the water
  nu_r.linear = flipped(start.R_WB.transpose() * (start.v_WB_W - carried_W));
  nu_r.angular = flipped(start.R_WB.transpose() * start.w_WB_W);
  const auto rate_of_nu_r = [&] {
    Six rate(model.acceleration(state, tau));
    rate.linear += state.nu.tail<3>().cross(state.v_water);  // without the turning of the water in body axes
    return rate;
  };
  const Six first = rate_of_nu_r();
  state.nu << nu_r.linear + step_s_ / 2 * first.linear + state.v_water, nu_r.angular + step_s_ / 2 * first.angular;
  const Six second = rate_of_nu_r();
  nu_r.linear += step_s_ * second.linear;
  nu_r.angular += step_s_ * second.angular;
  const Vector3d w_B = flipped(nu_r.angular);
  body.set_velocity_at_end(flipped(nu_r.linear) + w_B.cross(body.p_BC()), carried_W, w_B, step_s_);
}

/// Force and torque of the actuators about the origin, forward-right-down.
Vector6d Hydrodynamics::applied_to(const Body& body, const CoefficientModel& model, const Matrix3d& R_WB) {
  const Vector3d force = flipped(R_WB.transpose() * body.applied_force_W());
  Vector6d tau;
  tau << force, flipped(R_WB.transpose() * body.applied_torque_W()) + model.config().center_of_mass_m.cross(force);
  return tau;
}

void Hydrodynamics::visit_state(StateArchive& archive) {
  archive.expect_count(wetted_.size(), "bodies in the water");
  for (Wetted& wetted : wetted_)
    archive.unhashed(around_[static_cast<std::size_t>(wetted.body->number())].water, wetted.left_the_current);
  archive.expect_count(crafts_.size(), "bodies with coefficients");
  for (CoefficientBody& craft : crafts_) archive.unhashed(craft.stiffness_warned);
}

}  // namespace sim
