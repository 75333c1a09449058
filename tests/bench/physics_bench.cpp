// SPDX-License-Identifier: BSD-3-Clause
// A fleet of diff-drive robots through PhysicsWorld, against a loop over bare ODE with the same bodies.  The
// bare loop has the best space of limits A1 (sweep and prune, a sub-space per robot) and makes contacts as it
// finds them.
#include <benchmark/benchmark.h>
#include <ode/ode.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "sim/ode/ode_library.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;

constexpr double step_s = 0.01;
constexpr double cell_m = 2.0;
constexpr int settle_steps = 200;
constexpr double motor_torque_Nm = 5;

/// Robots turn in small circles of different size, and never leave their cells.
double left_speed(int robot) {
  return 3 + 0.1 * (robot % 10);
}
double right_speed(int robot) {
  return -2 + 0.1 * (robot % 7);
}
Vector3d cell(int robot, int robots) {
  const int side = static_cast<int>(std::ceil(std::sqrt(robots)));
  return {cell_m * (robot % side), cell_m * (robot / side), 0};
}

class BareFleet {
 public:
  explicit BareFleet(int robots) {
    world_.reset(dWorldCreate());
    space_.reset(dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ));
    dWorldSetGravity(world_.get(), 0, 0, -9.80665);
    dWorldSetERP(world_.get(), 0.2);
    dWorldSetCFM(world_.get(), 1e-9);
    dWorldSetContactMaxCorrectingVel(world_.get(), 1);
    dWorldSetContactSurfaceLayer(world_.get(), 0.0005);
    dGeomSetData(dCreatePlane(space_.get(), 0, 0, 1, 0), nullptr);
    for (int i = 0; i < robots; ++i) add_robot(i, cell(i, robots));
  }

  void step() {
    dSpaceCollide(space_.get(), this, &BareFleet::on_near);
    dWorldStep(world_.get(), step_s);
    dJointGroupEmpty(contacts_.get());
  }
  Vector3d position(int robot) const {
    const dReal* p = dBodyGetPosition(chassis_[robot]);
    return {p[0], p[1], p[2]};
  }

 private:
  dBodyID add_body(const dMass& mass, const Vector3d& p) {
    const dBodyID body = dBodyCreate(world_.get());
    dBodySetMass(body, &mass);
    dBodySetPosition(body, p.x(), p.y(), p.z());
    return body;
  }

  void add_robot(int robot, const Vector3d& p) {
    const dSpaceID space = dSimpleSpaceCreate(nullptr);
    dSpaceSetSublevel(space, 1);
    dMass mass;
    dMassSetBoxTotal(&mass, 5, 0.5, 0.3, 0.1);
    const dBodyID chassis = add_body(mass, p + Vector3d(-0.05, 0, 0.15));
    dGeomSetBody(dCreateBox(space, 0.5, 0.3, 0.1), chassis);
    const dGeomID caster = dCreateSphere(space, 0.05);
    dGeomSetBody(caster, chassis);
    dGeomSetOffsetPosition(caster, -0.15, 0, -0.1);
    dGeomSetData(caster, this);  // marks it as slippery
    for (const double side : {1.0, -1.0}) {
      dMassSetSphereTotal(&mass, 0.5, 0.1);
      const Vector3d p_wheel = p + Vector3d(0, side * 0.2, 0.1);
      const dBodyID wheel = add_body(mass, p_wheel);
      dBodySetFiniteRotationMode(wheel, 1);
      dGeomSetBody(dCreateSphere(space, 0.1), wheel);
      const dJointID joint = dJointCreateHinge(world_.get(), nullptr);
      dJointAttach(joint, chassis, wheel);
      dJointSetHingeAnchor(joint, p_wheel.x(), p_wheel.y(), p_wheel.z());
      dJointSetHingeAxis(joint, 0, 1, 0);
      dJointSetHingeParam(joint, dParamVel, -(side > 0 ? left_speed(robot) : right_speed(robot)));
      dJointSetHingeParam(joint, dParamFMax, motor_torque_Nm);
    }
    chassis_.push_back(chassis);
    dSpaceAdd(space_.get(), reinterpret_cast<dGeomID>(space));
  }

  static void on_near(void* data, dGeomID a, dGeomID b) {
    auto& self = *static_cast<BareFleet*>(data);
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) return dSpaceCollide2(a, b, data, &BareFleet::on_near);
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (body_a && body_b && dAreConnectedExcluding(body_a, body_b, dJointTypeContact)) return;
    dContact contacts[8];
    const int count = dCollide(a, b, 8, &contacts[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      contacts[i].surface.mode = dContactApprox1;
      contacts[i].surface.mu = dGeomGetData(a) || dGeomGetData(b) ? 0 : 0.8;
      dJointAttach(dJointCreateContact(self.world_.get(), self.contacts_.get(), &contacts[i]), body_a, body_b);
    }
  }

  sim::WorldHandle world_;
  sim::JointGroupHandle contacts_{(sim::start_ode(), dJointGroupCreate(0))};  // ODE first gets our allocators
  std::unique_ptr<dxSpace, sim::SpaceDeleter> space_;
  std::vector<dBodyID> chassis_;
};

class ShoalFleet {
 public:
  explicit ShoalFleet(int robots, PhysicsConfig::Space space = PhysicsConfig::Space::sap) {
    PhysicsConfig config;
    config.step_s = step_s;
    config.space = space;
    world_ = make_world(config, {slippery()});
    add_ground(*world_);
    for (int i = 0; i < robots; ++i) {
      const Vector3d p = cell(i, robots);
      rovers_.push_back(add_rover(*world_, "rover" + std::to_string(i), translation(p.x(), p.y(), p.z())));
      rovers_.back().left->set_motor(left_speed(i), motor_torque_Nm);
      rovers_.back().right->set_motor(right_speed(i), motor_torque_Nm);
    }
  }
  void step() { world_->step(step_number_++); }
  PhysicsWorld& world() { return *world_; }
  Vector3d position(int robot) const { return rovers_[robot].chassis->X_WB().translation(); }

 private:
  std::unique_ptr<PhysicsWorld> world_;
  std::vector<Rover> rovers_;
  std::int64_t step_number_ = 0;
};

template <typename Fleet>
void run(benchmark::State& state, Fleet& fleet) {
  const int robots = static_cast<int>(state.range(0));
  for (int i = 0; i < settle_steps; ++i) fleet.step();
  for (auto _ : state) fleet.step();
  // Both columns should show robots that drive: a loop that lost its contacts would be fast.
  state.counters["z_m"] = fleet.position(robots - 1).z();
  state.counters["robot_step"] = benchmark::Counter(static_cast<double>(state.iterations()) * robots,
                                                    benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void bare_ode(benchmark::State& state) {
  BareFleet fleet(static_cast<int>(state.range(0)));
  run(state, fleet);
}

void physics_world(benchmark::State& state) {
  ShoalFleet fleet(static_cast<int>(state.range(0)));
  run(state, fleet);
}

void physics_world_quadtree(benchmark::State& state) {
  ShoalFleet fleet(static_cast<int>(state.range(0)), PhysicsConfig::Space::quadtree);
  run(state, fleet);
}

void build(benchmark::State& state) {
  for (auto _ : state) ShoalFleet fleet(static_cast<int>(state.range(0)));
}

/// One rover more and less, in a world of others; the step in between is not counted.
void BM_AddRemoveRover(benchmark::State& state) {
  const int others = static_cast<int>(state.range(0));
  ShoalFleet fleet(others);
  for (int i = 0; i < 10; ++i) fleet.step();
  const Pose X_WV = translation(-5, -5, 0);
  for (auto _ : state) {
    const int group = add_rover(fleet.world(), "visitor", X_WV).chassis->group();
    fleet.world().remove_group(group);
  }
  state.counters["bodies"] = static_cast<double>(fleet.world().bodies().size());
}

/// The same with a step after each, against physics_world: additions and removals must not make steps expensive.
void BM_AddStepRemoveRover(benchmark::State& state) {
  ShoalFleet fleet(static_cast<int>(state.range(0)));
  for (int i = 0; i < settle_steps; ++i) fleet.step();
  const Pose X_WV = translation(-5, -5, 0);
  for (auto _ : state) {
    const int group = add_rover(fleet.world(), "visitor", X_WV).chassis->group();
    fleet.step();
    fleet.world().remove_group(group);
  }
}

/// Actors in two parts that walk back and forth.
void BM_KinematicBodies(benchmark::State& state) {
  const int actors = static_cast<int>(state.range(0));
  PhysicsConfig config;
  config.step_s = step_s;
  const auto world = make_world(config);
  add_ground(*world);
  std::vector<sim::Body*> walkers;
  const PartConfig torso = at(round(PartShape::capsule, 0.2, 1, 0), {0, 0, 0.9}),
                   head = at(sphere(0.15, 0), {0, 0, 1.7});
  for (int i = 0; i < actors; ++i) {
    const Pose X_WB = sim::make_pose(cell(i, actors), Vector3d::Zero());
    walkers.push_back(&add(*world, body("walker" + std::to_string(i), {torso, head}), X_WB, Motion::kinematic));
  }
  std::int64_t step_number = 0;
  for (auto _ : state) {
    const double away_m = std::sin(0.01 * static_cast<double>(step_number));
    for (int i = 0; i < actors; ++i)
      walkers[i]->move_to(sim::make_pose(cell(i, actors) + Vector3d(away_m, 0, 0), {0, 0, away_m}), step_s);
    world->step(step_number++);
  }
  state.counters["actor_step"] = benchmark::Counter(static_cast<double>(state.iterations()) * actors,
                                                    benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace

BENCHMARK(bare_ode)->RangeMultiplier(10)->Range(1, 1000);
BENCHMARK(physics_world)->RangeMultiplier(10)->Range(1, 1000);
BENCHMARK(physics_world_quadtree)->Arg(1000);
BENCHMARK(BM_AddRemoveRover)->Arg(1000)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_AddStepRemoveRover)->Arg(1000)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_KinematicBodies)->Arg(500)->Unit(benchmark::kMicrosecond);
BENCHMARK(build)->Arg(1000)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
