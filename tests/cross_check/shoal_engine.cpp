// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cross_check/engine.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace cross_check {

namespace {

using small_worlds::PartConfig;

PartConfig part_of(const Solid& solid) {
  switch (solid.shape) {
    case Solid::Shape::box:
      return small_worlds::box(solid.size_m, solid.mass_kg);
    case Solid::Shape::sphere:
      return small_worlds::sphere(solid.radius_m, solid.mass_kg);
    case Solid::Shape::cylinder:
      break;
  }
  return small_worlds::round(sim::PartShape::cylinder, solid.radius_m, solid.length_m, solid.mass_kg);
}

class ShoalEngine final : public Engine {
 public:
  ShoalEngine(Method method, const Model& model, double step_s) {
    // The world, and its ground.
    sim::PhysicsConfig config;
    config.step_s = step_s;
    config.gravity_mps2 = model.gravity_mps2;
    if (method == Method::shoal_quick) config.solver = sim::PhysicsConfig::Solver::quick;
    sim::ContactConfig contact;
    if (model.ground) {
      contact.friction = model.ground->friction;
      contact.restitution = model.ground->restitution;
    }
    world_ = small_worlds::make_world(config, {contact});
    if (model.ground) {
      Pose X_WG = Pose::Identity();
      X_WG.linear() = model.ground->R_WG();
      small_worlds::add_ground(*world_, X_WG);
    }
    // Bodies with pivots are one group, like a vehicle, so that they do not collide with each other.
    const int linked = world_->add_group("linked");
    for (std::size_t i = 0; i < model.bodies.size(); ++i) add(model.bodies[i], "body" + std::to_string(i), linked);
    world_->close_group(linked);
  }

  void step() override {
    for (const Spring& spring : springs_) {
      const Pivot& pivot = spring.pivot;
      spring.joint->add_effort(-pivot.stiffness_Nmprad * (spring.joint->position() - pivot.rest_rad) -
                               pivot.damping_Nmsprad * spring.joint->velocity());
    }
    try {
      world_->step(step_++);
    } catch (const sim::PhysicsFault& fault) {
      throw Diverged(fault.what());
    }
  }

  BodyState state(int body) const override {
    const sim::BodyMotion motion = bodies_[static_cast<std::size_t>(body)]->motion();
    return {motion.R_WB, motion.p_WB, motion.v_WB_W, motion.w_WB_W};
  }

 private:
  struct Spring {
    Pivot pivot;
    sim::Joint* joint;
  };

  void add(const BodyModel& model, const std::string& name, int linked) {
    const int group = model.pivot ? linked : world_->add_group(name);
    sim::Body& body = world_->add_body(group, small_worlds::body(name, {part_of(model.solid)}), model.X_WC);
    bodies_.push_back(&body);
    if (!model.pivot) {
      world_->close_group(group);
      body.set_velocity_W(model.v_WC_W, model.w_W);
      return;
    }
    const Pivot& pivot = *model.pivot;
    const auto type = pivot.kind == Pivot::Kind::hinge ? sim::JointType::hinge : sim::JointType::ball;
    const sim::JointConfig config = small_worlds::joint(name + "_pivot", type, pivot.anchor_W, pivot.axis_W);
    sim::Joint& joint = pivot.parent < 0
                            ? world_->add_joint(group, config, body, nullptr, Pose::Identity())
                            : world_->add_joint(group, config, *bodies_[static_cast<std::size_t>(pivot.parent)], &body,
                                                Pose::Identity());
    body.set_velocity_W(model.w_W.cross(model.X_WC.translation() - pivot.anchor_W), model.w_W);
    if (pivot.stiffness_Nmprad != 0 || pivot.damping_Nmsprad != 0) springs_.push_back({pivot, &joint});
  }

  std::unique_ptr<sim::PhysicsWorld> world_;
  std::vector<sim::Body*> bodies_;
  std::vector<Spring> springs_;
  std::int64_t step_ = 0;
};

}  // namespace

std::unique_ptr<Engine> make_shoal(Method method, const Model& model, double step_s) {
  return std::make_unique<ShoalEngine>(method, model, step_s);
}

}  // namespace cross_check
