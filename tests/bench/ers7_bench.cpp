// SPDX-License-Identifier: BSD-3-Clause
// A step of the robot dog ers7: the whole simulator, its physics alone, and bare ODE with the same bodies, geoms,
// joints, motors and contacts.  CPU time of a step of 2 ms.  Models: 0 all devices, 1 no camera, 2 only servos with
// their group and player, 3 only legs: head, jaw, ears and tail are parts of the torso.
#include <benchmark/benchmark.h>
#include <ode/ode.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "devices/motion/joint_group.hpp"
#include "devices/motion/servo_bank.hpp"
#include "motion/analysis/perturbed_world.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/ode/ode_library.hpp"
#include "sim/ode/ode_math.hpp"
#include "sim/ode/part_shape.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"

namespace {

using sim::Pose;
using sim::Vector3d;

constexpr int settle_steps = 500;

using GroupParams = sim::detail::ParamsOf<devices::JointGroup::Params>;

enum Model : std::int64_t { whole, no_camera, servos, legs };

/// Returns the vehicle with all bodies that are not of legs as parts of the torso.
sim::VehicleConfig with_fixed_head(sim::VehicleConfig vehicle) {
  const auto is_of_leg = [](const std::string& name) { return name.size() > 3 && name[2] == '_' && name[1] != 'a'; };
  sim::BodyConfig& torso = vehicle.bodies.front();
  for (std::size_t i = 1; i < vehicle.bodies.size(); ++i) {
    if (is_of_leg(vehicle.bodies[i].name)) continue;
    for (sim::PartConfig part : vehicle.bodies[i].parts) {
      part.position_m += vehicle.bodies[i].position_m - torso.position_m;
      part.name = vehicle.bodies[i].name + "_" + part.name;
      torso.parts.push_back(part);
    }
  }
  std::erase_if(vehicle.bodies, [&](const auto& body) { return body.name != "torso" && !is_of_leg(body.name); });
  std::erase_if(vehicle.joints, [&](const auto& joint) { return !is_of_leg(joint.name); });
  // The player has motions of the head.
  std::erase_if(vehicle.devices, [&](const auto& device) { return !is_of_leg(device.name) && device.name != "group"; });
  // Limits of the mouth depend on the head.
  for (sim::DeviceConfig& device : vehicle.devices)
    if (const auto* group = dynamic_cast<const GroupParams*>(device.params.get())) {
      auto own = std::make_shared<GroupParams>(*group);
      std::erase_if(own->params.limits, [&](const auto& row) { return !is_of_leg(row.joint); });
      device.params = std::move(own);
    }
  return vehicle;
}

/// The world of the studio with a model of the dog.
sim::WorldConfig studio(std::int64_t model) {
  sim::WorldConfig world = sim::load_world(test_support::source_path("worlds/ers7_studio.yaml")).config;
  if (model >= Model::servos) world = motion::world_for_walks(world);
  sim::VehicleConfig dog = *world.vehicles.front().config;
  if (model == Model::no_camera) std::erase_if(dog.devices, [](const auto& device) { return device.name == "camera"; });
  if (model == Model::legs) dog = with_fixed_head(dog);
  world.vehicles.front().config = std::make_shared<const sim::VehicleConfig>(std::move(dog));
  return world;
}

/// The dog in bare ODE, which holds its pose by the motors of its joints.
class BareDog {
 public:
  explicit BareDog(const sim::WorldConfig& config) : config_(config) {
    sim::start_ode();
    world_.reset(dWorldCreate());
    space_.reset(dSimpleSpaceCreate(nullptr));
    dWorldSetGravity(world_.get(), 0, 0, -config.physics.gravity_mps2);
    dWorldSetERP(world_.get(), config.physics.erp);
    dWorldSetCFM(world_.get(), config.physics.cfm);
    dWorldSetContactMaxCorrectingVel(world_.get(), config.physics.contact_max_correcting_velocity_mps);
    dWorldSetContactSurfaceLayer(world_.get(), config.physics.contact_surface_layer_m);
    const dGeomID ground = dCreatePlane(space_.get(), 0, 0, 1, 0);
    dGeomSetCategoryBits(ground, 1);
    // The dog, in its own space.
    const sim::VehicleInstance& dog = config.vehicles.front();
    own_space_ = dSimpleSpaceCreate(space_.get());
    for (const sim::BodyConfig& body : dog.config->bodies) add_body(body, dog.X_WV);
    for (const sim::JointConfig& joint : dog.config->joints) add_joint(joint, dog.X_WV);
    for (const devices::ServoOfVehicle& servo : devices::servos_of(*dog.config))
      set_motor(servo.params->joint, servo.params->axis, servo.params->max_effort);
  }

  void collide() {
    contacts_made_ = 0;
    dSpaceCollide(space_.get(), this, &BareDog::on_near);
    dSpaceCollide(own_space_, this, &BareDog::on_near);
  }
  /// A servo for each motor: to the angle at the start, as joint_servo does.
  void hold() {
    constexpr double gain_per_s = 40;
    for (const Motor& motor : motors_) {
      const double angle = motor.is_hinge    ? dJointGetHingeAngle(motor.joint)
                           : motor.axis == 0 ? dJointGetUniversalAngle1(motor.joint)
                                             : dJointGetUniversalAngle2(motor.joint);
      const int parameter = motor.axis == 0 ? dParamVel : dParamVel + dParamGroup2;
      if (motor.is_hinge)
        dJointSetHingeParam(motor.joint, parameter, -gain_per_s * angle);
      else
        dJointSetUniversalParam(motor.joint, parameter, -gain_per_s * angle);
    }
  }
  void solve() {
    dWorldStep(world_.get(), config_.physics.step_s);
    dJointGroupEmpty(contacts_.get());
  }
  int contacts() const { return contacts_made_; }
  double height_m() const {
    dVector3 origin_W;
    dBodyGetRelPointPos(bodies_.at("torso"), -torso_p_BC_.x(), -torso_p_BC_.y(), -torso_p_BC_.z(), origin_W);
    return origin_W[2];
  }

 private:
  struct Motor {
    dJointID joint;
    int axis;
    bool is_hinge;
  };

  void add_body(const sim::BodyConfig& config, const Pose& X_WV) {
    const dBodyID body = bodies_[config.name] = dBodyCreate(world_.get());
    dMass total;
    dMassSetZero(&total);
    for (const sim::PartConfig& part : config.parts) {
      const dMass mass = sim::part_mass(part, nullptr, config.name);
      if (mass.mass > 0) dMassAdd(&total, &mass);
    }
    const Vector3d p_BC = sim::to_eigen(total.c);
    if (config.name == "torso") torso_p_BC_ = p_BC;
    dMassTranslate(&total, -p_BC.x(), -p_BC.y(), -p_BC.z());
    dBodySetMass(body, &total);
    const Pose X_WB = X_WV * sim::make_pose(config.position_m, config.rpy_rad);
    const Vector3d p_WC = X_WB * p_BC;
    dBodySetPosition(body, p_WC.x(), p_WC.y(), p_WC.z());
    dQuaternion q;
    sim::to_ode(sim::to_quaternion(X_WB.linear()), q);
    dBodySetQuaternion(body, q);
    for (const sim::PartConfig& part : config.parts) add_geom(body, part, p_BC);
  }

  void add_geom(dBodyID body, const sim::PartConfig& part, const Vector3d& p_BC) {
    geoms_.push_back(sim::make_geom(part, nullptr));
    const dGeomID geom = geoms_.back().get();
    dGeomSetBody(geom, body);
    const Vector3d p_CG = part.position_m - p_BC;
    dGeomSetOffsetPosition(geom, p_CG.x(), p_CG.y(), p_CG.z());
    dQuaternion q;
    sim::to_ode(sim::to_quaternion(sim::make_pose(part.position_m, part.rpy_rad).linear()), q);
    dGeomSetOffsetQuaternion(geom, q);
    // Lights collide with lights only.
    const unsigned long category = part.category == "light" ? 2 : 1;
    dGeomSetCategoryBits(geom, category);
    dGeomSetCollideBits(geom, category == 2 ? 2 : 1);
    dSpaceAdd(own_space_, geom);
  }

  void add_joint(const sim::JointConfig& config, const Pose& X_WV) {
    const dBodyID first = bodies_.at(config.bodies[0]), second = bodies_.at(config.bodies[1]);
    const Vector3d anchor = X_WV * config.anchor_m;
    const Vector3d axis1 = X_WV.linear() * config.axis1.axis, axis2 = X_WV.linear() * config.axis2.axis;
    if (config.type == sim::JointType::hinge) {
      const dJointID joint = joints_[config.name] = dJointCreateHinge(world_.get(), nullptr);
      dJointAttach(joint, first, second);
      dJointSetHingeAnchor(joint, anchor.x(), anchor.y(), anchor.z());
      dJointSetHingeAxis(joint, axis1.x(), axis1.y(), axis1.z());
    } else {
      const dJointID joint = joints_[config.name] = dJointCreateUniversal(world_.get(), nullptr);
      dJointAttach(joint, first, second);
      dJointSetUniversalAnchor(joint, anchor.x(), anchor.y(), anchor.z());
      dJointSetUniversalAxis1(joint, axis1.x(), axis1.y(), axis1.z());
      dJointSetUniversalAxis2(joint, axis2.x(), axis2.y(), axis2.z());
      set_stops(config.name, config.axis2, dParamGroup2);
    }
    set_stops(config.name, config.axis1, 0);
  }

  // ODE measures the first body relative to the second.
  void set_stops(const std::string& joint, const sim::JointAxisConfig& axis, int group) {
    set_parameter(joint, dParamLoStop + group, -*axis.high_stop);
    set_parameter(joint, dParamHiStop + group, -*axis.low_stop);
  }
  void set_motor(const std::string& joint, int axis, double max_effort) {
    const int group = axis == 0 ? 0 : dParamGroup2;
    set_parameter(joint, dParamVel + group, 0);
    set_parameter(joint, dParamFMax + group, max_effort);
    motors_.push_back({joints_.at(joint), axis, dJointGetType(joints_.at(joint)) == dJointTypeHinge});
  }
  void set_parameter(const std::string& name, int parameter, double value) {
    const dJointID joint = joints_.at(name);
    if (dJointGetType(joint) == dJointTypeHinge)
      dJointSetHingeParam(joint, parameter, value);
    else
      dJointSetUniversalParam(joint, parameter, value);
  }

  static void on_near(void* data, dGeomID a, dGeomID b) {
    auto& self = *static_cast<BareDog*>(data);
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) return dSpaceCollide2(a, b, data, &BareDog::on_near);
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (body_a == body_b) return;
    if (body_a && body_b && dAreConnectedExcluding(body_a, body_b, dJointTypeContact)) return;
    dContact touching[8];
    const int count = dCollide(a, b, 8, &touching[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      touching[i].surface.mode = dContactApprox1;
      touching[i].surface.mu = 0.6;
      dJointAttach(dJointCreateContact(self.world_.get(), self.contacts_.get(), &touching[i]), body_a, body_b);
    }
    self.contacts_made_ += count;
  }

  sim::WorldConfig config_;
  sim::WorldHandle world_;
  sim::JointGroupHandle contacts_{dJointGroupCreate(0)};
  std::unique_ptr<dxSpace, sim::SpaceDeleter> space_;
  dSpaceID own_space_ = nullptr;
  std::vector<sim::GeomHandle> geoms_;  // destroyed before their spaces
  std::map<std::string, dBodyID> bodies_;
  std::map<std::string, dJointID> joints_;
  std::vector<Motor> motors_;
  Vector3d torso_p_BC_ = Vector3d::Zero();
  int contacts_made_ = 0;
};

void count(benchmark::State& state, double contacts, double height_m) {
  state.counters["contacts"] = contacts / static_cast<double>(state.iterations());
  state.counters["height_mm"] = 1000 * height_m;
}

/// A step of the simulator; messages on the in-process bus.
void Shoal(benchmark::State& state) {
  sim::InProcessBus bus;
  const sim::WorldConfig config = studio(state.range(0));
  sim::World world(config, bus);
  for (int i = 0; i < settle_steps; ++i) world.step();
  double contacts = 0;
  for (auto _ : state) {
    world.step();
    contacts += world.physics().last_step().contacts;
  }
  count(state, contacts, world.vehicles().front()->bodies().front().second->X_WB().translation().z());
}
BENCHMARK(Shoal)->ArgName("model")->Arg(whole)->Arg(no_camera)->Arg(servos)->Arg(legs)->Unit(benchmark::kMicrosecond);

/// The physics alone: the motors hold.
void Physics(benchmark::State& state) {
  sim::InProcessBus bus;
  const sim::WorldConfig config = studio(state.range(0));
  sim::World world(config, bus);
  for (int i = 0; i < settle_steps; ++i) world.step();
  double contacts = 0;
  std::int64_t step = world.step_number();
  for (auto _ : state) {
    world.physics().step(step++);
    contacts += world.physics().last_step().contacts;
  }
  count(state, contacts, world.vehicles().front()->bodies().front().second->X_WB().translation().z());
}
BENCHMARK(Physics)->ArgName("model")->Arg(servos)->Arg(legs)->Unit(benchmark::kMicrosecond);

/// Servos, collision and dWorldStep.
void BareOde(benchmark::State& state) {
  BareDog dog(studio(state.range(0)));
  double contacts = 0;
  for (int i = 0; i < settle_steps; ++i) dog.hold(), dog.collide(), dog.solve();
  for (auto _ : state) {
    dog.hold();
    dog.collide();
    contacts += dog.contacts();
    dog.solve();
  }
  count(state, contacts, dog.height_m());
}
BENCHMARK(BareOde)->ArgName("model")->Arg(servos)->Arg(legs)->Unit(benchmark::kMicrosecond);

/// dWorldStep alone.
void BareWorldStep(benchmark::State& state) {
  BareDog dog(studio(state.range(0)));
  double contacts = 0;
  for (int i = 0; i < settle_steps; ++i) dog.hold(), dog.collide(), dog.solve();
  for (auto _ : state) {
    dog.hold();
    dog.collide();
    contacts += dog.contacts();
    const auto start = std::chrono::steady_clock::now();
    dog.solve();
    state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  count(state, contacts, dog.height_m());
}
BENCHMARK(BareWorldStep)->ArgName("model")->Arg(servos)->Arg(legs)->Unit(benchmark::kMicrosecond)->UseManualTime();

}  // namespace

BENCHMARK_MAIN();
