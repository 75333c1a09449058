// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "messages/yaml/message_writer.hpp"
#include "shoal/message_codec.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world_file/load_world.hpp"

namespace test {

/// A loaded world on the in-process bus.
class LoadedTestWorld {
 public:
  /// A file of worlds/.
  explicit LoadedTestWorld(const std::string& file) : LoadedTestWorld(sim::load_world(file, with_messages({}))) {}

  static sim::LoadOptions with_messages(sim::LoadOptions options) {
    if (!options.encode_message) options.encode_message = shoal::encode_own_message;
    return options;
  }
  void run_for(double time_s) {
    const sim::Time end = world.now() + sim::from_seconds(time_s);
    while (world.now() < end) world.step();
  }
  /// As an event's `set`.  Empty: it was taken; else what is wrong.
  std::string change(const std::string& device, const std::string& values) {
    sim::Diagnostics diagnostics;
    const auto node = sim::parse_config_text(values, "change", diagnostics);
    if (world.editor().change_device(device, node, diagnostics)) return {};
    return diagnostics.lines().empty() ? "refused" : diagnostics.lines().front();
  }
  template <typename Message>
  void send(const std::string& channel, const Message& message) {
    bus.publish(channel, shoal::encode(message), world.now());
  }

 protected:
  explicit LoadedTestWorld(sim::LoadedWorld from) : loaded(std::move(from)), world(loaded.config, bus) {}

 public:
  sim::LoadedWorld loaded;
  sim::InProcessBus bus;
  sim::World world;
};

/// A world from YAML text.
class TestWorld : public LoadedTestWorld {
 public:
  explicit TestWorld(const std::string& yaml, const sim::LoadOptions& options = {})
      : LoadedTestWorld(sim::load_world_text(yaml, "worlds/test.yaml", with_messages(options))) {}
};

/// What is wrong with a world; empty: nothing.
inline std::string error_of_world(const std::string& yaml) {
  try {
    TestWorld test(yaml);
    return {};
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
}

/// Everything that is published on a channel, decoded.
template <typename Message>
class Listener {
 public:
  Listener(LoadedTestWorld& world, const std::string& channel) : mailbox_(world.bus.open_mailbox(channel, 100000)) {}
  std::vector<Message> take_all() {
    std::vector<Message> all;
    while (const auto message = mailbox_->take())
      all.push_back(shoal::decode<Message>(message->payload, shoal::Finite::any));
    return all;
  }
  Message last() {
    const std::vector<Message> all = take_all();
    if (all.empty()) throw std::runtime_error("nothing was published");
    return all.back();
  }

 private:
  std::unique_ptr<sim::Mailbox> mailbox_;
};

/// A rover that stands on a plane: track 0.5 m, wheel radius 0.1 m, its frame on the ground between the wheels.
/// `devices`: lines of the devices list, indented by six spaces; `entry`: more keys of the vehicle's entry.
inline std::string rover_world(const std::string& devices, const std::string& objects = "",
                               const std::string& entry = "", const std::string& more = "") {
  return R"(
shoal: 1
physics: {step_s: 0.001}
materials: [{name: rubber}, {name: slick}]
contacts: [{between: [slick, any], friction: 0}, {between: [rubber, any], friction: 1}]
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
)" + objects +
         R"(
vehicles:
  - name: r1
)" + entry +
         R"(
    model:
      shoal: 1
      vehicle: test_rover
      bodies:
        - name: chassis
          position_m: [0, 0, 0.1]
          parts:
            - {name: hull, shape: box, size_m: [0.4, 0.3, 0.1], position_m: [0, 0, 0.03], mass_kg: 10}
            - {name: caster, shape: sphere, radius_m: 0.05, position_m: [-0.15, 0, -0.05], mass_kg: 0.1, material: slick}
            - {name: caster2, shape: sphere, radius_m: 0.05, position_m: [0.15, 0, -0.05], mass_kg: 0.1, material: slick}
        - {name: left_wheel, position_m: [0, 0.25, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5, material: rubber}]}
        - {name: right_wheel, position_m: [0, -0.25, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5, material: rubber}]}
      joints:
        - {name: left, type: hinge, bodies: [chassis, left_wheel], anchor_m: [0, 0.25, 0.1], axis: [0, 1, 0]}
        - {name: right, type: hinge, bodies: [chassis, right_wheel], anchor_m: [0, -0.25, 0.1], axis: [0, 1, 0]}
      devices:
)" + devices +
         more;
}

/// One free box of 1 kg, 0.6 x 0.4 x 0.2 m, its frame in the middle.  `devices`: as above.
inline std::string box_world(const std::string& devices, const std::string& physics = "{step_s: 0.001}",
                             const std::string& more = "") {
  return "shoal: 1\nphysics: " + physics + R"(
vehicles:
  - name: r1
    position_m: [0, 0, 0]
    model:
      shoal: 1
      vehicle: box
      bodies: [{name: hull, parts: [{shape: box, size_m: [0.6, 0.4, 0.2], mass_kg: 1}]}]
      devices:
)" + devices +
         more;
}

}  // namespace test
