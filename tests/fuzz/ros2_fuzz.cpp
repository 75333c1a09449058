// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/node/command_topics.hpp"
#include "bridges/ros2/node/sim_services.hpp"
#include "shoal/message_codec.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Messages and calls of a stranger in ROS 2: first byte 0 a command, else a call; second byte the topic or the service.

namespace {

std::vector<bridges::ros2::CommandTopic> all_command_topics() {
  shoal::sim_vehicle_t vehicle{};
  vehicle.vehicle = "v";
  for (const auto& [name, schema] : shoal::embedded_types().all()) {
    if (name.find("command") == std::string::npos && name != "shoal.modem_send_t" && name != "shoal.led_t") continue;
    vehicle.device.push_back(name);
    vehicle.command_channel.push_back("v." + name + ".cmd");
    vehicle.command_types.push_back(name);
  }
  return bridges::ros2::command_topics(vehicle);
}

void fuzz_command(fuzz::Reader& reader) {
  static const auto topics = all_command_topics();
  const auto& topic = topics[reader.below(topics.size())];
  fuzz::allow<shoal::MessageError>([&] { topic.convert(reader.rest(), 1); });
}

void fuzz_call(fuzz::Reader& reader) {
  using bridges::ros2::SimServices;
  std::vector<std::int32_t> asked;
  int responses = 0;
  SimServices services({[&](const std::string&, double, const std::string&) {
                          asked.push_back(static_cast<std::int32_t>(asked.size()));
                          return asked.back();
                        },
                        [&](std::size_t, std::span<const std::byte>) { ++responses; }},
                       true);
  shoal::sim_state_t state{};
  state.vehicle = {"a"};
  state.position_m = state.velocity_mps = state.angular_velocity_radps = {{0, 0, 0}};
  state.orientation = {{1, 0, 0, 0}};
  services.know(state);
  const std::size_t service = reader.below(SimServices::services().size());
  bool valid = false;
  fuzz::allow<shoal::MessageError>([&] {
    services.call(service, reader.rest(), {});
    valid = true;
  });
  services.expire(SimServices::Clock::time_point{} + SimServices::patience);
  fuzz::require(responses == (valid ? 1 : 0), "a call is answered once");
}

}  // namespace

SHOAL_FUZZ_TARGET(ros2) {
  fuzz::Reader reader(input);
  if (reader.below(2) == 0)
    fuzz_command(reader);
  else
    fuzz_call(reader);
}
