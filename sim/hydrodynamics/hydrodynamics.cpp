// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/hydrodynamics.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"
#include "sim/model/hydrodynamics_checks.hpp"
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
                               const std::string& who) const {
  const CoefficientModel::StepLimit limit = model.max_step();
  if (limit.step_s < step_s_)
    throw_config_error(config.place, who,
                       std::string("the ") + limit.why + " are too stiff for 'step_s' " + number_text(step_s_) +
                           ": they need a step below " + number_text(limit.step_s) + " s");
  for (const std::string& doubt : doubts_about(config, who)) spdlog::warn("{}", doubt);
}

void Hydrodynamics::remove_group(int group) {
  std::erase_if(crafts_, [&](const CoefficientBody& craft) { return craft.body->group() == group; });
  std::erase_if(models_, [](const auto& known) { return known.second.expired(); });
  floaters_.remove_group(group);
  for (const Wetted& wetted : wetted_)
    if (wetted.body->group() == group) around_[static_cast<std::size_t>(wetted.body->number())] = {};
  std::erase_if(wetted_, [&](const Wetted& wetted) { return wetted.body->group() == group; });
}

void Hydrodynamics::begin_step() {
  const double highest_m = medium_.highest_surface_m();
  for (Wetted& wetted : wetted_) {
    BodyInWater& around = around_[static_cast<std::size_t>(wetted.body->number())];
    around.motion = wetted.body->motion_for_forces(step_s_);
    const BodyMotion& motion = around.motion;
    around.w_B = motion.R_WB.transpose() * motion.w_WB_W;
    if (motion.p_WB.z() - wetted.radius_m > highest_m) {
      around.water.surface_m = highest_m;
      around.v_B = motion.R_WB.transpose() * (motion.v_WB_W - around.water.velocity_W);
      continue;
    }
    around.water = medium_.water_at(motion.p_WB);
    if (wetted.current_by_yaw_only) around.water.velocity_W = turned_by_yaw_only(motion.R_WB, around.water.velocity_W);
    around.v_B = motion.R_WB.transpose() * (motion.v_WB_W - around.water.velocity_W);
    if (!wetted.left_the_current && !medium_.current_known(motion.p_WB)) warn_of_missing_current(wetted, motion.p_WB);
  }
}

void Hydrodynamics::warn_of_missing_current(Wetted& wetted, const Vector3d& p_WB) {
  wetted.left_the_current = true;
  if (warn_)
    warn_("body '" + wetted.body->name() + "'",
          fmt::format("has left the file of the current at {:.1f}, {:.1f} m", p_WB.x(), p_WB.y()));
}

CraftState Hydrodynamics::state_of(const CoefficientModel& model, const BodyInWater& around) const {
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

void Hydrodynamics::step(double gravity_mps2) {
  step_crafts();
  floaters_.step(gravity_mps2, around_);
}

void Hydrodynamics::warn_of_stiffness(CoefficientBody& craft, const Vector6d& nu_r, double fastest_rate) {
  craft.stiffness_warned = true;
  const auto rounded = [](double value) { return fmt::format("{:.3g}", value); };
  if (warn_)
    warn_("body '" + craft.body->name() + "'",
          "the hydrodynamics at " + rounded(nu_r.head<3>().norm()) + " m/s and " + rounded(nu_r.tail<3>().norm()) +
              " rad/s are too stiff for 'step_s' " + number_text(step_s_) + ": use a step below " +
              rounded(1 / fastest_rate) + " s; until then backward Euler adds damping");
}

void Hydrodynamics::step_crafts() {
  for (CoefficientBody& craft : crafts_) {
    Body& body = *craft.body;
    const CoefficientModel& model = *craft.model;
    const BodyInWater& around = around_[static_cast<std::size_t>(body.number())];
    // State relative to the water, and stiffness of the step.
    CraftState state = state_of(model, around);
    Vector6d nu_r = state.nu;
    nu_r.head<3>() -= state.v_water;
    const double fastest = model.fastest_rate(nu_r);
    const bool stiff = !(fastest * step_s_ < 1) && model.immersed(state) > 0;
    if (stiff && !craft.stiffness_warned) warn_of_stiffness(craft, nu_r, fastest);
    if (!stiff) {
      step_by_midpoint(craft, state, around);
      continue;
    }
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
}

/// Implicit midpoint rule for the velocities relative to the water, to second order by two evaluations: with the
/// predicted velocity, and with that half-way by the first.  The attitude, the water and the forces of actuators are
/// those half-way of a body that is alone; of others they are those at the start.
void Hydrodynamics::step_by_midpoint(const CoefficientBody& craft, CraftState state, const BodyInWater& around) {
  Body& body = *craft.body;
  const CoefficientModel& model = *craft.model;
  const Vector6d tau = applied_to(body, model, around.motion.R_WB);
  const BodyMotion start = body.motion();
  const Vector3d& carried_W = around.water.velocity_W;
  Vector6d nu_r;  // at the start, relative to the water
  nu_r << flipped(start.R_WB.transpose() * (start.v_WB_W - carried_W)), flipped(start.R_WB.transpose() * start.w_WB_W);
  const auto rate_of_nu_r = [&] {
    Vector6d rate = model.acceleration(state, tau);
    rate.head<3>() += state.nu.tail<3>().cross(state.v_water);  // without the turning of the water in body axes
    return rate;
  };
  state.nu = nu_r + step_s_ / 2 * rate_of_nu_r();
  state.nu.head<3>() += state.v_water;
  nu_r += step_s_ * rate_of_nu_r();
  const Vector3d w_B = flipped(nu_r.tail<3>());
  body.set_velocity_at_end(flipped(nu_r.head<3>()) + w_B.cross(body.p_BC()), carried_W, w_B, step_s_);
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
