// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_journal.hpp"

#include <gmock/gmock.h>

#include <random>
#include <string>
#include <vector>

#include "shoal/modem_send_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/devices/state_fixture.hpp"

// Additions and removals follow from what is present: a world that is restored must be the same in all bits.

namespace {

using test::SavedRun;
using test::TappedWorld;

/// Weightless, under water: nothing falls, and everything that floats can be received.
const char* const sea = R"(
shoal: 1
physics: {step_s: 0.01, gravity_mps2: 0}
run: {seed: 9}
medium: {water: {}}
objects:
  - {name: wall, fixed: true, position_m: [0, 60, -20], parts: [{shape: box, size_m: [200, 1, 10]}]}
  - {name: stone, present: false, position_m: [0, 50, -20], parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1000}]}
vehicles:
  - name: ship
    position_m: [0, -20, -20]
    model:
      shoal: 1
      vehicle: ship
      bodies: [{name: hull, parts: [{shape: box, mass_kg: 1000}]}]
      devices:
        - {name: lbl, type: lbl, ping_period_s: 0.3, rate_hz: 20}
        - {name: modem, type: acoustic_modem, bit_rate_bps: 5000, preamble_s: 0.02}
        - {name: lidar, type: lidar, rate_hz: 5, beams: 30, range_max_m: 100}
  - name: mast
    position_m: [40, -20, -20]
    model:
      shoal: 1
      vehicle: mast
      bodies:
        - {name: boom, position_m: [1, 0, 0], parts: [{shape: box, size_m: [1, 0.2, 0.2], mass_kg: 2}]}
        - {name: tip, position_m: [2, 0, 0], parts: [{shape: box, size_m: [0.8, 0.2, 0.2], mass_kg: 1}]}
      joints:
        - {name: foot, type: hinge, bodies: [boom, world], axis: [0, 0, 1], motor_velocity: 1, motor_max_force: 2}
        - {name: wrist, type: hinge, bodies: [boom, tip], anchor_m: [1.5, 0, 0], axis: [0, 1, 0]}
      devices: [{name: joints, type: joint_state, joints: [foot, wrist], rate_hz: 20}]
)";

const char* const masted = R"({shoal: 1, vehicle: mast, bodies: [
  {name: boom, position_m: [1, 0, 0], parts: [{shape: box, size_m: [1, 0.2, 0.2], mass_kg: 2}]}],
  joints: [{name: foot, type: hinge, bodies: [boom, world], axis: [0, 0, 1], motor_velocity: 2, motor_max_force: 2},
           {name: ring, type: ball, bodies: [boom, world], anchor_m: [0.2, 0, 0]}],
  devices: [{name: imu, type: imu, rate_hz: 20, gyro_noise: {gaussian_std: 0.01}}]})";
const char* const talking =
    R"({shoal: 1, vehicle: fish, clock: {preset: tcxo, update_s: 0.1}, materials: [{name: felt}],
  bodies: [{name: hull, parts: [{shape: box, size_m: [1, 0.5, 0.5], mass_kg: 250, material: felt}]},
           {name: tail, position_m: [-0.8, 0, 0], parts: [{shape: sphere, radius_m: 0.2, mass_kg: 30}]}],
  joints: [{name: tail, type: hinge, bodies: [hull, tail], anchor_m: [-0.5, 0, 0], axis: [0, 0, 1],
            motor_velocity: 1, motor_max_force: 5}],
  devices: [{name: t, type: transponder, network: lbl},
            {name: modem, type: acoustic_modem, bit_rate_bps: 5000, preamble_s: 0.02},
            {name: imu, type: imu, rate_hz: 10, accel_noise: {bias_std: 0.1, gaussian_std: 0.1}}]})";
const char* const drifting = R"({shoal: 1, vehicle: log, bodies: [{name: hull, parts: [{shape: box, mass_kg: 1000}]}],
  devices: [{name: pose, type: inclinometer, rate_hz: 5}]})";

constexpr int places = 7;

std::string guest(int place) {
  return "g" + std::to_string(place);
}

/// Each has its own place, so that no one comes where another stands.
sim::Vector3d home_m(int place) {
  return {20.0 * (place % 4) - 30, 20.0 * (place / 4), -20};
}

sim::VehicleInstance a_guest(const sim::World& world, const std::string& model) {
  return sim::read_spawn_request(world.config(), "{name: guest, model: " + model + "}").vehicle;
}

void spawn(sim::World& world, const std::string& name, const sim::Vector3d& at_m, sim::VehicleInstance guest) {
  guest.name = name;
  guest.X_WV = sim::make_pose(at_m, sim::Vector3d::Zero());
  world.editor().add_vehicle(guest);
}

void spawn(sim::World& world, const std::string& name, const sim::Vector3d& at_m, const std::string& model) {
  spawn(world, name, at_m, a_guest(world, model));
}

void change(sim::World& world, const std::string& device, const std::string& values) {
  sim::Diagnostics diagnostics;
  ASSERT_TRUE(world.editor().change_device(device, sim::parse_config_text(values, "change", diagnostics), diagnostics))
      << device;
}

/// Something happens to one of the places, or to the stones, by the number of the step alone.
class Meddler {
 public:
  explicit Meddler(unsigned seed) : seed_(seed) {}

  void operator()(TappedWorld& test, int step) const {
    std::mt19937 random(seed_ * 100'000u + static_cast<unsigned>(step));
    const auto draw = [&](int below) { return static_cast<int>(random() % static_cast<unsigned>(below)); };
    sim::World& world = test.world;
    for (int i = draw(3); i > 0; --i) meddle_with(world, draw(places), draw);
    const std::string stone = "stone" + std::to_string(draw(4));
    if (draw(4) == 0) {
      if (world.find_object(stone) != nullptr)
        world.editor().remove_object(stone);
      else
        world.editor().add_object(world.config().objects[1], stone,
                                  sim::make_pose({5.0 * (stone.back() - '0'), 50, -20}, {0, 0, 0}));
    }
    if (draw(10) == 0) test.send("ship.modem.cmd", shoal::modem_send_t{0, "", 3, {1, 2, 3}});
    if (draw(20) == 0) move(world, "mast", {40, -20, -20}, draw);
  }

 private:
  template <typename Draw>
  static void move(sim::World& world, const std::string& name, const sim::Vector3d& home_m, const Draw& draw) {
    const sim::Vector3d by_m(0.1 * draw(20), 0.1 * draw(20), 0.1 * draw(20));
    world.editor().move_vehicle(name, sim::make_pose(home_m + by_m, {0.1 * draw(10), 0, 0.1 * draw(60)}));
  }

  template <typename Draw>
  static void meddle_with(sim::World& world, int place, const Draw& draw) {
    const std::string name = guest(place);
    const sim::Vehicle* vehicle = world.find_vehicle(name);
    if (vehicle == nullptr) {
      const char* const models[] = {masted, talking, drifting};
      spawn(world, name, home_m(place), models[draw(3)]);
    } else if (draw(2) == 0) {
      world.editor().remove_vehicle(name);
    } else if (draw(2) == 0) {
      move(world, name, home_m(place), draw);
    } else {
      change(world, vehicle->devices().back()->full_name(), "{rate_hz: " + std::to_string(5 * (1 + draw(4))) + "}");
    }
  }

  unsigned seed_;
};

class MeddledWorld : public testing::TestWithParam<unsigned> {};

TEST_P(MeddledWorld, WhoCameAndWentAtRandomLeavesAWorldThatContinuesAlike) {
  SavedRun(sea, Meddler(GetParam())).expect_restored_worlds_go_on_alike({0, 7, 60, 121, 200}, 60);
}
INSTANTIATE_TEST_SUITE_P(Seeds, MeddledWorld, testing::Range(1u, 9u));

/// Always three are there, so that no one ever comes into the world as it began.
TEST(WorldJournal, RollingSpawnsKeepItsSize) {
  TappedWorld test(sea);
  sim::World& world = test.world;
  constexpr int rounds = 100'000;
  const sim::VehicleInstance models[] = {a_guest(world, drifting), a_guest(world, masted)};
  std::size_t largest = 0;
  for (int i = 0; i < rounds; ++i) {
    spawn(world, "r" + std::to_string(i), home_m(i % 4), models[i % 2]);
    if (i >= 3) world.editor().remove_vehicle("r" + std::to_string(i - 3));
    if (i % 10'000 == 9'999) largest = std::max(largest, world.state().snapshot().size());
    if (i % 10'000 == 5'000) world.step();
  }
  // Four vehicles of a few hundred bytes each, their YAML, and the state of all that is there.
  EXPECT_LT(largest, 40'000u);
  TappedWorld fresh(sea);
  const sim::Bytes snapshot = world.state().snapshot();
  fresh.world.state().restore(snapshot);
  EXPECT_EQ(fresh.world.state().snapshot(), snapshot);
  for (int i = 0; i < 20; ++i) {
    if (i == 5)
      for (sim::World* each : {&world, &fresh.world}) spawn(*each, "last", {10, 30, -20}, talking);
    world.step();
    fresh.world.step();
    ASSERT_EQ(fresh.world.state().hash(), world.state().hash()) << i;
  }
}

TEST(WorldJournal, MovesOfWhatIsJoinedToTheWorldKeepItsSize) {
  TappedWorld test(sea);
  const auto bytes_after = [&](int moves) {
    for (int i = 0; i < moves; ++i)
      test.world.editor().move_vehicle("mast", sim::make_pose({40 + 1e-4 * i, -20, -20}, {0, 0, 1e-3 * i}));
    return test.world.state().snapshot().size();
  };
  const std::size_t once = bytes_after(1);
  EXPECT_EQ(bytes_after(10'000), once);
  TappedWorld fresh(sea);
  fresh.world.state().restore(test.world.state().snapshot());
  for (int i = 0; i < 100; ++i) {
    test.world.step();
    fresh.world.step();
    ASSERT_EQ(fresh.world.state().hash(), test.world.state().hash()) << i;
  }
}

}  // namespace
