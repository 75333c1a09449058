// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/arm_rover.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace arm_rover;

using sim::FaultKind;

/// A vehicle for any type of device: what the required keys need, by their names.
std::string device_of(const sim::DeviceType& type) {
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  type.make_params()->read(in);
  std::string keys;
  for (const sim::ParamInfo& info : table) {
    if (!info.required) continue;
    const bool list = info.type.find("list") != std::string::npos;
    const bool other = info.key.find("right") != std::string::npos || info.key == "follows";
    const std::string name = other ? "right" : "left";
    keys += ", " + info.key + ": " + (list ? "[" + name + "]" : name);
  }
  return "        - {name: device, type: " + type.name + keys + "}\n";
}

/// A rover with the device; its chassis is kinematic when the device asks for that.
std::string rover_for(const sim::DeviceType& type) {
  std::string world = test::rover_world(device_of(type));
  const std::string chassis = "- name: chassis\n";
  if (type.name == "naive_drive")
    world.replace(world.find(chassis), chassis.size(), chassis + "          kinematic: true\n");
  if (type.name == "noise_source") world += "medium: {water: {surface_m: -10}}\n";
  return world;
}

class EveryActuator : public testing::TestWithParam<const sim::DeviceType*> {};

TEST_P(EveryActuator, GoesToItsSafeStatesAndWithoutEffectivenessGivesNoForce) {
  const sim::DeviceType& type = *GetParam();
  for (const sim::SafeState safe : type.safe_states) {
    test::TestWorld test(rover_for(type));
    auto* actuator = const_cast<sim::Actuator*>(test.world.find_vehicle("r1")->find_device("device")->actuator());
    ASSERT_NE(actuator, nullptr);
    test.run_for(0.02);
    EXPECT_NO_THROW(actuator->make_safe(safe));
    test.run_for(0.02);
    EXPECT_GE(actuator->power_W(), 0);
    test.world.editor().set_fault("r1/device", {.kind = FaultKind::dead});
    test.run_for(0.02);
    for (const auto& [name, joint] : test.world.find_vehicle("r1")->joints())
      EXPECT_EQ(joint->motor_max_force(), 0) << name;
  }
}

TEST_P(EveryActuator, SaysWhatItIsInFull) {
  const sim::DeviceType& type = *GetParam();
  EXPECT_FALSE(type.meaning.empty());
  EXPECT_TRUE(type.meaning.ends_with(".")) << type.meaning;
  EXPECT_TRUE(type.takes_commands() || type.always_on) << "only a linkage takes none";
  EXPECT_TRUE(type.changeable) << "what can be tuned can be tuned while it runs";
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  type.make_params()->read(in);
  for (const sim::ParamInfo& info : table) EXPECT_FALSE(info.meaning.empty()) << info.key;
}

std::vector<const sim::DeviceType*> actuators() {
  std::vector<const sim::DeviceType*> all;
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all())
    if (type->is_actuator()) all.push_back(type);
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, EveryActuator, testing::ValuesIn(actuators()),
                         [](const auto& test) { return test.param->name; });

}  // namespace
